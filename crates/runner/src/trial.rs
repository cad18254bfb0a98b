//! Trials: cases that are drawn one after another on a warm worker, until one of them is accepted.
//!
//! Requests run ahead of the answers, so that the driver draws while frames are judged. Every case that was
//! requested after the accepted one is wasted, so only a few requests run ahead at first, and more with
//! each rejected case.

use crate::drawing::DueAnswers;
use crate::launch::{Launch, StartError};
use crate::outcome::outcome;
use crate::process::Wait;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_record::Record;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// The maximum number of requests in flight.
const MOST_AHEAD: usize = 4;

/// A worker that is started again after each case that ends it.
pub struct Trials {
    pub(crate) launch: Launch,
    worker: Worker,
    ahead: usize,
    slot: u32,
    /// The time that a case may take.
    pub timeout: Duration,
}

impl Trials {
    /// Creates trials on a running worker.
    pub fn new(launch: Launch, worker: Worker, timeout: Duration) -> Self {
        Self {
            launch,
            worker,
            ahead: 1,
            slot: 0,
            timeout,
        }
    }

    /// Draws and judges the cases that `next` returns until `found` accepts one with its record, and
    /// returns that case.
    ///
    /// # Errors
    /// If a lost worker cannot be started again.
    pub fn first<C>(
        &mut self,
        next: &mut dyn FnMut() -> Option<C>,
        case: impl Fn(&C) -> &Case,
        found: &mut dyn FnMut(&C, Record) -> bool,
    ) -> Result<Option<C>, StartError> {
        let mut asked: VecDeque<(u32, C, Instant)> = VecDeque::new();
        let mut result = None;
        loop {
            while result.is_none() && asked.len() < self.ahead {
                let Some(candidate) = next() else { break };
                self.slot = self.slot.wrapping_add(1);
                let slot = self.slot;
                self.worker.process.request_case(slot, case(&candidate));
                asked.push_back((slot, candidate, Instant::now()));
            }
            let Some((slot, candidate, since)) = asked.pop_front() else {
                return Ok(result);
            };
            let requests = DueAnswers::of(case(&candidate));
            let wait = Wait::of(self.timeout);
            let process = &mut self.worker.process;
            let drawing = process.receive_frames(slot, requests, since, wait);
            if result.is_some() && drawing.frames.is_ok() {
                continue;
            }
            let limits = &self.worker.hello.limits;
            let (record, ends) = outcome(process, case(&candidate), limits, drawing.frames);
            if result.is_none() && found(&candidate, record) {
                result = Some(candidate);
                self.ahead = 1;
            } else {
                self.ahead = (self.ahead + 1).min(MOST_AHEAD);
            }
            if ends {
                self.worker = Worker::start(&self.launch)?;
                // Requests after the lost one were lost with it.
                if result.is_some() {
                    return Ok(result);
                }
                for (slot, candidate, since) in &mut asked {
                    self.worker.process.request_case(*slot, case(candidate));
                    *since = Instant::now();
                }
            }
        }
    }
}
