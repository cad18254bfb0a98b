//! Reading and writing of expectations.

use crate::failure::Failure;
use crate::provenance;
use etalon_record::{Entry, Expectations, RecordError};
use std::fs;
use std::path::{Path, PathBuf};

/// The files of `ci/findings`: paths and texts.
const FINDINGS: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/findings.rs"));

/// Returns the expectations of a file or folder, or the built-in findings.
pub(crate) fn read(path: Option<&Path>) -> Result<Expectations, Failure> {
    match path {
        Some(path) => Expectations::read(path),
        None => Expectations::of_findings(FINDINGS),
    }
    .map_err(Failure::usage)
}

/// Returns the current day in UTC, such as `2027-01-31`.
pub(crate) fn today() -> String {
    provenance::now().chars().take(10).collect()
}

/// Writes entries to a file.
pub(crate) fn write(path: &Path, entries: &[Entry]) -> Result<(), Failure> {
    let text = Expectations::to_text(entries).map_err(Failure::usage)?;
    // A file that cannot be parsed must not replace one that can.
    Expectations::parse(&text, path).map_err(|error: RecordError| Failure::usage(error))?;
    replace(path, &text)
}

/// Replaces a file by renaming a complete new one.
pub(crate) fn replace(path: &Path, text: &str) -> Result<(), Failure> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}", std::process::id()));
    let beside = PathBuf::from(beside);
    let written = fs::write(&beside, text).and_then(|()| fs::rename(&beside, path));
    written.map_err(|e| {
        // The first error is the one to report.
        let _ = fs::remove_file(&beside);
        Failure::incomplete(format!("cannot write {}: {e}", path.display()))
    })
}
