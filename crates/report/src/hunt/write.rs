//! Writing the reports of a hunt.

use super::page;
use crate::error::ReportError;
use crate::files::replace;
use etalon_record::Hunt;
use std::path::{Path, PathBuf};

/// The files that [`write_hunt`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenHunt {
    /// The page.
    pub html: PathBuf,
    /// The hunt itself.
    pub json: PathBuf,
}

/// Writes `mutants.json` and `mutants.html` into a folder, which is made when it does not exist.
///
/// # Errors
/// Returns an error if the folder cannot be written to.
pub fn write_hunt(folder: &Path, hunt: &Hunt) -> Result<WrittenHunt, ReportError> {
    let json = hunt.write(folder)?;
    let html = replace(folder, "mutants.html", page::page(hunt).as_bytes())?;
    Ok(WrittenHunt { html, json })
}
