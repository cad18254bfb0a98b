//! Writing the page of a search over releases.

use super::page;
use crate::error::ReportError;
use crate::files::replace;
use etalon_record::Versions;
use std::path::{Path, PathBuf};

/// Writes `versions.jsonl` and `versions.html` into a folder and returns the path of the page.
///
/// # Errors
/// Returns an error if the folder cannot be written to.
pub fn write_versions(folder: &Path, versions: &Versions) -> Result<PathBuf, ReportError> {
    versions.write(folder)?;
    replace(folder, "versions.html", page::page(versions).as_bytes())
}
