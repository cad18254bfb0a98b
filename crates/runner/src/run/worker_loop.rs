//! The loop of one thread: its worker draws cases of an adapter, round trips first, and the thread judges
//! and records them.
//!
//! Requests are pipelined: while the worker draws the next cases, the thread judges the previous one.

use super::adapter_queue::AdapterQueue;
use super::adapter_run::{Observation, RunningAdapter};
use super::second_look::confirm;
use super::shared::Shared;
use crate::drawing::{Drawing, DueAnswers};
use crate::event::RunEvent;
use crate::loss::{Loss, RequestError};
use crate::sized::SizingAdapter;
use crate::supervisor::Supervisor;
use etalon_judge::RoundTrips;
use etalon_record::{Reason, Record};
use std::collections::VecDeque;
use std::sync::PoisonError;
use std::time::Instant;

/// The number of cases that are requested ahead.
const IN_FLIGHT: usize = 4;

/// A case that was requested.
struct Requested {
    number: usize,
    at: Instant,
}

/// One thread with its worker.
pub(super) struct WorkerLoop<'s, 'a> {
    run: RunningAdapter<'s, 'a>,
    supervisor: Supervisor,
    /// The cases requested from the current worker, in order.
    history: Vec<usize>,
    /// The supervisor's generation to which `history` belongs.
    generation: u32,
}

impl<'s, 'a> WorkerLoop<'s, 'a> {
    pub(super) fn new(shared: &'s Shared<'a>, queue: &'s AdapterQueue) -> Self {
        let supervisor = Supervisor::new(
            queue.launch.clone(),
            shared.options.memory,
            queue.failed_starts.clone(),
            queue.bad_ends.clone(),
            None,
        );
        Self {
            run: RunningAdapter { shared, queue },
            generation: supervisor.generation(),
            supervisor,
            history: Vec::new(),
        }
    }

    /// Draws and records cases until the queue is empty or the run is stopped.
    pub(super) fn run(&mut self) {
        let run = self.run;
        let (shared, queue) = (run.shared, run.queue);
        if queue.begin(shared.budget.as_ref()) {
            (shared.events)(RunEvent::AdapterStarted {
                adapter: queue.adapter.info.name.clone(),
                cases: queue.record_count(),
            });
        }
        if let Some(error) = &queue.start_error {
            return run.record_not_started(error);
        }
        let round_trips = queue.round_trips_or(|| {
            // The thread that draws first takes over the running worker, and does not start another one.
            self.supervisor.take_over(queue.take_running());
            self.draw_round_trips()
        });
        if let Some(end) = round_trips.not_started() {
            return run.record_not_started(&end.error);
        }
        self.draw(&mut || queue.take(), &mut |_, record| run.record(record));
    }

    /// Draws the adapter's round trips. Selected round trips are recorded.
    fn draw_round_trips(&mut self) -> RoundTrips {
        let run = self.run;
        let leading = run.queue.leading();
        let mut found = leading.known.clone();
        let mut left: VecDeque<usize> = leading.cases.iter().copied().collect();
        self.draw(&mut || std::mem::take(&mut left), &mut |number, record| {
            found.take(run.case(number), &record);
            if run.queue.has_record(number) {
                run.record(record);
            }
        });
        found
    }

    /// Draws the cases that `take` returns until it returns none, or until the run is stopped. `done` gets
    /// each record.
    fn draw(
        &mut self,
        take: &mut dyn FnMut() -> VecDeque<usize>,
        done: &mut dyn FnMut(usize, Record),
    ) {
        let run = self.run;
        let shared = run.shared;
        let mut taken: VecDeque<usize> = VecDeque::new();
        let mut requested: VecDeque<Requested> = VecDeque::new();
        while !shared.stopped() {
            // A thread that times frames waits for this lock and then keeps other threads from taking it.
            let busy = shared.quiet.read().unwrap_or_else(PoisonError::into_inner);
            loop {
                if taken.is_empty() {
                    taken = take();
                }
                let Some(number) = taken.front().copied() else {
                    break;
                };
                let timed = |number: usize| run.case(number).method.is_some();
                // No other request may be in flight while frames are timed.
                let alone = timed(number) || requested.front().is_some_and(|r| timed(r.number));
                if requested.len() >= if alone { 1 } else { IN_FLIGHT } {
                    break;
                }
                taken.pop_front();
                if let Some(record) = run.undrawn(number) {
                    done(number, run.settled(record));
                    continue;
                }
                self.request(number);
                requested.push_back(Requested {
                    number,
                    at: Instant::now(),
                });
            }
            let Some(Requested { number, at }) = requested.pop_front() else {
                break;
            };
            let drawing = self.receive(number, at);
            let before = self.before(number);
            let Some(observed) = self.observe(number, drawing) else {
                break;
            };
            let alone = run.queue.launch.alone;
            if !alone && !self.supervisor.is_running() {
                self.request_again(&mut requested);
            }
            let mut make_room = || {
                if alone {
                    self.supervisor.stop();
                }
            };
            let Some(mut observed) = confirm(&run, number, observed, &before, &mut make_room)
            else {
                break;
            };
            if alone && !self.supervisor.is_running() {
                self.request_again(&mut requested);
            }
            if let Err(error) = run.keep(number, &mut observed) {
                shared.fail(error);
                break;
            }
            if observed.record.measured.is_some() {
                drop(busy);
                self.time(number, &mut observed.record);
            }
            done(number, run.settled(observed.record));
        }
    }

