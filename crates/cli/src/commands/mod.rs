//! One file per command.

pub(crate) mod adapters;
pub(crate) mod bench;
pub(crate) mod diff;
pub(crate) mod expectations;
pub(crate) mod explain;
pub(crate) mod list;
pub(crate) mod merge;
pub(crate) mod mutants;
pub(crate) mod report;
pub(crate) mod run;

use crate::args::CaseArguments;
use crate::failure::Failure;
use etalon_case::{Case, Library, Profile};
use etalon_record::AbsentAdapter;
use std::path::PathBuf;

/// Areas that take part in runs and hunts only where they are named: they measure what the other areas
/// have proven, on pictures so large that one of them takes as long as hundreds of cases.
const MEASURING: [&str; 2] = ["methods", "perf"];

/// Whether a case is there to be measured.
pub(crate) fn is_measuring(case: &Case) -> bool {
    MEASURING.contains(&case.area())
}

/// The cases of a folder, or those built in.
pub(crate) fn library(folder: Option<&PathBuf>) -> Result<Library, Failure> {
    match folder {
        Some(folder) => Library::from_folder(folder),
        None => Library::built_in(),
    }
    .map_err(Failure::usage)
}

/// Refuses to go on without an adapter that was named; of others that are absent it tells.
pub(crate) fn refuse_absent(named: &[String], absent: &[AbsentAdapter]) -> Result<(), Failure> {
    if !named.is_empty()
        && let Some(absent) = absent.first()
    {
        return Err(Failure::usage(format!(
            "adapter {} cannot be used: {}; {}",
            absent.name, absent.reason, absent.remedy
        )));
    }
    for absent in absent {
        eprintln!(
            "not here: {}: {}; {}",
            absent.name, absent.reason, absent.remedy
        );
    }
    Ok(())
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
