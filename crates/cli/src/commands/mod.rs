//! One file per command.

pub(crate) mod adapters;
pub(crate) mod explain;
pub(crate) mod list;
pub(crate) mod mutants;
pub(crate) mod report;
pub(crate) mod run;

use crate::args::CaseArguments;
use crate::failure::Failure;
use etalon_case::{Case, Library};
use std::path::PathBuf;

/// The cases of a folder, or those built in.
pub(crate) fn library(folder: Option<&PathBuf>) -> Result<Library, Failure> {
    match folder {
        Some(folder) => Library::from_folder(folder),
        None => Library::built_in(),
    }
    .map_err(Failure::usage)
}

/// The chosen cases, built: what is wrong with a case file shows before anything is done.
pub(crate) fn chosen(arguments: &CaseArguments) -> Result<Vec<Case>, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let globs = &arguments.globs;
    let selection =
        etalon_runner::select(&library, arguments.profile.into(), globs).map_err(Failure::usage)?;
    if selection.cases.is_empty() {
        return Err(Failure::nothing(if globs.is_empty() {
            "there are no cases".to_owned()
        } else {
            format!(
                "no case matches {}; `etalon list` names them all",
                globs.join(" ")
            )
        }));
    }
    selection
        .cases
        .iter()
        .map(|case| case.build().map_err(Failure::usage))
        .collect()
}
