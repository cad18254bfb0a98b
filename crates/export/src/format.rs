//! The formats of exports.

use crate::error::ExportError;
use crate::selection::Selection;
use crate::written::ExportSize;
use crate::{folder, latest, openmetrics, otava, tables};
use etalon_history::History;
use std::path::Path;

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Tables in Parquet, partitioned by date and adapter.
    Parquet,
    /// Samples for Prometheus.
    OpenMetrics,
    /// One CSV file per series of frame times, and the configuration for Apache Otava.
    Otava,
    /// The latest times of each series in Bencher's format.
    Bencher,
    /// The latest times of each series for github-action-benchmark.
    ActionBenchmark,
}

/// Writes the selected runs of a history into a folder, which is created. It must be empty.
///
/// # Errors
/// When the history cannot be read or no run is selected, or the folder holds something or cannot be written to.
pub fn export(
    history: &History,
    format: Format,
    selection: &Selection,
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
        Format::Parquet => tables::write(history, &runs, dir),
        Format::OpenMetrics => openmetrics::write(history, &runs, dir),
        Format::Otava => otava::write(history, &runs, dir),
        Format::Bencher => latest::write_bencher(history, &runs, dir),
        Format::ActionBenchmark => latest::write_action(history, &runs, dir),
    }
}
