//! Folders of pages, which are written to a temporary folder and renamed when they are complete.

use crate::error::ReportError;
use crate::files::Destination;
use etalon_record::{check_folder, is_marked};
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A kind of folder of pages.
pub(crate) struct PagesKind {
    /// The file that marks such a folder. It lists the files of the folder.
    pub(crate) mark: &'static str,
    /// The name, and the name with its kind.
    pub(crate) names: [&'static str; 2],
}

/// A folder of pages that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenFolder {
    /// The start page.
    pub html: PathBuf,
    /// The size of the start page in bytes.
    pub start: u64,
    /// The number of files, the start page included.
    pub files: u64,
    /// The size of all files together in bytes.
    pub bytes: u64,
}

/// Checks that a path is free, or that it has only files of an earlier folder of this kind and may be
/// replaced.
fn check(to: &Path, kind: &PagesKind, replace: bool) -> Result<(), ReportError> {
    let path = to.to_owned();
    let unread = ReportError::unread(to);
    match fs::read_dir(to).map(|mut entries| entries.next().is_none()) {
        Ok(true) => return Ok(()),
        Ok(false) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(unread(error)),
    }
    if !is_marked(to, kind.mark) {
        let kind = kind.names[1];
        return Err(ReportError::Occupied { path, kind });
    }
    let listed = listed(to, kind).map_err(&unread)?;
    let mut paths = Vec::new();
    files(to, Path::new(""), &mut paths).map_err(&unread)?;
    paths.sort_unstable();
    let foreign = |path: &PathBuf| {
        path.as_os_str() != kind.mark && !listed.contains(&*path.to_string_lossy())
    };
    match paths.into_iter().find(foreign) {
        _ if !replace => Err(ReportError::HasPages {
            path,
            kind: kind.names[1],
        }),
        Some(path) => Err(ReportError::Foreign {
            path: to.join(path),
            kind: kind.names[0],
        }),
        None => Ok(()),
    }
}

/// Returns the files that the marking file of a folder lists. Earlier versions listed none, so any of the folder's can
/// be somebody else's.
fn listed(folder: &Path, kind: &PagesKind) -> io::Result<HashSet<String>> {
    let text = fs::read(folder.join(kind.mark))?;
    let value: Value = serde_json::from_slice(&text).unwrap_or_default();
    let names = value["files"].as_array().into_iter().flatten();
    Ok(names.filter_map(Value::as_str).map(str::to_owned).collect())
}

/// Removes a folder with the files that it lists; other files stay, with their folders. The marking file is removed
/// last, so that the next process can go on if this one is killed.
fn remove(folder: &Path, kind: &PagesKind) -> io::Result<()> {
    if !is_marked(folder, kind.mark) {
        return fs::remove_dir(folder);
    }
    let listed = listed(folder, kind)?;
    let mut paths = Vec::new();
    files(folder, Path::new(""), &mut paths)?;
    let mut folders = BTreeSet::new();
    for path in &paths {
        folders.extend(path.ancestors().skip(1).map(Path::to_owned));
        if listed.contains(&*path.to_string_lossy()) {
            fs::remove_file(folder.join(path))?;
        }
    }
    // What is below a folder sorts behind it.
    for below in folders
        .iter()
        .rev()
        .filter(|path| !path.as_os_str().is_empty())
    {
        // A folder with another file stays.
        let _ = fs::remove_dir(folder.join(below));
    }
    fs::remove_file(folder.join(kind.mark))?;
    fs::remove_dir(folder)
}

/// Returns a path beside another at which there is nothing: `.NAME.ending`, or with a number.
fn beside(to: &Path, ending: &str) -> PathBuf {
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let first = to.with_file_name(format!(".{name}.{ending}"));
    let more = (2..).map(|number| to.with_file_name(format!(".{name}.{ending}-{number}")));
    let mut paths = std::iter::once(first.clone()).chain(more);
    paths
        .find(|path| fs::symlink_metadata(path).is_err())
        .unwrap_or(first)
}

/// The ending of the name under which the earlier folder is kept until the new one is in its place.
const OLD: &str = "old";

/// Ends what a killed process began: puts an earlier folder back, or removes what is left of it.
fn recover(to: &Path, kind: &PagesKind) -> Result<(), ReportError> {
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    let old = to.with_file_name(format!(".{name}.{OLD}"));
    if !is_marked(&old, kind.mark) {
        Ok(())
    } else if fs::symlink_metadata(to).is_err() {
        fs::rename(&old, to).map_err(ReportError::unwritten(to))
    } else {
        // A file of somebody else in it stays.
        let _ = remove(&old, kind);
        Ok(())
    }
}

