//! `etalon run --bless`: updates a list of expectations or a folder of findings from the verdicts of a run.

use crate::cases::ids;
use crate::expectations::{today, write};
use crate::failure::Failure;
use crate::named_files::{check_file, replace};
use crate::output::say;
use etalon_diagnose::Blessing;
use etalon_record::{Expectations, KnownSource, Run};
use etalon_report::message;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder that is updated by default.
const DEFAULT: &str = "ci/findings";

/// Returns the list or folder that `--bless` writes.
///
/// # Errors
/// In CI, where expectations are never written, or if no path is named or found.
pub(crate) fn to_bless(named: &[PathBuf]) -> Result<PathBuf, Failure> {
    let ci = std::env::var("CI").unwrap_or_default();
    if !matches!(ci.to_lowercase().as_str(), "" | "0" | "false" | "no") {
        return Err(Failure::usage(
            "--bless writes expectations, which CI never does (the variable CI is set); bless on your \
             own machine and have the change reviewed",
        ));
    }
    match named {
        [path] => {
            if !path.is_dir() {
                check_file(path)?;
            }
            Ok(path.clone())
        }
        [_, ..] => Err(Failure::usage(
            "--bless writes one list or folder; name it with one --expect",
        )),
        [] if Path::new(DEFAULT).is_dir() => Ok(PathBuf::from(DEFAULT)),
        [] => Err(Failure::usage(format!(
            "there is no {DEFAULT} here; name the list or folder to write with --expect"
        ))),
    }
}

/// Updates the list or folder from the verdicts of a run.
pub(crate) fn bless(
    path: &Path,
    run: &Run,
    expected: &Expectations,
    cases: Option<&PathBuf>,
    all_adapters: bool,
) -> Result<(), Failure> {
    let ids = ids(cases)?;
    let blessing = etalon_diagnose::bless(expected, run, &ids, all_adapters, &today(), &message);
    let (what, added) = if path.is_dir() {
        write_findings(path, &blessing)?;
        ("findings", blessing.findings.len())
    } else {
        let finding = |source: &KnownSource| matches!(source, KnownSource::Finding(_));
        if expected.all().iter().any(|known| finding(&known.source)) {
            return Err(Failure::usage(format!(
                "{} holds one finding; name its folder, or a list of expectations",
                path.display()
            )));
        }
        write(path, &blessing.entries)?;
        ("entries", blessing.added)
    };
    say!(
        "{}: {added} {what} added, {} removed",
        path.display(),
        blessing.removed.len()
    );
    if added > 0 {
        say!("write reason, clause and grade of each before it is reviewed");
    }
    for known in &blessing.to_narrow {
        say!(
            "narrow by hand, since some of its cases improved: {}: {} {}",
            known.place(),
            known.verdict,
            known.reason
        );
    }
    if blessing.unblessed > 0 {
        say!(
            "{} selftests that do not fail cannot be expected",
            blessing.unblessed
        );
    }
    Ok(())
}

/// Adds a file for each new finding, and removes the files of fixed findings.
fn write_findings(folder: &Path, blessing: &Blessing) -> Result<(), Failure> {
    for (name, finding) in &blessing.findings {
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        let free = names
            .by_ref()
            .map(|name| folder.join(format!("{name}.json")))
            .find(|path| !path.exists());
        // There is no end of names, so a free path always exists.
        let Some(path) = free else { continue };
        let text = finding.to_text().map_err(Failure::usage)?;
        replace(&path, text.as_bytes())?;
    }
    for known in &blessing.removed {
        fs::remove_file(&known.path).map_err(|e| {
            Failure::incomplete(format!("cannot remove {}: {e}", known.path.display()))
        })?;
    }
    Ok(())
}
