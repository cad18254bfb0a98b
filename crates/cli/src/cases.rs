//! Selects and builds the cases of a command.

use crate::check::check;
use crate::failure::Failure;
use crate::flags::CaseArguments;
use crate::output::say;
use crate::processors::processors;
use etalon_case::{Case, CaseError, CaseFile, CaseRef, Library, Profile};
use etalon_frame::threads::each;
use etalon_glob::did_you_mean;
use std::collections::{BTreeSet, HashSet};
use std::path::PathBuf;

/// Returns the selected cases, built, so that errors in case files are reported before anything is drawn.
/// Prints the warnings for the user's own files.
pub(crate) fn chosen(arguments: &CaseArguments) -> Result<Vec<Case>, Failure> {
    let library = library_of(arguments)?;
    let cases = build(&library, arguments.profile.into(), &arguments.globs)?;
    let cases = some(cases, arguments)?;
    if arguments.cases.is_some() {
        warn(&library, &cases);
    }
    Ok(cases)
}

/// The largest number of cases, and of their draws, that are judged for warnings before drawing.
const JUDGED: usize = 64;
const JUDGED_DRAWS: usize = 4096;

/// Prints the warnings of `etalon check` for the files of these cases: all warnings if the cases are few,
/// otherwise only warnings that need no judge.
fn warn(library: &Library, cases: &[Case]) {
    let ids: HashSet<&str> = cases.iter().map(|case| case.id.as_str()).collect();
    let files = library.files();
    let of_these = |file: &&CaseFile| {
        file.cases(Profile::Full)
            .any(|c| ids.contains(c.id().as_str()))
    };
    let files: Vec<CaseFile> = files.filter(of_these).cloned().collect();
    let few = files
        .iter()
        .map(|file| file.cases(Profile::Quick).count())
        .sum::<usize>()
        <= JUDGED;
    let passes = cases.iter().flat_map(|case| &case.scene.passes);
    let draws: usize = passes.map(|pass| pass.draws.len()).sum();
    let few = few && draws <= JUDGED_DRAWS;
    let warnings: Vec<CaseError> = if few {
        check(&files, Profile::Quick)
            .into_iter()
            .flat_map(|f| f.warnings)
            .collect()
    } else {
        files.iter().flat_map(CaseFile::warnings).collect()
    };
    for warning in &warnings {
        say!("warning: {warning}");
    }
    if !few && !warnings.is_empty() {
        say!("`etalon check` gives further warnings on these files");
    }
}

/// Returns the ids of the selected cases, each with true if the case is measured rather than judged. Cases of
/// a folder are still built, so that errors are reported.
pub(crate) fn chosen_ids(arguments: &CaseArguments) -> Result<Vec<(String, bool)>, Failure> {
    if arguments.cases.is_some() {
        let cases = chosen(arguments)?.into_iter();
        return Ok(cases.map(|case| (case.id, case.measured)).collect());
    }
    let library = library_of(arguments)?;
    let selection = etalon_case::select(&library, arguments.profile.into(), &arguments.globs);
    let selection = selection.map_err(Failure::usage)?;
    let cases = selection.cases.iter();
    let ids = cases.map(|c| (c.id(), c.is_measured())).collect();
    some(ids, arguments)
}

/// Returns the number of matching cases that the full profile has and the chosen profile leaves out. Areas
/// without a selected case are not counted.
pub(crate) fn left_out(arguments: &CaseArguments, selected: &[String]) -> Result<u64, Failure> {
    let library = library_of(arguments)?;
    let profile = arguments.profile.into();
    etalon_case::left_out(&library, profile, &arguments.globs, selected).map_err(Failure::usage)
}

/// Removes the cases that are measured rather than judged, unless globs are given or there are no other
/// cases: one such picture takes as long as hundreds of cases. Returns the number of removed cases.
pub(crate) fn leave_measured<T>(
    cases: &mut Vec<T>,
    arguments: &CaseArguments,
    is_measured: impl Fn(&T) -> bool,
) -> usize {
    if !arguments.globs.is_empty() || cases.iter().all(&is_measured) {
        return 0;
    }
    let count = cases.len();
    cases.retain(|case| !is_measured(case));
    count - cases.len()
}

/// Returns the selection, or an error if it is empty.
fn some<T>(selected: Vec<T>, arguments: &CaseArguments) -> Result<Vec<T>, Failure> {
    let globs = &arguments.globs;
    if !selected.is_empty() {
        return Ok(selected);
    }
    if globs.is_empty() {
        return Err(Failure::nothing("there are no cases"));
    }
    let library = library_of(arguments)?;
    let full = etalon_case::select(&library, Profile::Full, globs).map_err(Failure::usage)?;
    let shown = |glob: &String| match glob.as_str() {
        "" => "''".to_owned(),
        glob => glob.to_owned(),
    };
    let globs_shown = globs.iter().map(shown).collect::<Vec<_>>().join(" ");
    Err(Failure::nothing(match full.cases.len() {
        0 => match &arguments.gltf {
            Some(_) => {
                let files: Vec<&str> = library.stems().collect();
                format!(
                    "no case matches {globs_shown}; the scene gives {}",
                    files.join(", ")
                )
            }
            None => format!(
                "no case matches {globs_shown}{}; `etalon list` lists all",
                proposed(globs)
            ),
        },
        matching => format!(
            "no case of the quick profile matches {globs_shown}, of the full one {matching}: add --profile full"
        ),
    }))
}

