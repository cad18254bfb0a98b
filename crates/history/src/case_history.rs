//! One case across all runs.

use crate::error::HistoryError;
use crate::history::History;
use crate::ids::{OutcomeId, RunId};
use crate::runs::AdapterRun;
use std::collections::HashMap;
use std::rc::Rc;

/// One case on one adapter across the runs that drew it.
#[derive(Clone, Debug)]
pub struct CaseHistory {
    /// The timeline of the adapter.
    pub timeline: Rc<str>,
    /// The case's points by the times of their runs; at least one. Runs without a record of the case have no
    /// point.
    pub points: Vec<RunPoint>,
}

/// The record of one case on one adapter in one run.
#[derive(Clone, Debug)]
pub struct RunPoint {
    /// The run.
    pub run: RunId,
    /// The outcome; see [`History::outcome`].
    pub outcome: OutcomeId,
    /// The index of the adapter in [`History::adapter_runs`], which has its driver, version and machine.
    pub place: usize,
}

impl RunPoint {
    /// Returns the adapter as the run found it.
    pub fn adapter<'a>(&self, history: &'a History) -> &'a AdapterRun {
        &history.adapter_runs()[self.place]
    }
}

impl History {
    /// Returns one case on all adapters, or on those of one timeline; empty if the history has no such
    /// case.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn case_history(
        &self,
        case: &str,
        timeline: Option<&str>,
    ) -> Result<Vec<CaseHistory>, HistoryError> {
        let Some(case) = self.case_id(case)? else {
            return Ok(Vec::new());
        };
        let wrong = HistoryError::database(self.path());
        // Changes by chain, in the order in which they were added.
        let mut changes: HashMap<u32, Vec<(RunId, OutcomeId)>> = HashMap::new();
        let mut statement = self
            .connection()
            .prepare_cached("SELECT chain, run, outcome FROM change WHERE test_case = ?1")
            .map_err(&wrong)?;
        let rows = statement
            .query_map([case.0], |row| {
                Ok((row.get(0)?, (RunId(row.get(1)?), OutcomeId(row.get(2)?))))
            })
            .map_err(&wrong)?;
        for row in rows {
            let (chain, change) = row.map_err(&wrong)?;
            changes.entry(chain).or_default().push(change);
        }

        let mut found: Vec<CaseHistory> = Vec::new();
        let mut places: HashMap<&str, usize> = HashMap::new();
        for (place, part) in self.adapter_runs().iter().enumerate() {
            let Some(changes) = changes.get(&part.chain) else {
                continue;
            };
            let wanted = timeline.is_none_or(|t| *t == *part.timeline);
            if !wanted || !self.has_record(part, case)? {
                continue;
            }
            let before = changes.partition_point(|(run, _)| *run <= part.run);
            let outcome = before.checked_sub(1).map(|index| changes[index].1);
            let Some(outcome) = outcome else {
                let message = format!("run {} has no row of case {case}", part.run);
                return Err(HistoryError::damaged(self.path(), message));
            };
            let index = *places.entry(&part.timeline).or_insert_with(|| {
                found.push(CaseHistory {
                    timeline: Rc::clone(&part.timeline),
                    points: Vec::new(),
                });
                found.len() - 1
            });
            found[index].points.push(RunPoint {
                run: part.run,
                outcome,
                place,
            });
        }
        found.sort_by(|a, b| a.timeline.cmp(&b.timeline));
        Ok(found)
    }
}