    fn request(&mut self, number: usize) {
        let Ok(worker) = self.supervisor.worker() else {
            return;
        };
        worker.request_case(number as u32, self.run.case(number));
        if self.supervisor.generation() != self.generation {
            self.generation = self.supervisor.generation();
            self.history.clear();
        }
        self.history.push(number);
    }

    /// Requests again the cases that were in flight after the case that cost the worker.
    fn request_again(&mut self, requested: &mut VecDeque<Requested>) {
        for case in requested {
            self.request(case.number);
            case.at = Instant::now();
        }
    }

    /// Returns the cases that the worker drew before this case.
    fn before(&self, number: usize) -> Vec<usize> {
        let index = self.history.iter().rposition(|n| *n == number);
        self.history[..index.unwrap_or(0)].to_vec()
    }

    fn receive(&mut self, number: usize, asked: Instant) -> Drawing {
        let case = self.run.case(number);
        let wait = self.run.wait(case);
        match self.supervisor.running() {
            Ok(worker) => worker.receive_frames(number as u32, DueAnswers::of(case), asked, wait),
            Err(loss) => Drawing::failed(RequestError::Lost(loss)),
        }
    }

    /// Judges a drawing; returns `None` if the run is stopped.
    fn observe(&mut self, number: usize, drawing: Drawing) -> Option<Observation> {
        if matches!(drawing.frames, Err(RequestError::Lost(Loss::Cancelled))) {
            return None;
        }
        let supervisor = &mut self.supervisor;
        let report = |failure| supervisor.report(failure);
        Some(self.run.observe(number, drawing, report))
    }

    /// Times a method case. A wrong picture is not timed.
    fn time(&mut self, number: usize, record: &mut Record) {
        let run = self.run;
        let Ok(worker) = self.supervisor.running() else {
            return;
        };
        if record.verdict.is_bad() {
            return;
        }
        let case = run.case(number);
        let adapter = &run.queue.adapter;
        // Their truths take long, and are computed while others draw.
        let sizes = run.sized_scenes(case);
        let timed = {
            let quiet = &run.shared.quiet;
            let _alone = quiet.write().unwrap_or_else(PoisonError::into_inner);
            let timeout = run.measuring_timeout();
            let slot = number as u32;
            let frame = worker.measure(slot, &case.scene, &adapter.limits, timeout);
            frame.and_then(|frame| {
                if sizes.is_empty() {
                    return Ok((frame, (Vec::new(), None)));
                }
                let adapter = SizingAdapter {
                    limits: &adapter.limits,
                    is_software: adapter.info.software,
                    memory: run.shared.options.memory,
                };
                Ok((
                    frame,
                    worker.measure_sizes(slot, &sizes, &adapter, timeout)?,
                ))
            })
        };
        match timed {
            Ok((frame, (sizes, cost))) => {
                if let Some(measured) = &mut record.measured {
                    measured.time = frame.times;
                    measured.fragments = frame.fragments;
                    measured.sizes = sizes;
                    measured.cost = cost;
                }
            }
            Err(loss) => {
                let report = self.supervisor.report(loss.into());
                record.verdict = report.verdict;
                let text = report.error.map(|(text, _)| Reason::Text(text));
                record.reasons = [Reason::WhileTimed].into_iter().chain(text).collect();
                record.process = report.process;
            }
        }
    }
}
