//! `etalon history export`: a history as files for other programs.

use crate::counted::counted;
use crate::failure::Failure;
use crate::history_file::{self, DatabaseArguments};
use crate::output::say;
use clap::{Args, ValueEnum};
use etalon_export::{ExportError, ExportFormat, RunChoice};
use etalon_history::{History, parse_time};
use std::path::PathBuf;

#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    /// Tables partitioned by date and adapter, for DuckDB, ClickHouse and others
    Parquet,
    /// Counts of verdicts and medians of frame times, for Prometheus
    Openmetrics,
    /// The latest times in Bencher's metric format
    Bencher,
    /// The latest times for github-action-benchmark
    GithubActionBenchmark,
}

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Format of the files
    #[arg(long, value_enum)]
    format: FormatName,
    #[command(flatten)]
    database: DatabaseArguments,
    /// Ignore runs before this day or time, such as 2026-01-31
    #[arg(long, value_name = "DATE")]
    since: Option<String>,
    /// Use only this many of the latest runs
    #[arg(long, value_name = "N")]
    runs: Option<usize>,
    /// Folder for the files, new or empty
    #[arg(value_name = "DIR")]
    dir: PathBuf,
}

/// Exports a history.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let since = match &arguments.since {
        None => None,
        Some(text) => Some(parse_time(text).ok_or_else(|| {
            Failure::usage(format!("--since {text:?} is no date; write 2026-01-31"))
        })?),
    };
    let format = match arguments.format {
        FormatName::Parquet => ExportFormat::Parquet,
        FormatName::Openmetrics => ExportFormat::OpenMetrics,
        FormatName::Bencher => ExportFormat::Bencher,
        FormatName::GithubActionBenchmark => ExportFormat::ActionBenchmark,
    };
    let selection = RunChoice {
        since,
        last: arguments.runs,
    };
    let history = History::open_read(&arguments.database.path()).map_err(history_file::failure)?;
    let written =
        etalon_export::export(&history, format, &selection, &arguments.dir).map_err(failure)?;
    let rows = counted(written.rows, "row");
    let files = counted(written.files, "file");
    say!("etalon: {rows} in {files} in {}", arguments.dir.display());
    Ok(0)
}

fn failure(error: ExportError) -> Failure {
    match error {
        ExportError::History(error) => history_file::failure(error),
        ExportError::NoRuns { .. } | ExportError::NoTimes { .. } => Failure::nothing(error),
        ExportError::NotEmpty { .. } | ExportError::Folder(_) | ExportError::Io { .. } => {
            Failure::of(error)
        }
        ExportError::Json { .. } | ExportError::Table { .. } => Failure::incomplete(error),
    }
}
