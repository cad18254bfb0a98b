//! Folders of pages: written beside their place, and renamed into it when they are whole.

use crate::error::ReportError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The content of a place for a folder of pages.
pub(crate) enum Content {
    /// Nothing.
    Empty,
    /// An earlier folder of this kind.
    Earlier,
    /// An earlier folder of this kind with a file that is not of it.
    Foreign(PathBuf),
    /// Something else.
    Other,
}

impl Content {
    /// Looks at a place for a folder, which is known by its file `mark` and has only `top` at its top.
    ///
    /// # Errors
    /// Returns an error if the place cannot be read.
    pub(crate) fn of(to: &Path, mark: &str, top: &[&str]) -> Result<Self, ReportError> {
        let unread = |source| ReportError::Unread {
            path: to.to_owned(),
            source,
        };
        let entries = match fs::read_dir(to) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::Empty),
            Err(error) => return Err(unread(error)),
        };
        let names = entries.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()));
        let mut names = names.collect::<io::Result<Vec<String>>>().map_err(unread)?;
        names.sort_unstable();
        let foreign = names.iter().find(|name| !top.contains(&name.as_str()));
        Ok(match (names.iter().any(|name| name == mark), foreign) {
            _ if names.is_empty() => Self::Empty,
            (true, None) => Self::Earlier,
            (true, Some(foreign)) => Self::Foreign(to.join(foreign)),
            (false, _) => Self::Other,
        })
    }
}

/// A folder in the making.
pub(crate) struct Staged {
    to: PathBuf,
    beside: PathBuf,
    /// The number of files that were written.
    pub(crate) files: u64,
    /// Their bytes.
    pub(crate) bytes: u64,
}

impl Staged {
    /// Begins a folder.
    ///
    /// # Errors
    /// Returns an error if the place has no name, or the folder beside it cannot be made.
    pub(crate) fn begin(to: &Path) -> Result<Self, ReportError> {
        let Some(name) = to.file_name() else {
            return Err(ReportError::NoFile {
                path: to.to_owned(),
            });
        };
        let hidden = format!(".{}.{}", name.to_string_lossy(), std::process::id());
        let staged = Self {
            to: to.to_owned(),
            beside: to.with_file_name(hidden),
            files: 0,
            bytes: 0,
        };
        fs::create_dir_all(&staged.beside).map_err(|source| wrong(&staged.beside, source))?;
        Ok(staged)
    }

    /// Writes a file.
    ///
    /// # Errors
    /// Returns an error if the system refuses.
    pub(crate) fn write(
        &mut self,
        name: impl AsRef<Path>,
        bytes: &[u8],
    ) -> Result<(), ReportError> {
        let path = self.beside.join(&name);
        let folder = path.parent().unwrap_or(&self.beside);
        let written = fs::create_dir_all(folder).and_then(|()| fs::write(&path, bytes));
        written.map_err(|source| wrong(&self.to.join(&name), source))?;
        self.files += 1;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Puts the folder into its place.
    ///
    /// # Errors
    /// Returns an error if the system refuses; what was there before is back then.
    pub(crate) fn finish(self) -> Result<(), ReportError> {
        let old = self.beside.with_extension("old");
        let replaces = self.to.exists();
        if replaces {
            fs::rename(&self.to, &old).map_err(|source| wrong(&self.to, source))?;
        }
        if let Err(source) = fs::rename(&self.beside, &self.to) {
            if replaces {
                // Best effort: the first error is the one to report.
                let _ = fs::rename(&old, &self.to);
            }
            return Err(wrong(&self.to, source));
        }
        if replaces {
            fs::remove_dir_all(&old).map_err(|source| wrong(&old, source))?;
        }
        Ok(())
    }
}

impl Drop for Staged {
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
