//! Folders of pages: written beside their place, and renamed into it when they are whole.

use crate::error::ReportError;
use etalon_record::is_marked;
use serde_json::{Value, json};
use std::collections::HashSet;
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
    /// Looks at a place for a folder, which is known by its file `mark`. That file lists the files of the folder; of
    /// earlier folders, whose mark lists none, `top` is all that is at the top.
    ///
    /// # Errors
    /// Returns an error if the place cannot be read.
    pub(crate) fn of(to: &Path, mark: &str, top: &[&str]) -> Result<Self, ReportError> {
        let unread = |source| ReportError::Unread {
            path: to.to_owned(),
            source,
        };
        match fs::read_dir(to).map(|mut entries| entries.next().is_none()) {
            Ok(true) => return Ok(Self::Empty),
            Ok(false) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::Empty),
            Err(error) => return Err(unread(error)),
        }
        let file = to.join(mark);
        if !is_marked(&file) {
            return Ok(Self::Other);
        }
        let text = fs::read(&file).map_err(unread)?;
        let value: Value = serde_json::from_slice(&text).unwrap_or_default();
        let listed = value["files"].as_array();
        let listed: Option<HashSet<&str>> =
            listed.map(|files| files.iter().filter_map(Value::as_str).collect());
        let of_it = |path: &Path| {
            let name = path.to_string_lossy();
            name == mark
                || match &listed {
                    Some(files) => files.contains(&*name),
                    None => path
                        .iter()
                        .next()
                        .is_some_and(|f| top.iter().any(|t| f == *t)),
                }
        };
        let mut paths = Vec::new();
        files(to, Path::new(""), &mut paths).map_err(unread)?;
        paths.sort_unstable();
        let foreign = paths.into_iter().find(|path| !of_it(path));
        Ok(foreign.map_or(Self::Earlier, |path| Self::Foreign(to.join(path))))
    }
}

/// Collects the files below a folder, and the folders without any.
fn files(folder: &Path, below: &Path, paths: &mut Vec<PathBuf>) -> io::Result<()> {
    let before = paths.len();
    for entry in fs::read_dir(folder.join(below))? {
        let entry = entry?;
        let path = below.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            files(folder, &path, paths)?;
        } else {
            paths.push(path);
        }
    }
    if paths.len() == before && below != Path::new("") {
        paths.push(below.to_owned());
    }
    Ok(())
}

/// A folder in the making.
pub(crate) struct Staged {
    to: PathBuf,
    beside: PathBuf,
    names: Vec<String>,
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
            names: Vec::new(),
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
        self.names
            .push(name.as_ref().to_string_lossy().into_owned());
        self.files += 1;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Writes the file by which the folder is known, with the files that it lists, and puts the folder into its place.
    /// `about` is the rest of its content, which has the key `etalon`.
    ///
    /// # Errors
    /// Returns an error if the system refuses; what was there before is back then.
    pub(crate) fn finish(&mut self, mark: &str, mut about: Value) -> Result<(), ReportError> {
        about["files"] = json!(self.names);
        self.write(mark, about.to_string().as_bytes())?;
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
