//! `etalon history report`.

use crate::failure::Failure;
use crate::history_file::{DatabaseArguments, OnlyArguments, failure};
use crate::output::summarize;
use clap::Args;
use etalon_history::History;
use etalon_report::{ReportError, write_history};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the pages
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Replace the pages in the folder
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) labels: OnlyArguments,
    #[command(flatten)]
    pub(crate) database: DatabaseArguments,
}

/// Writes the pages of a history.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let labels = arguments.labels.labels()?;
    let history = History::open_read(&arguments.database.path()).map_err(failure)?;
    let written = write_history(&history, &labels, &arguments.out, arguments.force);
    let written = written.map_err(|error| match error {
        ReportError::History(error) => failure(error),
        other => Failure::of(other),
    })?;
    summarize(&format!(
        "History: {}, {:.2} MB, with {} files of {:.1} MB in all\n",
        written.html.display(),
        written.start as f64 / 1e6,
        written.files,
        written.bytes as f64 / 1e6
    ));
    Ok(0)
}
