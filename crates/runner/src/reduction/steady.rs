//! Draws one case repeatedly: only a failure that happens every time can be reduced.

use super::{Flakiness, ReductionError};
use crate::launch::Launch;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_diagnose::Symptom;
use etalon_record::{Record, Verdict};
use std::time::Duration;

/// The number of processes that draw a case at the start, and how often each draws it. A failure that depends
/// on either is not steady.
const PROCESSES: usize = 4;
const DRAWINGS: usize = 3;
/// The number of processes for a case that hangs; each costs the full time limit.
const HUNG: usize = 2;

/// Draws a case several times in each of several processes, or once per process if the case ends its process.
/// Returns a worker, the first record and its symptom if the case fails in the same way every time.
pub(super) fn steady(
    id: &str,
    case: &Case,
    launch: &Launch,
    first: Worker,
    timeout: Duration,
) -> Result<(Worker, Record, Symptom), ReductionError> {
    let mut records: Vec<Record> = Vec::new();
    let mut worker = Some(first);
    let mut warm = None;
    let mut processes = 0;
    let hung = |records: &[Record]| records.iter().any(|r| r.verdict == Verdict::Timeout);
    while processes < if hung(&records) { HUNG } else { PROCESSES } {
        processes += 1;
        let mut running = match worker.take() {
            Some(worker) => worker,
            None => Worker::start(launch)?,
        };
        let mut ended = false;
        for _ in 0..DRAWINGS {
            let (record, ends) = running.record(case, timeout);
            if record.verdict == Verdict::NotSupported {
                return Err(ReductionError::NotSupported {
                    adapter: launch.adapter.clone(),
                    record: Box::new(record),
                });
            }
            records.push(record);
            ended = ends;
            if ended {
                break;
            }
        }
        if !ended {
            warm.get_or_insert(running);
        }
    }
    let worker = match warm {
        Some(worker) => worker,
        None => Worker::start(launch)?,
    };
    let drawings = records.len();
    let failing = |r: &&Record| r.verdict.is_bad() && r.verdict != Verdict::Open;
    let ways: Vec<Symptom> = records.iter().filter(failing).map(Symptom::of).collect();
    let record = records.swap_remove(0);
    let flaky = |flakiness| ReductionError::Flaky {
        case: id.to_owned(),
        adapter: launch.adapter.clone(),
        flakiness,
    };
    let Some(way) = ways.first() else {
        return Err(ReductionError::Passes {
            case: id.to_owned(),
            adapter: launch.adapter.clone(),
            record: Box::new(record),
        });
    };
    if ways.len() < drawings {
        return Err(flaky(Flakiness::Sometimes {
            failing: ways.len(),
            drawings,
            processes,
        }));
    }
    let same = |other: &&Symptom| way.covers(other) && other.covers(way);
    match ways.iter().find(|other| !same(other)) {
        None => Ok((worker, record, way.clone())),
        Some(other) => Err(flaky(Flakiness::TwoWays(
            Box::new(way.clone()),
            Box::new(other.clone()),
        ))),
    }
}
