//! Reductions on a driver: the judge as oracle.
//!
//! A case that ends its worker is reduced like one that is drawn wrong: a candidate must end its worker in the same
//! way. Each such candidate costs a process, and each that hangs its time.

use crate::failure::Failure;
use etalon_case::{Case, CaseRef, build};
use etalon_diagnose::{Driver, Key, Symptom, Traits, Unreduced};
use etalon_explore::{Budget, Candidate, MOST_DRAWS, Oracle, Reduction, keys, reduce};
use etalon_frame::Limits;
use etalon_record::{Record, Verdict};
use etalon_runner::{Launch, Trials, Worker};
use serde_json::Value;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Returns the name of the case file, which is also the id of its case: letters and digits, as ids have them.
pub(crate) fn file_name(case: &str, adapter: &str) -> String {
    let word = |text: &str| -> String {
        let letters = text.chars();
        letters
            .map(|c| {
                if c.is_ascii_alphanumeric() || "-_.+".contains(c) {
                    c
                } else {
                    '-'
                }
            })
            .collect()
    };
    format!("{}.{}", word(case), word(adapter))
}

/// The time that a case may take.
pub(crate) const TIMEOUT: &str = "20";
/// The time of a candidate, if the case does not end.
const HUNG_TIME: Duration = Duration::from_secs(2);
/// The most keys of a scene that is reduced for a comparison.
const MOST_KEYS: usize = 600;

/// The most draws of a reduction: nineteen of twenty need fewer than 260, and what needs more mostly depends on what
/// was drawn before.
const DRAWS: usize = 400;

/// Draws a reduced case in a fresh process.
pub(crate) fn confirm(
    launch: &Launch,
    case: &Case,
    symptom: &Symptom,
    timeout: Duration,
) -> Result<(), String> {
    let mut worker = Worker::start(launch).map_err(|e| e.to_string())?;
    let (record, _) = worker.record(case, timeout);
    let alone = Symptom::of(&record);
    if symptom.covers(&alone) {
        Ok(())
    } else {
        Err(unconfirmed(symptom, &alone))
    }
}

/// Returns the sentence on a case that fails in another way, or not at all, when it is drawn alone.
fn unconfirmed(before: &Symptom, alone: &Symptom) -> String {
    if alone.verdict.is_bad() {
        return format!(
            "is unsteady: it failed by {before}, and drawn alone in a new process it fails by {alone}"
        );
    }
    format!(
        "fails only after others in the same process: drawn alone it is {}",
        alone.verdict
    )
}

/// The judge as oracle, with a driver's frames; of a case that ends its worker, the way in which it does.
pub(crate) struct DriverOracle<'a> {
    pub(crate) trials: Trials,
    /// The symptom of the smallest case so far, and its record.
    pub(crate) symptom: Symptom,
    pub(crate) record: Record,
    pub(crate) error: Option<String>,
    /// Set when the search is being stopped.
    stop: Option<&'a AtomicBool>,
    /// Starts the process in which each candidate that fails is drawn once more, alone: for drivers on which a failure
    /// leaves something behind that makes the next case fail.
    pub(crate) alone: Option<Launch>,
}

impl<'a> DriverOracle<'a> {
    /// An oracle on a case with this record. A case may take as long as `timeout`.
    pub(crate) fn new(
        mut trials: Trials,
        record: Record,
        timeout: Duration,
        stop: Option<&'a AtomicBool>,
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

    /// Reduces the case with so many draws at most.
    pub(crate) fn reduce(
        &mut self,
        failing: Candidate,
        limits: &Limits,
        draws: usize,
    ) -> Reduction {
        let can_draw = |case: &Case| limits.missing(&case.requirements()).is_none();
        let budget = if self.record.verdict.is_violation() {
            Budget::draws(draws)
        } else {
            Budget::of_processes()
        };
        reduce(failing, budget.with_stop(self.stop), &can_draw, self)
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
            if !symptom.covers(&seen) {
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
                *error = Some(failed.to_string());
                None
            }
        }
    }

    fn texel(&self) -> Option<[u32; 2]> {
        self.record.wrong.first().map(|w| [w.x, w.y])
    }
}

/// A failing scene that was looked at.
pub(crate) struct Looked {
    /// What is left of it.
    pub(crate) scene: Candidate,
    pub(crate) record: Record,
    pub(crate) symptom: Symptom,
    pub(crate) key: Key,
}

/// Reduces cases on one driver, whose worker is started when it is needed.
pub(crate) struct Reducer<'a> {
    pub(crate) launch: Launch,
    pub(crate) limits: Limits,
    /// The time that a case may take.
    pub(crate) timeout: Duration,
    /// Set when the search is being stopped.
    pub(crate) stop: &'a AtomicBool,
    trials: Option<Trials>,
}

