//! The formats of exports.

use crate::error::ExportError;
use crate::selection::RunChoice;
use crate::written::ExportSize;
use crate::{folder, latest, openmetrics, tables};
use etalon_history::History;
use std::path::Path;

/// A format of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// Parquet tables, partitioned by date and adapter.
    Parquet,
    /// Samples for Prometheus.
    OpenMetrics,
    /// The latest times of each series in Bencher's format.
    Bencher,
    /// The latest times of each series for github-action-benchmark.
    ActionBenchmark,
}

/// Writes the selected runs of a history to a folder. The folder is created; if it exists, it must be empty.
///
/// # Errors
/// If the history cannot be read, no run is selected, or the folder is not empty or cannot be written to.
pub fn export(
    history: &History,
    format: ExportFormat,
    selection: &RunChoice,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let runs = selection.runs(history);
    if runs.is_empty() {
        return Err(ExportError::NoRuns {
            path: history.path().to_owned(),
        });
    }
    folder::empty(dir)?;
    match format {
        ExportFormat::Parquet => tables::write(history, &runs, dir),
        ExportFormat::OpenMetrics => openmetrics::write(history, &runs, dir),
        ExportFormat::Bencher => latest::write_bencher(history, &runs, dir),
        ExportFormat::ActionBenchmark => latest::write_action(history, &runs, dir),
    }
}
