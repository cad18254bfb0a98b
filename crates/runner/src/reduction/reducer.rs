//! Reductions of many cases on one driver.

use super::ReductionError;
use super::oracle::{DriverOracle, confirm};
use crate::launch::Launch;
use crate::trial::Trials;
use crate::worker::Worker;
use etalon_case::{CaseRef, build};
use etalon_diagnose::{Driver, Key, Symptom, Traits, Unreduced};
use etalon_explore::{Candidate, MOST_DRAWS, Oracle, draw_facts, keys};
use etalon_frame::Limits;
use etalon_record::Record;
use serde_json::Value;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The largest number of keys of a scene that is reduced for a comparison.
const MOST_KEYS: usize = 600;

/// The largest number of draws of a reduction. 95 % of reductions need fewer than 260; most of the others
/// depend on what was drawn earlier.
const DRAWS: usize = 400;

/// A failing scene after its reduction.
pub struct Looked {
    /// The reduced scene, or the whole scene if it was not reduced.
    pub scene: Candidate,
    /// The record of `scene` on the driver.
    pub record: Record,
    /// The failure of the reduced scene.
    pub symptom: Symptom,
    /// The key of the scene's group.
    pub key: Key,
}

impl Looked {
    /// Returns true if the scene was reduced.
    pub fn is_reduced(&self) -> bool {
        self.key.is_reduced()
    }
}

/// Reduces cases on one driver; starts its worker on demand.
pub struct Reducer<'a> {
    /// The command and environment of the driver's worker.
    pub launch: Launch,
    /// The limits of the driver.
    limits: Limits,
    /// The time limit of a case.
    pub timeout: Duration,
    /// True once the search is being stopped.
    pub stop: &'a AtomicBool,
    trials: Option<Trials>,
}

impl<'a> Reducer<'a> {
    /// Makes a reducer without a worker.
    pub fn new(launch: Launch, limits: Limits, timeout: Duration, stop: &'a AtomicBool) -> Self {
        Self {
            launch,
            limits,
            timeout,
            stop,
            trials: None,
        }
    }

    /// Returns true if the search is being stopped.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Returns an oracle for a case with this record. Return it with [`Self::finish`].
    fn oracle(&mut self, record: Record) -> Result<DriverOracle<'a>, ReductionError> {
        let trials = self.trials()?;
        Ok(DriverOracle::new(trials, record, self.timeout, self.stop))
    }

    /// Keeps an oracle's worker for the next oracle. Returns the record and symptom of its smallest case.
    fn finish(&mut self, oracle: DriverOracle<'_>) -> Result<(Record, Symptom), ReductionError> {
        let (trials, record, symptom) = oracle.finish()?;
        self.trials = Some(trials);
        Ok((record, symptom))
    }

    /// Draws a failing scene again, and reduces it if it fails again.
    ///
    /// # Errors
    /// If a worker does not start.
    pub fn look(
        &mut self,
        scene: Candidate,
        record: Record,
        symptom: Symptom,
    ) -> Result<Looked, ReductionError> {
        let unreduced = |scene: Candidate, record: Record, symptom: Symptom, why| Looked {
            key: Key::whole(&symptom, why),
            scene,
            record,
            symptom,
        };
        if self.is_stopped() {
            return Ok(unreduced(scene, record, symptom, Unreduced::Stopped));
        }
        let mut oracle = self.oracle(record)?;
        if oracle.first(&mut std::iter::once(scene.clone())).is_none() {
            let (record, _) = self.finish(oracle)?;
            return Ok(unreduced(scene, record, symptom, Unreduced::Unsteady));
        }
        let scene = oracle.reduce(scene, &self.limits, DRAWS).smallest;
        let (record, symptom) = self.finish(oracle)?;
        Ok(Looked {
            key: Key::reduced(&scene.document, &symptom),
            scene,
            record,
            symptom,
        })
    }

    fn trials(&mut self) -> Result<Trials, ReductionError> {
        match self.trials.take() {
            Some(trials) => Ok(trials),
            None => {
                let worker = Worker::start(&self.launch)?;
                Ok(Trials::new(self.launch.clone(), worker, self.timeout))
            }
        }
    }
}

impl<'a> Driver for Reducer<'a> {
    type Named = CaseRef<'a>;
    type Case = Candidate;
    type Error = ReductionError;

    fn is_stopped(&self) -> bool {
        self.is_stopped()
    }

    fn document(&self, named: &CaseRef<'a>) -> Option<Value> {
        named.document().ok()
    }

    fn draw(&mut self, document: &Value) -> Result<Option<(Candidate, Record)>, ReductionError> {
        // A case can become invalid if fewer attachments are read.
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
        drawn?;
        self.trials = Some(trials);
        let document = document.clone();
        Ok(record.map(|record| (Candidate { document, case }, record)))
    }

    fn reduce(
        &mut self,
        case: Candidate,
        record: Record,
    ) -> Result<(Candidate, Symptom, Traits), ReductionError> {
        let mut oracle = self.oracle(record)?;
        let smallest = oracle.reduce(case, &self.limits, MOST_DRAWS).smallest;
        let (_, symptom) = self.finish(oracle)?;
        let traits = Traits::of(&smallest.document, &symptom, Self::facts(&smallest));
        Ok((smallest, symptom, traits))
    }

    fn facts(case: &Candidate) -> Vec<Vec<String>> {
        draw_facts(&case.case)
    }

    fn is_steady(&self, case: &Candidate, symptom: &Symptom) -> bool {
        confirm(&self.launch, &case.case, symptom, self.timeout).is_ok()
    }
}
