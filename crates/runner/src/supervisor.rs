//! Supervising one worker: it is started when needed, started again after a loss, and each failure becomes
//! a report. Runs and benches use the same supervisor.
//!
//! A failed start is repeated at once, not later: all requests in flight must go to the same worker, because
//! otherwise their answers could be confused.

use crate::failure_report::FailureReport;
use crate::launch::{Launch, StartError};
use crate::loss::{Loss, RequestError};
use crate::process::WorkerProcess;
use crate::sync::lock;
use crate::worker::Worker;
use etalon_record::beside::WORKER_END;
use etalon_record::{AdapterRecord, Expectations, ProcessEnd, Reason, Record, Verdict};
use std::sync::{Arc, Mutex};

/// The number of consecutive failed starts after which an adapter's worker is not started again.
pub(crate) const MAX_FAILED_STARTS: u32 = 3;

/// The failed starts of one adapter's workers. All supervisors of the adapter share this, so that a driver
/// that no longer starts is not tried again by each supervisor.
#[derive(Clone, Debug, Default)]
pub(crate) struct FailedStarts(Arc<Mutex<InARow>>);

#[derive(Debug, Default)]
struct InARow {
    count: u32,
    /// The error of the last failed start.
    error: String,
}

/// The failures of the workers of one adapter after their last case. All supervisors of the adapter share this.
#[derive(Clone, Debug, Default)]
pub(crate) struct BadEnds(Arc<Mutex<Vec<ProcessEnd>>>);

impl BadEnds {
    /// Ends a worker, and notes how it ends.
    pub(crate) fn end(&self, worker: WorkerProcess) {
        lock(&self.0).extend(worker.bad_end());
    }

    /// Returns a record of each end so far.
    pub(crate) fn take(&self, adapter: &AdapterRecord, expectations: &Expectations) -> Vec<Record> {
        let ends = std::mem::take(&mut *lock(&self.0)).into_iter();
        let records = ends.map(|end| {
            let mut record = Record::new(WORKER_END, &adapter.info.name, Verdict::Crash);
            record.reasons = vec![Reason::AfterLastCase];
            record.process = Some(end);
            record.expect(expectations, adapter);
            record
        });
        records.collect()
    }
}

/// Starts one worker at a time and watches over it.
pub(crate) struct Supervisor {
    launch: Launch,
    /// Memory that the worker may use, in MiB.
    memory: Option<u64>,
    failed_starts: FailedStarts,
    bad_ends: BadEnds,
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
    /// Creates a supervisor of workers that `launch` starts; the first one can already be running. A worker
    /// whose memory cannot be watched is ended.
    pub(crate) fn new(
        launch: Launch,
        memory: Option<u64>,
        failed_starts: FailedStarts,
        bad_ends: BadEnds,
        running: Option<Worker>,
    ) -> Self {
        Self {
            launch,
            memory,
            failed_starts,
            bad_ends,
            worker: running.and_then(|worker| limited(worker.process, memory).ok()),
            generation: 0,
        }
    }

    /// Makes a running worker the supervisor's first one.
    pub(crate) fn take_over(&mut self, running: Option<Worker>) {
        self.worker = running.and_then(|worker| limited(worker.process, self.memory).ok());
    }

    /// Returns where it notes how its workers end.
    pub(crate) fn bad_ends(&self) -> &BadEnds {
        &self.bad_ends
    }

    /// Returns the worker, and starts one if none is running.
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
                    failed.error = format!("the worker could not be started again: {error}");
                }
            }
        }
        self.running()
    }

    /// Returns the running worker.
    pub(crate) fn running(&mut self) -> Result<&mut WorkerProcess, Loss> {
        match &mut self.worker {
            Some(process) => Ok(process),
            None => Err(Loss::NotStarted(lock(&self.failed_starts.0).error.clone())),
        }
    }

    /// Returns true if a worker is running.
    pub(crate) fn is_running(&self) -> bool {
        self.worker.is_some()
    }

    /// Returns a number that changes whenever a new worker is started.
    pub(crate) fn generation(&self) -> u32 {
        self.generation
    }

    /// Ends the worker, and notes how it ends.
    pub(crate) fn stop(&mut self) {
        if let Some(worker) = self.worker.take() {
            self.bad_ends.end(worker);
        }
    }

    /// Reports a failed request, and ends the worker if it must not be used again.
    pub(crate) fn report(&mut self, failure: RequestError) -> FailureReport {
        let report = FailureReport::new(failure.clone(), self.worker.as_mut());
        if failure.ends_worker() {
            self.worker = None;
        }
        report
    }
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        self.stop();
    }
}