impl<'a> Reducer<'a> {
    pub(crate) fn new(
        launch: Launch,
        limits: Limits,
        timeout: Duration,
        stop: &'a AtomicBool,
    ) -> Self {
        Self {
            launch,
            limits,
            timeout,
            stop,
            trials: None,
        }
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Returns an oracle on a case with this record, which is to be given back.
    pub(crate) fn oracle(&mut self, record: Record) -> Result<DriverOracle<'a>, Failure> {
        let trials = self.trials()?;
        let stop = Some(self.stop);
        Ok(DriverOracle::new(trials, record, self.timeout, stop))
    }

    /// Keeps the worker of an oracle for the next one.
    pub(crate) fn give_back(&mut self, oracle: DriverOracle<'_>) -> Result<(), Failure> {
        if let Some(error) = oracle.error {
            let adapter = &self.launch.adapter;
            return Err(Failure::incomplete(format!(
                "the worker of {adapter} could not be started again: {error}"
            )));
        }
        self.trials = Some(oracle.trials);
        Ok(())
    }

    /// Reduces a failing scene, if it fails by itself.
    pub(crate) fn look(
        &mut self,
        scene: Candidate,
        record: Record,
        symptom: Symptom,
    ) -> Result<Looked, Failure> {
        let whole = |scene: Candidate, record: Record, symptom: Symptom, why| Looked {
            key: Key::whole(&scene.document, &symptom, why),
            scene,
            record,
            symptom,
        };
        if self.is_stopped() {
            return Ok(whole(scene, record, symptom, Unreduced::Stopped));
        }
        let mut oracle = self.oracle(record)?;
        let again = oracle.first(&mut std::iter::once(scene.clone()));
        let looked = if again.is_none() {
            whole(scene, oracle.record.clone(), symptom, Unreduced::Unsteady)
        } else {
            let reduction = oracle.reduce(scene, &self.limits, DRAWS);
            Looked {
                key: Key::reduced(&reduction.smallest.document, &oracle.symptom),
                scene: reduction.smallest,
                record: oracle.record.clone(),
                symptom: oracle.symptom.clone(),
            }
        };
        self.give_back(oracle)?;
        Ok(looked)
    }

    fn trials(&mut self) -> Result<Trials, Failure> {
        match self.trials.take() {
            Some(trials) => Ok(trials),
            None => {
                let worker = Worker::start(&self.launch).map_err(Failure::incomplete)?;
                Ok(Trials::new(self.launch.clone(), worker, self.timeout))
            }
        }
    }
}

impl<'a> Driver for Reducer<'a> {
    type Named = CaseRef<'a>;
    type Case = Candidate;
    type Error = Failure;

    fn is_stopped(&self) -> bool {
        self.is_stopped()
    }

    fn document(&self, named: &CaseRef<'a>) -> Option<Value> {
        named.document().ok()
    }

    fn draw(&mut self, document: &Value) -> Result<Option<(Candidate, Record)>, Failure> {
        // A case may need all that it reads.
        let Ok(case) = build("found/known", document) else {
            return Ok(None);
        };
        if keys(&document["scene"]) > MOST_KEYS
            || self.limits.missing(&case.requirements()).is_some()
        {
            return Ok(None);
        }
        let mut trials = self.trials()?;
        let mut next = Some(&case);
        let mut record = None;
        let drawn = trials.first(&mut || next.take(), |case| *case, &mut |_, judged| {
            record = Some(judged);
            true
        });
        drawn.map_err(Failure::incomplete)?;
        self.trials = Some(trials);
        let document = document.clone();
        Ok(record.map(|record| (Candidate { document, case }, record)))
    }

    fn reduce(
        &mut self,
        case: Candidate,
        record: Record,
    ) -> Result<(Candidate, Symptom, Traits), Failure> {
        let mut oracle = self.oracle(record)?;
        let smallest = oracle.reduce(case, &self.limits, MOST_DRAWS).smallest;
        let symptom = oracle.symptom.clone();
        self.give_back(oracle)?;
        let traits = Traits::of(&smallest.document, &symptom);
        Ok((smallest, symptom, traits))
    }

    fn is_steady(&self, case: &Candidate, symptom: &Symptom) -> bool {
        confirm(&self.launch, &case.case, symptom, self.timeout).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crash_alone_is_no_success_alone() {
        let symptom = |verdict| Symptom::of(&Record::new("a", "gl:x", verdict));
        let (fail, crash, pass) = (Verdict::Fail, Verdict::Crash, Verdict::Pass);
        let unsteady = unconfirmed(&symptom(fail), &symptom(crash));
        assert!(unsteady.starts_with("is unsteady"), "{unsteady}");
        assert!(!unsteady.contains("only after"), "{unsteady}");
        let after = unconfirmed(&symptom(fail), &symptom(pass));
        assert!(after.ends_with("drawn alone it is pass"), "{after}");
    }
}
