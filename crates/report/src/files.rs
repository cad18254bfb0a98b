//! Files of reports, written beside their place and renamed into it: a reader never sees half a report.

use crate::error::ReportError;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a file of a folder.
pub(crate) fn replace(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let beside = folder.join(format!(".{name}.{}", std::process::id()));
    let result = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &path));
    match result {
        Ok(()) => Ok(path),
        Err(source) => {
            // Best effort: the first error is the one to report.
            let _ = fs::remove_file(&beside);
            Err(ReportError::Io { path, source })
        }
    }
}

/// Writes a file at a path.
pub(crate) fn replace_at(path: &Path, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    match path.file_name().and_then(|n| n.to_str()) {
        Some(name) => replace(folder, name, bytes),
        None => Err(ReportError::NoFile {
            path: path.to_owned(),
        }),
    }
}
