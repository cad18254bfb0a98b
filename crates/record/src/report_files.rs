//! The files that reports add to a run or bench folder.
//!
//! Their names are the reporter's: whoever begins a run or bench hands them in, so that a folder which is
//! replaced keeps no report of the run before.

use crate::error::RecordError;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

/// The files and folders that reports add to a run or bench folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReportFiles {
    /// Names of files.
    pub files: &'static [&'static str],
    /// Names of folders.
    pub folders: &'static [&'static str],
}

impl ReportFiles {
    /// No reports.
    pub const NONE: Self = Self {
        files: &[],
        folders: &[],
    };

    /// Removes them; what does not exist needs no removing.
    ///
    /// # Errors
    /// When one cannot be removed.
    pub fn remove(self, folder: &Path) -> Result<(), RecordError> {
        for name in self.folders {
            removed(fs::remove_dir_all(folder.join(name)), folder, name)?;
        }
        for name in self.files {
            removed(fs::remove_file(folder.join(name)), folder, name)?;
        }
        Ok(())
    }
}

fn removed(result: io::Result<()>, folder: &Path, name: &str) -> Result<(), RecordError> {
    match result {
        Err(e) if e.kind() != ErrorKind::NotFound => {
            Err(RecordError::io("remove", &folder.join(name))(e))
        }
        _ => Ok(()),
    }
}
