//! Batches: cases that need no record, drawn on several workers of one adapter and judged as their frames
//! arrive.
//!
//! A run writes a record of every case and can resume. In a batch, most cases pass and are forgotten, so a
//! case costs only the time to draw and to judge it. Each worker draws the next case that no other worker has
//! taken. The records are in the order of the cases, so that they do not depend on the number of workers.

use crate::drawing::DueAnswers;
use crate::launch::{Launch, StartError};
use crate::loss::{Loss, RequestError};
use crate::outcome::outcome;
use crate::process::Wait;
use crate::sync::lock;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_frame::{Limits, threads};
use etalon_record::Record;
use std::collections::VecDeque;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The requests in flight on a worker.
const AHEAD: usize = 3;

/// Several workers of one adapter.
pub struct Batches {
    launch: Launch,
    limits: Limits,
    workers: Vec<Option<Worker>>,
    timeout: Duration,
}

impl Batches {
    /// Creates `jobs` workers of an adapter. `worker` is already running; the others are started when
    /// they are needed. Each case may take as long as `timeout`.
    pub fn new(launch: Launch, worker: Worker, jobs: usize, timeout: Duration) -> Self {
        let limits = worker.hello.limits.clone();
        let mut workers = vec![Some(worker)];
        workers.resize_with(jobs.max(1), || None);
        Self {
            launch,
            limits,
            workers,
            timeout,
        }
    }

    /// Draws and judges cases. Returns their records in order, with `None` for cases that were not reached
    /// before `stop` was set.
    ///
    /// # Errors
    /// If a worker cannot be started.
    pub fn draw(
        &mut self,
        cases: &[&Case],
        stop: &AtomicBool,
    ) -> Result<Vec<Option<Record>>, StartError> {
        let next = AtomicUsize::new(0);
        let found: Mutex<Vec<Option<Record>>> = Mutex::new(vec![None; cases.len()]);
        let (launch, limits) = (&self.launch, &self.limits);
        let share = BatchState {
            launch,
            limits,
            timeout: self.timeout,
            cases,
            next: &next,
            found: &found,
            stop,
        };
        let count = self.workers.len();
        let workers = Mutex::new(self.workers.iter_mut());
        let ended = threads::share(count, || {
            // A worker for which no thread could be started has no case left to draw.
            while share.is_left()
                && let Some(worker) = { lock(&workers).next() }
            {
                share.draw(worker)?;
            }
            Ok(())
        });
        ended.into_iter().find(Result::is_err).unwrap_or(Ok(()))?;
        let records = std::mem::take(&mut *lock(&found));
        Ok(records)
    }
}

/// The state that the workers of a batch share.
struct BatchState<'a> {
    launch: &'a Launch,
    limits: &'a Limits,
    timeout: Duration,
    cases: &'a [&'a Case],
    next: &'a AtomicUsize,
    found: &'a Mutex<Vec<Option<Record>>>,
    stop: &'a AtomicBool,
}

impl BatchState<'_> {
    /// Returns true if there are cases left to draw.
    fn is_left(&self) -> bool {
        self.next.load(Ordering::Relaxed) < self.cases.len()
    }

    /// Draws on one worker until no case is left.
    fn draw(&self, slot: &mut Option<Worker>) -> Result<(), StartError> {
        let mut worker = match slot.take() {
            Some(worker) => worker,
            None => Worker::start(self.launch)?,
        };
        let mut asked: VecDeque<(usize, Instant)> = VecDeque::new();
        loop {
            while asked.len() < AHEAD && !self.stop.load(Ordering::Relaxed) {
                let number = self.next.fetch_add(1, Ordering::Relaxed);
                let Some(case) = self.cases.get(number) else {
                    break;
                };
                worker.process.request_case(number as u32, case);
                asked.push_back((number, Instant::now()));
            }
            let Some((number, since)) = asked.pop_front() else {
                *slot = Some(worker);
                return Ok(());
            };
            let case = self.cases[number];
            let wait = Wait {
                timeout: self.timeout,
                stop: Some(self.stop),
            };
            let process = &mut worker.process;
            let drawing = process.receive_frames(number as u32, DueAnswers::of(case), since, wait);
            if matches!(drawing.frames, Err(RequestError::Lost(Loss::Cancelled))) {
                return Ok(());
            }
            let (record, ends) = outcome(process, case, self.limits, drawing.frames);
            if ends {
                worker = Worker::start(self.launch)?;
                // Requests after the lost one were lost with it.
                for (number, since) in &mut asked {
                    let case = self.cases[*number];
                    worker.process.request_case(*number as u32, case);
                    *since = Instant::now();
                }
            }
            lock(self.found)[number] = Some(record);
        }
    }
}
