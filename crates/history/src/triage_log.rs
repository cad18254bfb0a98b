//! Reading the triage log.

use crate::error::HistoryError;
use crate::history::History;
use crate::ids::{MachineId, RunId};
use crate::triage::{TimeStep, TriageEntry, TriageState, TriageStates, TriageSubject};
use etalon_record::Time;

impl History {
    /// Returns all entries in the order in which they were made.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn triage_log(&self) -> Result<Vec<TriageEntry>, HistoryError> {
        let wrong = HistoryError::database(self.path());
        let mut statement = self
            .connection()
            .prepare_cached(
                "SELECT at, author, test_case, timeline, state, reason, machine, time, run FROM triage ORDER BY id",
            )
            .map_err(&wrong)?;
        let rows = statement
            .query_map([], |row| {
                let entry = TriageEntry {
                    at: row.get(0)?,
                    author: row.get(1)?,
                    subject: TriageSubject {
                        case: row.get(2)?,
                        timeline: row.get(3)?,
                        step: None,
                    },
                    state: TriageState::New,
                    reason: row.get(5)?,
                };
                let step: (Option<u32>, Option<String>, Option<u32>) =
                    (row.get(6)?, row.get(7)?, row.get(8)?);
                Ok((entry, row.get(4)?, step))
            })
            .map_err(&wrong)?;
        let mut entries = Vec::new();
        for row in rows {
            let (mut entry, state, step): (_, String, _) = row.map_err(&wrong)?;
            let damaged = |what: &str, name: &str| {
                HistoryError::damaged(self.path(), format!("no {what} {name:?} of an entry"))
            };
            entry.state = TriageState::of(&state).ok_or_else(|| damaged("state", &state))?;
            if let (Some(machine), Some(name), Some(run)) = step {
                let time = Time::ALL.into_iter().find(|t| t.name() == name);
                entry.subject.step = Some(TimeStep {
                    machine: MachineId(machine),
                    time: time.ok_or_else(|| damaged("time", &name))?,
                    run: RunId(run),
                });
            }
            entries.push(entry);
        }
        Ok(entries)
    }

    /// Returns the last entry about each subject.
    ///
    /// # Errors
    /// As [`History::triage_log`].
    pub fn triage_states(&self) -> Result<TriageStates, HistoryError> {
        let log = self.triage_log()?.into_iter();
        Ok(log.map(|entry| (entry.subject.clone(), entry)).collect())
    }
}
