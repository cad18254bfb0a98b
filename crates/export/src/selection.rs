//! The choice of runs to export.

use etalon_history::{History, RunId};
use std::collections::HashSet;

/// The choice of runs to export. Runs that were resumed later are always left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunChoice {
    /// Leaves out runs before this time, in seconds since 1970.
    pub since: Option<i64>,
    /// Takes this many of the latest runs.
    pub last: Option<usize>,
}

impl RunChoice {
    /// Returns the selected runs.
    pub(crate) fn runs(&self, history: &History) -> HashSet<RunId> {
        let late = |time: i64| self.since.is_none_or(|since| time >= since);
        history
            .runs()
            .iter()
            .rev()
            .filter(|run| run.resumed.is_none() && late(run.time()))
            .take(self.last.unwrap_or(usize::MAX))
            .map(|run| run.id)
            .collect()
    }
}
