//! The folder of the page: written beside its place and renamed into it when it is whole.

use crate::error::ReportError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The file by which a folder is known to be the page of a history.
pub const HISTORY_PAGE_FILE: &str = "history.json";
/// All that such a folder has at its top.
const TOP: [&str; 3] = ["index.html", "data", HISTORY_PAGE_FILE];

/// A folder in the making.
pub(super) struct Folder {
    to: PathBuf,
    beside: PathBuf,
    pub(super) files: u64,
    pub(super) bytes: u64,
}

impl Folder {
    /// Begins a folder.
    ///
    /// # Errors
    /// If its place holds something else, or the folder beside it cannot be made.
    pub(super) fn begin(to: &Path) -> Result<Self, ReportError> {
        check(to)?;
        let Some(name) = to.file_name() else {
            return Err(ReportError::NoFile {
                path: to.to_owned(),
            });
        };
        let parent = match to.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let name = name.to_string_lossy();
        let beside = parent.join(format!(".{name}.{}", std::process::id()));
        let data = beside.join("data");
        fs::create_dir_all(&data).map_err(|source| wrong(&data, source))?;
        Ok(Self {
            to: to.to_owned(),
            beside,
            files: 0,
            bytes: 0,
        })
    }

    /// Writes a file.
    ///
    /// # Errors
    /// If the system refuses.
    pub(super) fn write(&mut self, name: &str, text: &str) -> Result<(), ReportError> {
        let path = self.beside.join(name);
        fs::write(&path, text).map_err(|source| wrong(&self.to.join(name), source))?;
        self.files += 1;
        self.bytes += text.len() as u64;
        Ok(())
    }

    /// Puts the folder into its place.
    ///
    /// # Errors
    /// If the system refuses; what was there before is back then.
    pub(super) fn finish(self) -> Result<(), ReportError> {
        let old = self.beside.with_extension("old");
        let there = self.to.exists();
        if there {
            fs::rename(&self.to, &old).map_err(|source| wrong(&self.to, source))?;
        }
        if let Err(source) = fs::rename(&self.beside, &self.to) {
            if there {
                // Best effort: the first error is the one to report.
                let _ = fs::rename(&old, &self.to);
            }
            return Err(wrong(&self.to, source));
        }
        match there {
            true => fs::remove_dir_all(&old).map_err(|source| wrong(&old, source)),
            false => Ok(()),
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Gone if it was finished. Best effort: it is of no use to anyone.
        let _ = fs::remove_dir_all(&self.beside);
    }
}

fn wrong(path: &Path, source: io::Error) -> ReportError {
    ReportError::Io {
        path: path.to_owned(),
        source,
    }
}

/// A folder may be replaced if it is empty, or an earlier page and nothing else.
fn check(to: &Path) -> Result<(), ReportError> {
    let path = to.to_owned();
    let entries = match fs::read_dir(to) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(ReportError::Unread { path, source }),
    };
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|source| ReportError::Unread {
            path: path.clone(),
            source,
        })?;
        names.push(entry.file_name().to_string_lossy().into_owned());
    }
    names.sort_unstable();
    let foreign = names.iter().find(|name| !TOP.contains(&name.as_str()));
    match (names.iter().any(|name| name == HISTORY_PAGE_FILE), foreign) {
        (true, None) => Ok(()),
        (true, Some(foreign)) => Err(ReportError::NotOfTheHistory {
            path: path.join(foreign),
        }),
        (false, _) if names.is_empty() => Ok(()),
        (false, _) => Err(ReportError::NoHistoryPage { path }),
    }
}
