//! Reduces a case that fails on an adapter to the smallest one that fails in the same way.

use super::ReductionError;
use super::oracle::{DriverOracle, Unconfirmed, confirm};
use super::steady::steady;
use crate::launch::Launch;
use crate::trial::Trials;
use crate::worker::Worker;
use etalon_diagnose::Symptom;
use etalon_explore::{Candidate, MOST_DRAWS, Reduction};
use etalon_record::Record;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A reduced case.
pub struct Smallest {
    /// The reduced case, and what the reduction cost.
    pub reduction: Reduction,
    /// The record of the reduced case, from its last drawing.
    pub record: Record,
    /// The symptom of the case that was reduced.
    pub first: Symptom,
    /// The symptom of the reduced case.
    pub symptom: Symptom,
    /// The wall time of the reduction, in seconds.
    pub seconds: f64,
}

/// Reduces a case that fails in the same way every time. `id` names the case in errors.
///
/// # Errors
/// If the case does not fail steadily, or the reduced case does not, or no worker starts.
pub fn smallest(
    id: &str,
    failing: Candidate,
    launch: &Launch,
    worker: Worker,
    timeout: Duration,
    stop: &AtomicBool,
) -> Result<Smallest, ReductionError> {
    let limits = worker.hello.limits.clone();
    let (worker, record, first) = steady(id, &failing.case, launch, worker, timeout)?;
    let begun = Instant::now();
    let reduced = |worker: Worker, alone: Option<Launch>| {
        let trials = Trials::new(launch.clone(), worker, timeout);
        let mut oracle = DriverOracle::new(trials, record.clone(), timeout, stop);
        oracle.alone = alone;
        let reduction = oracle.reduce(failing.clone(), &limits, MOST_DRAWS);
        let finished = oracle.finish();
        finished.map(|(_, record, symptom)| (reduction, record, symptom))
    };
    let confirmed = |reduction: &Reduction, symptom: &Symptom| {
        confirm(launch, &reduction.smallest.case, symptom, timeout)
    };
    let (mut reduction, mut last, mut symptom) = reduced(worker, None)?;
    if confirmed(&reduction, &symptom).is_err() {
        let fresh = Worker::start(launch)?;
        let draws = reduction.draws;
        (reduction, last, symptom) = reduced(fresh, Some(launch.clone()))?;
        reduction.draws += draws;
        confirmed(&reduction, &symptom).map_err(|why: Unconfirmed| {
            ReductionError::Unconfirmed {
                case: id.to_owned(),
                why,
            }
        })?;
    }
    let seconds = begun.elapsed().as_secs_f64();
    Ok(Smallest {
        reduction,
        record: last,
        first,
        symptom,
        seconds,
    })
}
