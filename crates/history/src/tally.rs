//! Counts of a run's records.

use crate::error::HistoryError;
use crate::history::History;
use crate::rows::verdict;
use crate::runs::AdapterRun;
use etalon_record::Verdict;

/// The number of records of an adapter in a run that share an area and a verdict.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tally {
    /// The area: the first part of the cases' ids.
    pub area: String,
    /// The verdict.
    pub verdict: Verdict,
    /// True if they count against the run.
    pub unexpected: bool,
    /// The number of records, above zero.
    pub records: u32,
}

impl History {
    /// Returns the number of records of an adapter in a run, by area and verdict. They were counted when
    /// the run was added.
    ///
    /// # Errors
    /// If the file cannot be read or is damaged.
    pub fn tallies(&self, adapter: &AdapterRun) -> Result<Vec<Tally>, HistoryError> {
        let wrong = HistoryError::database(self.path());
        let mut statement = self
            .connection()
            .prepare_cached(
                "SELECT area, verdict, unexpected, records FROM tally WHERE state = ?1 ORDER BY area, verdict, unexpected",
            )
            .map_err(&wrong)?;
        let rows = statement
            .query_map([adapter.state], |row| {
                Ok((row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?))
            })
            .map_err(&wrong)?;
        let mut tallies = Vec::new();
        for row in rows {
            let (area, name, unexpected, records): (_, String, _, _) = row.map_err(&wrong)?;
            tallies.push(Tally {
                area,
                verdict: verdict(self.path(), &name)?,
                unexpected,
                records,
            });
        }
        Ok(tallies)
    }
}
