//! Emptying a folder of the run or the bench that it holds, so that the other kind can take its place.

use crate::error::RecordError;
use crate::folder::{BENCH_FILE, FolderKind};
use crate::report_files::ReportFiles;
use crate::writer::OWN;
use std::path::Path;

/// The file of a bench beside its reports.
const BENCH: ReportFiles = ReportFiles {
    folders: &[],
    files: &[BENCH_FILE],
};

/// Removes what a folder holds of a kind, its reports first. Other files stay.
///
/// # Errors
/// When a file cannot be removed.
pub fn clear(folder: &Path, kind: FolderKind, reports: ReportFiles) -> Result<(), RecordError> {
    reports.remove(folder)?;
    match kind {
        FolderKind::Run => OWN,
        FolderKind::Bench => BENCH,
    }
    .remove(folder)
}