/// Collects the files below a folder, and the empty folders.
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

/// A folder that is being written.
pub(crate) struct Staged {
    kind: &'static PagesKind,
    /// True to replace an earlier folder.
    replace: bool,
    to: PathBuf,
    beside: PathBuf,
    written: Mutex<WrittenFiles>,
}

/// The files that were written.
#[derive(Debug, Default)]
struct WrittenFiles {
    names: Vec<String>,
    bytes: u64,
}

/// A folder below one that is being written.
pub(crate) struct StagedBelow<'a> {
    staged: &'a Staged,
    below: PathBuf,
}

impl StagedBelow<'_> {
    /// Returns the names of its files.
    pub(crate) fn names(&self) -> BTreeSet<PathBuf> {
        let written = self.staged.written();
        let names = written.names.iter().map(Path::new);
        let below = names.filter_map(|name| name.strip_prefix(&self.below).ok());
        below.map(Path::to_owned).collect()
    }
}

impl Destination for StagedBelow<'_> {
    fn write(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
        let name = self.below.join(name);
        self.staged.write(&name, bytes)?;
        Ok(self.staged.to.join(name))
    }
}

impl Staged {
    /// Begins a folder. With `replace`, it can replace an earlier folder of its kind.
    ///
    /// # Errors
    /// Returns an error if the path has no name, cannot be read, or has other files.
    pub(crate) fn begin(
        to: &Path,
        kind: &'static PagesKind,
        replace: bool,
    ) -> Result<Self, ReportError> {
        check_folder(to)?;
        // A link to a folder stays a link.
        let to = if to.is_symlink() {
            &fs::canonicalize(to).map_err(ReportError::unread(to))?
        } else {
            to
        };
        if to.file_name().is_none() {
            return Err(ReportError::NoFile {
                path: to.to_owned(),
            });
        }
        recover(to, kind)?;
        check(to, kind, replace)?;
        Ok(Self {
            kind,
            replace,
            to: to.to_owned(),
            beside: beside(to, &std::process::id().to_string()),
            written: Mutex::default(),
        })
    }

    /// Writes a file.
    ///
    /// # Errors
    /// Returns an error if the system refuses.
    pub(crate) fn write(&self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<(), ReportError> {
        let path = self.beside.join(&name);
        let folder = path.parent().unwrap_or(&self.beside);
        let written = fs::create_dir_all(folder).and_then(|()| fs::write(&path, bytes));
        written.map_err(ReportError::unwritten(&self.to.join(&name)))?;
        let mut written = self.written();
        let name = name.as_ref().to_string_lossy();
        written.names.push(name.into_owned());
        written.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Returns a folder below this one.
    pub(crate) fn below(&self, folder: impl Into<PathBuf>) -> StagedBelow<'_> {
        StagedBelow {
            staged: self,
            below: folder.into(),
        }
    }

    fn written(&self) -> MutexGuard<'_, WrittenFiles> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the start page and the marking file, which lists all files, and moves the folder to its place.
    /// `about` is the rest of the marking file's content, with the key `etalon`.
    ///
    /// # Errors
    /// Returns an error if the system refuses. The earlier folder is then restored.
    pub(crate) fn finish(
        self,
        start: &[u8],
        mut about: Value,
    ) -> Result<WrittenFolder, ReportError> {
        self.write("index.html", start)?;
        about["files"] = json!(self.written().names);
        self.write(self.kind.mark, about.to_string().as_bytes())?;
        let old = beside(&self.to, OLD);
        let replaces = self.to.exists();
        if replaces {
            // A file can have come since the beginning.
            check(&self.to, self.kind, self.replace)?;
            let permissions = fs::metadata(&self.to).map(|found| found.permissions());
            permissions
                .and_then(|permissions| fs::set_permissions(&self.beside, permissions))
                .map_err(ReportError::unwritten(&self.to))?;
            fs::rename(&self.to, &old).map_err(ReportError::unwritten(&self.to))?;
        }
        if let Err(source) = fs::rename(&self.beside, &self.to) {
            if replaces {
                // Errors are ignored: the first error is reported.
                let _ = fs::rename(&old, &self.to);
            }
            return Err(ReportError::unwritten(&self.to)(source));
        }
        if replaces {
            remove(&old, self.kind).map_err(ReportError::unwritten(&old))?;
        }
        let written = self.written();
        Ok(WrittenFolder {
            html: self.to.join("index.html"),
            start: start.len() as u64,
            files: written.names.len() as u64,
            bytes: written.bytes,
        })
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        // A finished folder was moved away from here. Errors are ignored, since nothing uses an unfinished
        // folder.
        let _ = fs::remove_dir_all(&self.beside);
    }
}
