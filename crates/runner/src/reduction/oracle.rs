//! The judge as oracle, with a driver's frames.

use crate::launch::{Launch, StartError};
use crate::trial::Trials;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_diagnose::Symptom;
use etalon_explore::{Candidate, Oracle, Reduction, ReductionLimits, reduce};
use etalon_frame::{Limits, Story};
use etalon_record::{Record, Verdict};
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use thiserror::Error;

/// The time limit of a candidate if the original case hangs.
const HUNG_TIME: Duration = Duration::from_secs(2);

/// A worker that a candidate ended did not start again.
#[derive(Debug, Error)]
#[error("the worker of {adapter} could not be started again: {error}")]
pub struct Lost {
    /// The name of the adapter.
    adapter: String,
    /// The error from starting the worker.
    error: StartError,
}

/// An error from confirming a failure.
#[derive(Debug, Error)]
pub enum Unconfirmed {
    /// No new process could be started.
    #[error("could not be drawn in a new process: {0}")]
    Start(#[from] StartError),
    /// The case fails with the second symptom instead of the first.
    #[error("is unsteady: it failed by {0}, and drawn alone in a new process it fails by {1}")]
    Unsteady(Box<Symptom>, Box<Symptom>),
    /// The case does not fail when it is drawn alone.
    #[error("fails only after others in the same process: drawn alone it is {0}")]
    FailsAfterOthers(Verdict),
}

/// Draws a case in a new process and checks that it fails there with this symptom.
///
/// # Errors
/// If the process does not start, or the case fails in another way or not at all.
pub fn confirm(
    launch: &Launch,
    case: &Case,
    symptom: &Symptom,
    timeout: Duration,
) -> Result<(), Unconfirmed> {
    let mut worker = Worker::start(launch)?;
    let (record, _) = worker.record(case, timeout);
    let alone = Symptom::of(&record);
    if symptom.covers(&alone) {
        return Ok(());
    }
    Err(Unconfirmed::of(symptom, alone))
}

impl Unconfirmed {
    /// Returns why a failure with `symptom` is not confirmed by `alone`, the symptom of the case drawn alone.
    fn of(symptom: &Symptom, alone: Symptom) -> Self {
        if alone.verdict.is_bad() {
            Self::Unsteady(Box::new(symptom.clone()), Box::new(alone))
        } else {
            Self::FailsAfterOthers(alone.verdict)
        }
    }
}

/// An oracle that draws candidates on a driver. A candidate must fail like the smallest case so far. If the
/// case ends its worker, the candidate must end it in the same way.
pub(super) struct DriverOracle<'a> {
    trials: Trials,
    /// The symptom of the smallest case so far, and its record.
    symptom: Symptom,
    record: Record,
    /// The reason why a worker that a candidate ended did not start again.
    error: Option<StartError>,
    /// True once the search is being stopped.
    stop: &'a AtomicBool,
    /// If set, each failing candidate is drawn again alone, in a process that this command starts, and must
    /// fail there too. This is needed if a failure leaves the driver in a state that makes the next case
    /// fail.
    pub(super) alone: Option<Launch>,
}

impl<'a> DriverOracle<'a> {
    /// Makes an oracle for a case with this record. `timeout` is the time limit of a case.
    pub(super) fn new(
        mut trials: Trials,
        record: Record,
        timeout: Duration,
        stop: &'a AtomicBool,
    ) -> Self {
        let hangs = record.verdict == Verdict::Timeout;
        trials.timeout = if hangs {
            timeout.min(HUNG_TIME)
        } else {
            timeout
        };
        Self {
            trials,
            symptom: Symptom::of(&record),
            record,
            error: None,
            stop,
            alone: None,
        }
    }

    /// Reduces the case, drawing scenes at most `draws` times.
    pub(super) fn reduce(
        &mut self,
        failing: Candidate,
        limits: &Limits,
        draws: usize,
    ) -> Reduction {
        let can_draw = |case: &Case| limits.missing(&case.requirements()).is_none();
        let budget = if self.symptom.keeps_worker() {
            ReductionLimits::draws(draws)
        } else {
            ReductionLimits::of_processes()
        };
        reduce(failing, budget.with_stop(Some(self.stop)), &can_draw, self)
    }

    /// Returns the worker, and the record and symptom of the smallest case.
    ///
    /// # Errors
    /// If a worker that a candidate ended did not start again.
    pub(super) fn finish(self) -> Result<(Trials, Record, Symptom), Lost> {
        match self.error {
            Some(error) => Err(Lost {
                adapter: self.trials.launch.adapter,
                error,
            }),
            None => Ok((self.trials, self.record, self.symptom)),
        }
    }
}

impl Oracle for DriverOracle<'_> {
    fn first(&mut self, candidates: &mut dyn Iterator<Item = Candidate>) -> Option<Candidate> {
        let Self {
            trials,
            symptom,
            record,
            error,
            alone,
            ..
        } = self;
        if error.is_some() {
            return None;
        }
        let mut next = || candidates.next();
        let timeout = trials.timeout;
        let mut found = |candidate: &Candidate, judged: Record| {
            let seen = Symptom::of(&judged);
            if !symptom.covers(&seen) || hides_draw(&judged) && !hides_draw(record) {
                return false;
            }
            let fails_alone =
                |launch: &Launch| confirm(launch, &candidate.case, &seen, timeout).is_ok();
            if !alone.as_ref().is_none_or(fails_alone) {
                return false;
            }
            *symptom = seen;
            *record = judged;
            true
        };
        match trials.first(&mut next, |c| &c.case, &mut found) {
            Ok(found) => found,
            Err(failed) => {
                *error = Some(failed);
                None
            }
        }
    }

    fn texel(&self) -> Option<[u32; 2]> {
        self.record.wrong.first().map(|w| [w.x, w.y])
    }
}

/// Returns true if the record's story is about a draw that stores what was there before.
fn hides_draw(record: &Record) -> bool {
    let story = record.story.as_ref();
    story.is_some_and(Story::stores_initial_contents)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_that_crashes_alone_is_unsteady() {
        let symptom = |verdict| Symptom::of(&Record::new("a", "gl:x", verdict));
        let fail = symptom(Verdict::Fail);
        let unsteady = Unconfirmed::of(&fail, symptom(Verdict::Crash));
        assert!(matches!(unsteady, Unconfirmed::Unsteady(..)), "{unsteady}");
        let after = Unconfirmed::of(&fail, symptom(Verdict::Pass));
        assert!(
            after.to_string().ends_with("drawn alone it is pass"),
            "{after}"
        );
    }
}
