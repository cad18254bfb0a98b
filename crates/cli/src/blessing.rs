//! `etalon run --bless`: the expectations file follows the verdicts of a run.

use crate::cases::ids;
use crate::expectations::{today, write};
use crate::failure::Failure;
use etalon_record::{Expectations, Run};
use std::path::{Path, PathBuf};

/// The file that is updated by default.
const DEFAULT: &str = "ci/expectations.json";

/// Returns the file that `--bless` writes.
///
/// # Errors
/// In CI, where expectations are never written, and if no file is named or found.
pub(crate) fn to_bless(named: Option<&Path>) -> Result<PathBuf, Failure> {
    let ci = std::env::var("CI").unwrap_or_default();
    if !matches!(ci.to_lowercase().as_str(), "" | "0" | "false" | "no") {
        return Err(Failure::usage(
            "--bless writes expectations, which CI never does (the variable CI is set); bless on your \
             own machine and have the change reviewed",
        ));
    }
    match named {
        Some(path) => Ok(path.to_owned()),
        None if Path::new(DEFAULT).is_file() => Ok(PathBuf::from(DEFAULT)),
        None => Err(Failure::usage(format!(
            "there is no {DEFAULT} here; name the file to write with --expect"
        ))),
    }
}

/// Updates the file from the verdicts of a run.
pub(crate) fn bless(
    path: &Path,
    run: &Run,
    expected: &Expectations,
    cases: Option<&PathBuf>,
    all_adapters: bool,
) -> Result<(), Failure> {
    let ids = ids(cases)?;
    let blessing = expected.bless(run, &ids, all_adapters, &today());
    write(path, &blessing.entries)?;
    eprintln!(
        "{}: {} entries added, {} removed",
        path.display(),
        blessing.added,
        blessing.removed.len()
    );
    if blessing.added > 0 {
        eprintln!("write the reason of each new entry before it is reviewed");
    }
    for entry in &blessing.to_narrow {
        eprintln!(
            "narrow by hand, since some of its cases improved: {} {} {}",
            entry.adapter, entry.verdict, entry.case
        );
    }
    if blessing.unblessed > 0 {
        eprintln!(
            "{} selftests that do not fail cannot be expected",
            blessing.unblessed
        );
    }
    Ok(())
}
