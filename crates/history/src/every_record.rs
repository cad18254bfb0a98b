//! All records of a history, for exports.

use crate::error::HistoryError;
use crate::history::History;
use crate::ids::{CaseNumber, OutcomeId};
use crate::runs::{AdapterRun, RunInfo};

impl History {
    /// Calls `each` with every record, sorted by the times of runs, then by timeline, then by the numbers
    /// of cases. Skips runs that were resumed later. Stops at the first error.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged, or the error that `each` returns.
    pub fn each_record<E: From<HistoryError>>(
        &self,
        mut each: impl FnMut(&RunInfo, &AdapterRun, CaseNumber, OutcomeId) -> Result<(), E>,
    ) -> Result<(), E> {
        for run in self.runs().iter().filter(|run| run.resumed.is_none()) {
            for adapter in self.adapters(run.id) {
                for (case, outcome) in self.records(adapter)? {
                    each(run, adapter, case, outcome)?;
                }
            }
        }
        Ok(())
    }
}