/// Returns suggestions for the globs: areas, case files or cases with similar names.
fn proposed(globs: &[String]) -> String {
    let Ok(library) = library(None) else {
        return String::new();
    };
    let mut known: BTreeSet<String> = BTreeSet::new();
    for stem in library.stems() {
        known.insert(stem.to_owned());
        known.extend(stem.split('/').next().map(str::to_owned));
    }
    let each = globs.iter().map(|glob| {
        let word = glob.trim_end_matches(['*', '/']);
        if word.contains('=') {
            nearest_cases(&library, word)
        } else {
            did_you_mean(word, known.iter().map(String::as_str))
        }
    });
    each.collect()
}

/// Returns the case with this id.
pub(crate) fn find<'l>(library: &'l Library, id: &str) -> Result<CaseRef<'l>, Failure> {
    let found = library.cases_that_begin(id).find(|case| case.id() == id);
    found.ok_or_else(|| {
        Failure::usage(format!(
            "there is no case `{id}`{}; `etalon list --profile full` lists all cases",
            nearest_cases(library, id)
        ))
    })
}

/// Returns a suggestion of the cases whose ids are most similar to a text.
pub(crate) fn nearest_cases(library: &Library, word: &str) -> String {
    did_you_mean(word, ids_of(library).iter().map(String::as_str))
}

/// Returns the cases that a command selects from: those of a folder or of a scene, or the built-in ones.
pub(crate) fn library_of(arguments: &CaseArguments) -> Result<Library, Failure> {
    match &arguments.gltf {
        Some(scene) => Ok(scene.library.clone()),
        None => library(arguments.cases.as_ref()),
    }
}

/// Returns the cases of a folder, or the built-in ones.
pub(crate) fn library(folder: Option<&PathBuf>) -> Result<Library, Failure> {
    match folder {
        Some(folder) => Library::from_folder(folder).map_err(Failure::usage),
        None => Ok(Library::built_in().clone()),
    }
}

/// Builds the cases of a library whose ids match.
pub(crate) fn build(
    library: &Library,
    profile: Profile,
    globs: &[String],
) -> Result<Vec<Case>, Failure> {
    let selection = etalon_case::select(library, profile, globs).map_err(Failure::usage)?;
    build_each(&selection.cases)
}

/// Builds the cases of a library with these ids.
pub(crate) fn build_named(library: &Library, ids: &BTreeSet<&str>) -> Result<Vec<Case>, Failure> {
    let named: Vec<CaseRef<'_>> = library.named(ids).map(|(_, case)| case).collect();
    build_each(&named)
}

/// Builds cases on all cores; for a full run one core takes a second.
fn build_each(cases: &[CaseRef<'_>]) -> Result<Vec<Case>, Failure> {
    let share = cases.len().div_ceil(processors()).max(1);
    let parts: Vec<&[CaseRef<'_>]> = cases.chunks(share).collect();
    let parts: Vec<Result<Vec<Case>, CaseError>> = each(parts.len(), &parts, |cases| {
        cases.iter().map(CaseRef::build).collect()
    });
    let mut cases = Vec::new();
    for part in parts {
        cases.extend(part.map_err(Failure::usage)?);
    }
    Ok(cases)
}

/// Returns the round-trip cases that these cases depend on: those of the folder, and built-in ones if the
/// folder lacks them.
pub(crate) fn round_trips(folder: Option<&PathBuf>, cases: &[Case]) -> Result<Vec<Case>, Failure> {
    let given = folder.map(|_| library(folder)).transpose()?;
    let built_in = library(None)?;
    let libraries: Vec<&Library> = given.iter().chain([&built_in]).collect();
    etalon_judge::round_trips(&libraries, cases).map_err(Failure::usage)
}

/// Returns the ids of all cases. Cases of a folder are also built, so that errors are reported.
pub(crate) fn ids(cases: Option<&PathBuf>) -> Result<Vec<String>, Failure> {
    let library = library(cases)?;
    if cases.is_some() {
        build(&library, Profile::Full, &[])?;
    }
    Ok(ids_of(&library))
}

/// Returns the ids of a library's cases, without building them.
pub(crate) fn ids_of(library: &Library) -> Vec<String> {
    library.cases(Profile::Full).map(|case| case.id()).collect()
}
