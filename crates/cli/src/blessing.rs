//! `etalon run --bless`: what a run showed is expected from now on.

use crate::cases::ids;
use crate::expectations::{today, write};
use crate::failure::Failure;
use etalon_record::{Expectations, Run};
use std::path::{Path, PathBuf};

/// The file that is blessed where none is named.
const DEFAULT: &str = "ci/expectations.json";

/// The file that `--bless` is to write.
///
/// # Errors
/// In CI, which never writes what it is held against, and where no file is named or found.
pub(crate) fn to_bless(named: Option<&Path>) -> Result<PathBuf, Failure> {
    let ci = std::env::var("CI").unwrap_or_default();
    if !matches!(ci.to_lowercase().as_str(), "" | "0" | "false" | "no") {
        return Err(Failure::usage(
            "--bless writes what runs are held against, which CI never does (the variable CI is set); \
             bless on your own machine and have the change reviewed",
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

/// Writes into the file what a run showed.
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
        eprintln!("each new entry wants its reason written before it is reviewed");
    }
    for entry in &blessing.to_narrow {
        eprintln!(
            "to narrow by hand: some of what it names is better now: {} {} {}",
            entry.adapter, entry.verdict, entry.case
        );
    }
    if blessing.unblessed > 0 {
        eprintln!(
            "{} selftests that do not fail cannot be blessed",
            blessing.unblessed
        );
    }
    Ok(())
}
