//! The files that reports add to a run or bench folder.
//!
//! The crate that reports knows their names. The code that begins a run or bench passes them in, so that no
//! report of an earlier run stays in a replaced folder.

use crate::error::RecordError;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// The files and folders that reports add to a run or bench folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReportFiles {
    /// Names of files.
    pub files: &'static [&'static str],
    /// Names of folders, each with the extension of the files in it.
    pub folders: &'static [(&'static str, &'static str)],
}

impl ReportFiles {
    /// No reports.
    pub const NONE: Self = Self {
        files: &[],
        folders: &[],
    };

    /// Removes the reports that exist. Other files in the folders stay.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn remove(self, folder: &Path) -> Result<(), RecordError> {
        for (name, extension) in self.folders {
            removed(remove_below(&folder.join(name), extension), folder, name)?;
        }
        for name in self.files {
            remove_file(folder, name)?;
        }
        Ok(())
    }
}

/// Removes the files with an extension below a folder, and folders that become empty. Links and their
/// targets stay.
fn remove_below(folder: &Path, extension: &str) -> io::Result<()> {
    if !fs::symlink_metadata(folder)?.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let (kind, path) = (entry.file_type()?, entry.path());
        if kind.is_dir() {
            remove_below(&path, extension)?;
        } else if kind.is_file() && path.extension().is_some_and(|e| e == extension) {
            fs::remove_file(&path)?;
        }
    }
    match fs::remove_dir(folder) {
        Err(e) if e.kind() == ErrorKind::DirectoryNotEmpty => Ok(()),
        result => result,
    }
}

/// Removes a file of a folder if it exists.
pub(crate) fn remove_file(folder: &Path, name: &str) -> Result<(), RecordError> {
    removed(fs::remove_file(folder.join(name)), folder, name)
}

fn removed(result: io::Result<()>, folder: &Path, name: &str) -> Result<(), RecordError> {
    match result {
        Err(e) if e.kind() != ErrorKind::NotFound => {
            Err(RecordError::io("remove", &folder.join(name))(e))
        }
        _ => Ok(()),
    }
}
