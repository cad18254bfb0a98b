//! Rows of the database as values, with an error for invalid rows.

use crate::adapter::Adapter;
use crate::error::HistoryError;
use crate::outcome::Outcome;
use etalon_frame::AdapterInfo;
use etalon_record::Verdict;
use rusqlite::Row;
use std::path::Path;

/// Returns the verdict with this name.
pub(crate) fn verdict(path: &Path, name: &str) -> Result<Verdict, HistoryError> {
    Verdict::ALL
        .into_iter()
        .find(|v| v.name() == name)
        .ok_or_else(|| HistoryError::damaged(path, format!("no verdict {name:?}")))
}

/// Returns the adapter in the columns `name, backend, device, driver, driver_version, driver_id,
/// api_version, software, line, version`, starting at column `from`.
pub(crate) fn adapter(row: &Row<'_>, from: usize) -> rusqlite::Result<Adapter> {
    Ok(Adapter {
        info: AdapterInfo {
            name: row.get(from)?,
            backend: row.get(from + 1)?,
            device: row.get(from + 2)?,
            driver: row.get(from + 3)?,
            driver_version: row.get(from + 4)?,
            driver_id: row.get(from + 5)?,
            api_version: row.get(from + 6)?,
            software: row.get(from + 7)?,
            offer: None,
        },
        line: row.get(from + 8)?,
        version: row.get(from + 9)?,
    })
}

/// The columns of an outcome.
pub(crate) struct OutcomeRow {
    verdict: String,
    expected: Option<String>,
    improves: Option<String>,
    due_fail: bool,
    inferred: bool,
    measures: String,
}

impl OutcomeRow {
    pub(crate) fn new(row: &Row<'_>) -> rusqlite::Result<Self> {
        Ok(Self {
            verdict: row.get(0)?,
            expected: row.get(1)?,
            improves: row.get(2)?,
            due_fail: row.get(3)?,
            inferred: row.get(4)?,
            measures: row.get(5)?,
        })
    }

    pub(crate) fn outcome(self, path: &Path) -> Result<Outcome, HistoryError> {
        Ok(Outcome {
            verdict: verdict(path, &self.verdict)?,
            expected: self.expected,
            improves: match self.improves {
                Some(name) => Some(verdict(path, &name)?),
                None => None,
            },
            due_fail: self.due_fail,
            inferred: self.inferred,
            measures: serde_json::from_str(&self.measures)
                .map_err(|e| HistoryError::damaged(path, format!("measures: {e}")))?,
        })
    }
}
