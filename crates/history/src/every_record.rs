//! All records of a history, for exports.

use crate::error::HistoryError;
use crate::history::History;
use crate::ids::{CaseId, OutcomeId};
use crate::runs::{AdapterRun, RunInfo};

impl History {
    /// Calls `each` with every record: by the times of runs, then by timeline, then by the numbers of cases. Runs that
    /// were resumed later are left out. It ends with the first error.
    ///
    /// # Errors
    /// When the file cannot be read or is damaged, or what `each` returns.
    pub fn each_record<E: From<HistoryError>>(
        &self,
        mut each: impl FnMut(&RunInfo, &AdapterRun, CaseId, OutcomeId) -> Result<(), E>,
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
