//! One file per command.

pub(crate) mod adapters;
pub(crate) mod explain;
pub(crate) mod list;
pub(crate) mod mutants;
pub(crate) mod report;
pub(crate) mod run;

use crate::failure::Failure;
use etalon_case::Library;
use std::path::PathBuf;

/// The cases of a folder, or those built in.
pub(crate) fn library(folder: Option<&PathBuf>) -> Result<Library, Failure> {
    match folder {
        Some(folder) => Library::from_folder(folder),
        None => Library::built_in(),
    }
    .map_err(Failure::usage)
}
