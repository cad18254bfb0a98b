//! The supervision of one worker: it is started when needed, started again after a loss, and each
//! failure becomes a report. Runs and benches use the same supervisor.
//!
//! A start that fails is repeated at once and not later: requests in flight must all reach the same
//! worker, or their answers would be taken for each other's.

use crate::failure_report::FailureReport;
use crate::launch::{Launch, StartError};
use crate::loss::{Failure, Loss};
use crate::process::WorkerProcess;
use crate::sync::lock;
use crate::worker::Worker;
use std::sync::{Arc, Mutex};

/// The number of failed starts in a row after which an adapter's worker is not started again.
const MAX_FAILED_STARTS: u32 = 3;

/// The failed starts of one adapter's workers. All supervisors of the adapter share it, so that a driver
/// which no longer starts is not tried once per supervisor.
#[derive(Clone, Debug, Default)]
pub(crate) struct FailedStarts(Arc<Mutex<InARow>>);

#[derive(Debug, Default)]
struct InARow {
    count: u32,
    /// The error of the last one.
    message: String,
}

/// Starts one worker at a time and watches over it.
pub(crate) struct Supervisor {
    launch: Launch,
    /// MiB of memory that the worker may hold.
    memory: Option<u64>,
    failed_starts: FailedStarts,
    worker: Option<WorkerProcess>,
    /// The number of workers so far.
    generation: u32,
}

/// Starts a worker once.
pub(crate) fn start(launch: &Launch, memory: Option<u64>) -> Result<WorkerProcess, StartError> {
    limited(Worker::start(launch)?.process, memory)
}

fn limited(mut process: WorkerProcess, memory: Option<u64>) -> Result<WorkerProcess, StartError> {
    if let Some(limit) = memory {
        process.limit_memory(limit)?;
    }
    Ok(process)
}

impl Supervisor {
    /// A supervisor of workers started by `launch`, the first of which may be running already. One whose memory cannot
    /// be watched is ended.
    pub(crate) fn new(
        launch: Launch,
        memory: Option<u64>,
        failed_starts: FailedStarts,
        running: Option<Worker>,
    ) -> Self {
        Self {
            launch,
            memory,
            failed_starts,
            worker: running.and_then(|worker| limited(worker.process, memory).ok()),
            generation: 0,
        }
    }

    /// Makes a running worker the supervisor's first one.
    pub(crate) fn take_over(&mut self, running: Option<Worker>) {
        self.worker = running.and_then(|worker| limited(worker.process, self.memory).ok());
    }

    /// The worker, started if there is none.
    pub(crate) fn worker(&mut self) -> Result<&mut WorkerProcess, Loss> {
        while self.worker.is_none() && lock(&self.failed_starts.0).count < MAX_FAILED_STARTS {
            let started = start(&self.launch, self.memory);
            let mut failed = lock(&self.failed_starts.0);
            match started {
                Ok(process) => {
                    failed.count = 0;
                    self.worker = Some(process);
                    self.generation += 1;
                }
                Err(error) => {
                    failed.count += 1;
                    failed.message = format!("the worker could not be started again: {error}");
                }
            }
        }
        self.running()
    }

    /// The worker that is running.
    pub(crate) fn running(&mut self) -> Result<&mut WorkerProcess, Loss> {
        match &mut self.worker {
            Some(process) => Ok(process),
            None => Err(Loss::NotStarted(
                lock(&self.failed_starts.0).message.clone(),
            )),
        }
    }

    /// True if a worker is running.
    pub(crate) fn is_running(&self) -> bool {
        self.worker.is_some()
    }

    /// A number that changes whenever a new worker is started.
    pub(crate) fn generation(&self) -> u32 {
        self.generation
    }

    /// Ends the worker.
    pub(crate) fn stop(&mut self) {
        self.worker = None;
    }

    /// Reports a failed request, and ends the worker if it must not be used again.
    pub(crate) fn report(&mut self, failure: Failure) -> FailureReport {
        let report = FailureReport::new(failure.clone(), self.worker.as_mut());
        if failure.ends_worker() {
            self.worker = None;
        }
        report
    }
}
