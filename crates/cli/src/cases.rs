//! The cases that a command is about.

use crate::failure::Failure;
use crate::flags::CaseArguments;
use etalon_case::{Case, Library, Profile};
use std::path::PathBuf;

/// Areas that take part in runs and hunts only where they are named: they measure what the other areas
/// have proven, on pictures so large that one of them takes as long as hundreds of cases.
const MEASURING: [&str; 2] = ["methods", "perf"];

/// Whether a case is there to be measured.
pub(crate) fn is_measuring(case: &Case) -> bool {
    MEASURING.contains(&case.area())
}

/// The chosen cases, built: what is wrong with a case file shows before anything is done.
pub(crate) fn chosen(arguments: &CaseArguments) -> Result<Vec<Case>, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let globs = &arguments.globs;
    let cases = build(&library, arguments.profile.into(), globs)?;
    if cases.is_empty() {
        return Err(Failure::nothing(if globs.is_empty() {
            "there are no cases".to_owned()
        } else {
            format!(
                "no case matches {}; `etalon list` names them all",
                globs.join(" ")
            )
        }));
    }
    Ok(cases)
}

/// The cases of a folder, or those built in.
pub(crate) fn library(folder: Option<&PathBuf>) -> Result<Library, Failure> {
    match folder {
        Some(folder) => Library::from_folder(folder),
        None => Library::built_in(),
    }
    .map_err(Failure::usage)
}

/// The cases of a library whose ids match, built.
pub(crate) fn build(
    library: &Library,
    profile: Profile,
    globs: &[String],
) -> Result<Vec<Case>, Failure> {
    let selection = etalon_runner::select(library, profile, globs).map_err(Failure::usage)?;
    let cases = selection.cases.iter();
    cases
        .map(|case| case.build().map_err(Failure::usage))
        .collect()
}

/// The ids of all cases there are.
pub(crate) fn ids(cases: Option<&PathBuf>) -> Result<Vec<String>, Failure> {
    let library = library(cases)?;
    let all = build(&library, Profile::Full, &[])?;
    Ok(all.into_iter().map(|case| case.id).collect())
}
