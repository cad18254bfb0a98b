//! The dead expectations of a run.

use crate::cases::ids_of;
use crate::failure::Failure;
use crate::output::say;
use etalon_adapters::{described_names, hardware_names};
use etalon_case::Library;
use etalon_findings::is_built_in;
use etalon_record::beside::WORKER_END;
use etalon_record::{Dead, DeadKind, DeadSearch, Expectations, Known, Run};
use std::path::Path;

/// Returns the dead expectations of a run of a library's cases. With the cases of a folder, built-in findings
/// are never dead, since they are about the built-in cases.
///
/// # Errors
/// If the file of adapters cannot be read.
pub(crate) fn of_run(
    run: &Run,
    expectations: &Expectations,
    library: &Library,
    of_folder: bool,
    adapter_file: Option<&Path>,
) -> Result<Vec<Dead>, Failure> {
    if expectations.all().is_empty() {
        return Ok(Vec::new());
    }
    // `each_glob_of_a_finding_names_a_case_and_an_adapter` ensures that built-in globs match something.
    let sound = |known: &Known| is_built_in(&known.place());
    let names = names(adapter_file)?;
    let ids = || {
        let mut ids = ids_of(library);
        ids.push(WORKER_END.to_owned());
        ids
    };
    let DeadSearch {
        mut dead,
        is_complete,
    } = expectations.dead(run, ids, &names, sound);
    if !is_complete {
        say!("there are too many globs to compare all: other expectations can be dead too");
    }
    // A finding that the user's own list covers is not dead.
    dead.retain(|entry| {
        let covered = entry.kind == DeadKind::Covered && !is_built_in(&entry.about);
        !is_built_in(&entry.place) || !of_folder && !covered
    });
    Ok(dead)
}

/// Returns the names of all adapters that are described.
fn names(adapter_file: Option<&Path>) -> Result<Vec<String>, Failure> {
    let mut names = described_names(adapter_file).map_err(Failure::usage)?;
    names.extend(hardware_names());
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::library;
    use crate::expectations::findings;
    use etalon_record::Header;

    #[test]
    fn each_glob_of_a_finding_names_a_case_and_an_adapter() {
        let run = Run {
            header: Header::new(Vec::new(), 0),
            records: Vec::new(),
            beside: Vec::new(),
            truncated: false,
        };
        let library = library(None).expect("the built-in cases");
        let names = names(None).expect("the built-in adapters");
        let findings = findings().expect("the findings");
        let dead = findings.dead(&run, || ids_of(&library), &names, |_| false);
        assert_eq!(dead.dead, []);
    }
}
