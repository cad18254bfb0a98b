//! `etalon history`: runs over time.

mod report;

use crate::failure::Failure;
use clap::Subcommand;

/// Runs over time, in one file.
#[derive(Debug, Subcommand)]
pub(crate) enum HistoryCommand {
    /// Write the pages of a history: what changed, scores over time, every case, frame times
    Report(report::Arguments),
}

/// Runs a command of the history.
pub(crate) fn run(command: &HistoryCommand) -> Result<u8, Failure> {
    match command {
        HistoryCommand::Report(arguments) => report::run(arguments),
    }
}
