//! `etalon history`: runs over time.

mod add;
#[cfg(feature = "export")]
mod export;
mod open;
mod place;
mod report;
mod series;
mod show;
mod sparkline;
mod triage;
mod verdicts;

use crate::failure::Failure;
use clap::Subcommand;

/// Runs over time, in one file.
#[derive(Debug, Subcommand)]
pub(crate) enum HistoryCommand {
    /// Add runs, benches and the releases of `etalon bisect`; runs that are already there are not added again
    Add(add::Arguments),
    /// Write the history for other programs: tables, samples, series of frame times
    #[cfg(feature = "export")]
    Export(export::Arguments),
    /// Write the pages of a history: what changed, scores over time, every case, frame times
    Report(report::Arguments),
    /// Show one case over all runs: when it broke, was fixed or became flaky, and when its frame times
    /// changed
    Show(show::Arguments),
    /// List open cases and changes, or set the state of a case or of a change of its times
    Triage(triage::Arguments),
}

/// Runs a command of the history.
pub(crate) fn run(command: &HistoryCommand) -> Result<u8, Failure> {
    match command {
        HistoryCommand::Add(arguments) => add::run(arguments),
        #[cfg(feature = "export")]
        HistoryCommand::Export(arguments) => export::run(arguments),
        HistoryCommand::Report(arguments) => report::run(arguments),
        HistoryCommand::Show(arguments) => show::run(arguments),
        HistoryCommand::Triage(arguments) => triage::run(arguments),
    }
}
