//! Batches: cases that need no record, drawn on several workers of one adapter and judged as they come.
//!
//! A run writes a record of every case and starts again where it was stopped; here most cases pass and are
//! forgotten, so a case costs its drawing and its judgement alone. Each worker draws the next case that nobody
//! has, and the outcomes stand in the order of the cases, so that they do not tell how many workers there were.

use crate::drawing::Due;
use crate::exit_report::ExitReport;
use crate::judge::Judge;
use crate::launch::{Launch, StartError};
use crate::loss::{Failure, Loss};
use crate::process::Wait;
use crate::sync::lock;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_frame::Limits;
use etalon_record::{Record, Verdict};
use std::collections::VecDeque;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// The time that a case may take.
const TIMEOUT: Duration = Duration::from_secs(20);
/// The requests in flight on a worker.
const AHEAD: usize = 3;

/// The outcome of one case.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It was drawn, and judged.
    Judged(Box<Record>),
    /// It was not drawn, or ended its worker.
    NotDrawn {
        /// The verdict: NotSupported where the driver refuses it.
        verdict: Verdict,
        /// The cause.
        message: String,
        /// True if the worker was lost.
        lost: bool,
    },
}

/// Several workers of one adapter.
pub struct Batches {
    launch: Launch,
    limits: Limits,
    workers: Vec<Option<Worker>>,
}

impl Batches {
    /// So many workers of an adapter, of which one is running; the others are started when they are needed.
    pub fn new(launch: Launch, worker: Worker, jobs: usize) -> Self {
        let limits = worker.hello.limits.clone();
        let mut workers = vec![Some(worker)];
        workers.resize_with(jobs.max(1), || None);
        Self {
            launch,
            limits,
            workers,
        }
    }

    /// Draws and judges cases. Returns their outcomes in order; `None` for those that were not reached when
    /// `stop` was set.
    ///
    /// # Errors
    /// When a worker cannot be started.
    pub fn draw(
        &mut self,
        cases: &[&Case],
        stop: &AtomicBool,
    ) -> Result<Vec<Option<Outcome>>, StartError> {
        let next = AtomicUsize::new(0);
        let found: Mutex<Vec<Option<Outcome>>> = Mutex::new(vec![None; cases.len()]);
        let (launch, limits) = (&self.launch, &self.limits);
        let share = Share {
            launch,
            limits,
            cases,
            next: &next,
            found: &found,
            stop,
        };
        thread::scope(|scope| {
            let lanes: Vec<_> = self
                .workers
                .iter_mut()
                .map(|worker| scope.spawn(|| share.draw(worker)))
                .collect();
            let mut ended = lanes.into_iter().map(|lane| match lane.join() {
                Ok(ended) => ended,
                Err(panic) => std::panic::resume_unwind(panic),
            });
            ended.find(Result::is_err).unwrap_or(Ok(()))
        })?;
        let outcomes = std::mem::take(&mut *lock(&found));
        Ok(outcomes)
    }
}

/// The state that the workers of a batch share.
struct Share<'a> {
    launch: &'a Launch,
    limits: &'a Limits,
    cases: &'a [&'a Case],
    next: &'a AtomicUsize,
    found: &'a Mutex<Vec<Option<Outcome>>>,
    stop: &'a AtomicBool,
}

impl Share<'_> {
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
                timeout: TIMEOUT,
                stop: Some(self.stop),
            };
            let process = &mut worker.process;
            let drawing = process.receive_frames(number as u32, Due::of(case), since, wait);
            let outcome = match drawing.frames {
                Ok(frames) => {
                    let judge = Judge::default();
                    let judged = judge.judge(0, case, "", self.limits, &frames);
                    Outcome::Judged(Box::new(judged.record))
                }
                Err(Failure::Lost(Loss::Cancelled)) => return Ok(()),
                Err(failure) => {
                    let (verdict, lost) = (failure.verdict(), failure.ends_worker());
                    let message = match failure {
                        Failure::Backend(error) => error.to_string(),
                        Failure::Lost(loss) => {
                            let ExitReport { message, .. } = process.exit_report(loss);
                            message
                        }
                    };
                    if lost {
                        worker = Worker::start(self.launch)?;
                        // What was asked behind it was lost with it.
                        for (number, since) in &mut asked {
                            let case = self.cases[*number];
                            worker.process.request_case(*number as u32, case);
                            *since = Instant::now();
                        }
                    }
                    Outcome::NotDrawn {
                        verdict,
                        message,
                        lost,
                    }
                }
            };
            lock(self.found)[number] = Some(outcome);
        }
    }
}
