//! `--label`: what people or jobs say about a run.

use crate::failure::Failure;
use clap::Args;
use etalon_record::{Labels, parse_labels};

/// Labels of a run, each `key=value`.
#[derive(Clone, Debug, Args)]
pub(crate) struct LabelArguments {
    /// Label of the run, such as branch=main; may be repeated
    #[arg(long = "label", value_name = "KEY=VALUE")]
    texts: Vec<String>,
}

impl LabelArguments {
    /// Returns the labels.
    ///
    /// # Errors
    /// If a text is not a label.
    pub(crate) fn labels(&self) -> Result<Labels, Failure> {
        parse_labels(&self.texts).map_err(Failure::usage)
    }

    /// Returns the labels as given, `key=value`.
    pub(crate) fn given(&self) -> &[String] {
        &self.texts
    }

    /// Returns the command-line words that give the same labels.
    pub(crate) fn words(&self) -> impl Iterator<Item = &str> {
        let each = self.texts.iter();
        each.flat_map(|text| ["--label", text.as_str()])
    }
}
