//! The file of a history, labels, and what errors of the history mean for a command.

use crate::failure::Failure;
use clap::Args;
use etalon_history::{HistoryError, Labels, parse_labels};
use std::path::PathBuf;

/// The variable that names the file.
const VARIABLE: &str = "ETALON_HISTORY";
/// The file where nothing else is named.
const DEFAULT: &str = "reports/etalon.db";

/// The file of a history.
#[derive(Clone, Debug, Args)]
pub(crate) struct DatabaseArguments {
    /// File of the history. Default: what the variable ETALON_HISTORY names, else reports/etalon.db
    #[arg(long = "db", value_name = "FILE")]
    file: Option<PathBuf>,
}

impl DatabaseArguments {
    /// The file.
    pub(crate) fn path(&self) -> PathBuf {
        let named = || std::env::var_os(VARIABLE).filter(|name| !name.is_empty());
        let file = self.file.clone().or_else(|| named().map(PathBuf::from));
        file.unwrap_or_else(|| PathBuf::from(DEFAULT))
    }
}

/// Labels, which are read as they are written: `key=value`.
#[derive(Clone, Debug, Args)]
pub(crate) struct LabelArguments {
    /// Label of the run, such as branch=main; may be repeated
    #[arg(long = "label", value_name = "KEY=VALUE")]
    texts: Vec<String>,
}

impl LabelArguments {
    /// The labels.
    ///
    /// # Errors
    /// When a text is no label.
    pub(crate) fn labels(&self) -> Result<Labels, Failure> {
        parse_labels(&self.texts).map_err(Failure::usage)
    }

    /// The labels as they were given, `key=value`.
    pub(crate) fn given(&self) -> &[String] {
        &self.texts
    }

    /// The words that give the same labels again.
    pub(crate) fn words(&self) -> impl Iterator<Item = &str> {
        let each = self.texts.iter();
        each.flat_map(|text| ["--label", text.as_str()])
    }
}

/// Labels by which runs are chosen.
#[derive(Clone, Debug, Args)]
pub(crate) struct OnlyArguments {
    /// Look at runs with this label alone, such as branch=main; may be repeated
    #[arg(long = "label", value_name = "KEY=VALUE")]
    texts: Vec<String>,
}

impl OnlyArguments {
    /// The labels.
    ///
    /// # Errors
    /// When a text is no label.
    pub(crate) fn labels(&self) -> Result<Labels, Failure> {
        parse_labels(&self.texts).map_err(Failure::usage)
    }
}

/// The failure for an error of the history: what may go well another time is incomplete, the rest is bad input.
pub(crate) fn failure(error: HistoryError) -> Failure {
    match error {
        HistoryError::Busy { .. } | HistoryError::Full { .. } | HistoryError::Database { .. } => {
            Failure::incomplete(error)
        }
        _ => Failure::usage(error),
    }
}
