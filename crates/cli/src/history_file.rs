//! The history's file, the labels that select its runs, and the exit codes for errors of the history.

use crate::failure::Failure;
use clap::Args;
use etalon_history::HistoryError;
use etalon_record::{Labels, parse_labels};
use std::path::PathBuf;

/// The variable that names the file.
const VARIABLE: &str = "ETALON_HISTORY";
/// The default file.
const DEFAULT: &str = "reports/etalon.db";

/// The flag for the file of a history.
#[derive(Clone, Debug, Args)]
pub(crate) struct DatabaseArguments {
    /// File of the history. Default: the file that the variable ETALON_HISTORY names, otherwise
    /// reports/etalon.db
    #[arg(long = "db", value_name = "FILE")]
    file: Option<PathBuf>,
}

impl DatabaseArguments {
    /// Returns the path of the history file.
    pub(crate) fn path(&self) -> PathBuf {
        let named = || std::env::var_os(VARIABLE).filter(|name| !name.is_empty());
        let file = self.file.clone().or_else(|| named().map(PathBuf::from));
        file.unwrap_or_else(|| PathBuf::from(DEFAULT))
    }
}

/// Labels that select runs.
#[derive(Clone, Debug, Args)]
pub(crate) struct OnlyArguments {
    /// Use only runs with this label, such as branch=main; may be repeated
    #[arg(long = "label", value_name = "KEY=VALUE")]
    texts: Vec<String>,
}

impl OnlyArguments {
    /// Returns the labels.
    ///
    /// # Errors
    /// If a text is not a label.
    pub(crate) fn labels(&self) -> Result<Labels, Failure> {
        parse_labels(&self.texts).map_err(Failure::usage)
    }
}

/// Converts an error of the history: errors that can disappear on a retry become "incomplete", the rest "bad
/// input".
pub(crate) fn failure(error: HistoryError) -> Failure {
    match error {
        HistoryError::Busy { .. } | HistoryError::Full { .. } | HistoryError::Database { .. } => {
            Failure::incomplete(error)
        }
        _ => Failure::of(error),
    }
}
