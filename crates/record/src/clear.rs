//! Removing what a command recorded in a folder, so that another kind of recording can take its place.

use crate::error::RecordError;
use crate::folder::FolderKind;
use crate::report_files::{ReportFiles, remove_file};
use crate::writer::BESIDE;
use std::path::Path;

/// Removes everything of one kind from a folder, its reports first and its header last. Other files stay.
///
/// # Errors
/// If a file cannot be removed.
pub fn clear(folder: &Path, kind: FolderKind, reports: ReportFiles) -> Result<(), RecordError> {
    reports.remove(folder)?;
    if kind == FolderKind::Run {
        BESIDE.remove(folder)?;
    }
    remove_file(folder, kind.file())
}
