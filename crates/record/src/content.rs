//! The content of a folder, or of a path at which there is no folder yet.
//!
//! A folder's kind is recognized by a file name alone when it is read, so that a damaged folder gives an
//! error about its damage. A folder is replaced only if that file begins with a header of etalon, because
//! other programs' folders can have files with the same names.

use crate::error::RecordError;
use crate::folder::FolderKind;
use crate::list::read_list;
use crate::lock::LOCK_FILE;
use crate::paths::open_below;
use serde::de::IgnoredAny;
use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// The content of a folder that a command may write to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Nothing, or a folder of etalon without a recording, in which files of others are left alone.
    Empty,
    /// A recording of this kind.
    Recorded(FolderKind),
    /// Anything else.
    Other,
}

impl Content {
    /// Inspects a path. The folder does not have to exist.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn of(folder: &Path) -> Result<Self, RecordError> {
        check_folder(folder)?;
        let mut entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Self::Empty),
            Err(e) => return Err(RecordError::io("read", folder)(e)),
        };
        let marked = |kind: &FolderKind| is_marked(folder, kind.file());
        if let Some(kind) = FolderKind::ALL.into_iter().find(marked) {
            return Ok(Self::Recorded(kind));
        }
        // A command that was killed while it replaced a recording leaves the list.
        let is_free = |listed: HashSet<String>| {
            let mut files = listed.iter();
            files.all(|file| fs::symlink_metadata(folder.join(file)).is_err())
        };
        if FolderKind::of(folder).is_none() && read_list(folder)?.is_some_and(is_free) {
            return Ok(Self::Empty);
        }
        let foreign = entries.find_map(|entry| match entry {
            Ok(entry) => (!is_remnant(&entry.file_name().to_string_lossy())).then_some(Ok(())),
            Err(e) => Some(Err(RecordError::io("read", folder)(e))),
        });
        Ok(match foreign.transpose()? {
            None => Self::Empty,
            Some(()) => Self::Other,
        })
    }

    /// Returns [`Content::of`] if a command may write there.
    ///
    /// # Errors
    /// If the folder holds anything else, or cannot be read.
    pub fn writable(folder: &Path) -> Result<Self, RecordError> {
        match Self::of(folder)? {
            Self::Other => {
                let damaged = FolderKind::of(folder);
                let file = damaged.map(|kind| folder.join(kind.file()));
                Err(match file.filter(|path| path.is_symlink()) {
                    Some(path) => RecordError::Link { path },
                    None => RecordError::Foreign {
                        path: folder.to_owned(),
                        damaged,
                    },
                })
            }
            content => Ok(content),
        }
    }
}

/// Checks that a path is a folder, or that one can be made there.
///
/// # Errors
/// If the path, or what it is in, is a file or a link that leads nowhere.
pub fn check_folder(path: &Path) -> Result<(), RecordError> {
    let mut above = path.ancestors();
    match above.find(|path| fs::symlink_metadata(path).is_ok()) {
        Some(path) if !path.is_dir() => {
            let path = path.to_owned();
            Err(match fs::metadata(&path) {
                Ok(_) => RecordError::NoFolder { path },
                Err(_) => RecordError::DeadLink { path },
            })
        }
        _ => Ok(()),
    }
}

/// Returns true if a process that ends before it has written its header leaves a file with this name.
fn is_remnant(name: &str) -> bool {
    let unfinished = |kind: FolderKind| {
        let hidden = name.strip_prefix('.');
        hidden.is_some_and(|name| name.strip_prefix(kind.file()).is_some_and(is_process))
    };
    name == LOCK_FILE || FolderKind::ALL.into_iter().any(unfinished)
}

/// Returns true for the suffix of an unfinished file: a dot and a process id.
fn is_process(ending: &str) -> bool {
    ending
        .strip_prefix('.')
        .is_some_and(|id| id.parse::<u32>().is_ok())
}

/// The maximum number of bytes of a header that are read to recognize it.
const MAX_MARK: u64 = 64 << 20;

/// Returns true if a file of a folder begins with a header of etalon: a line with a JSON object that has the key
/// `etalon`.
pub fn is_marked(folder: &Path, name: &str) -> bool {
    let mut line = Vec::new();
    let read = open_below(folder, name).is_ok_and(|file| {
        let mut file = BufReader::new(file.take(MAX_MARK));
        file.read_until(b'\n', &mut line).is_ok()
    });
    read && has_key(&line)
}

/// Returns true if a line is a JSON object with the key `etalon`.
fn has_key(line: &[u8]) -> bool {
    let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
    let object: Result<BTreeMap<String, IgnoredAny>, _> = serde_json::from_slice(line);
    object.is_ok_and(|object| object.contains_key("etalon"))
}

/// Returns true if one path is inside the other, or both name the same location. Neither path has to exist.
pub fn overlap(path: &Path, other: &Path) -> bool {
    let (path, other) = (resolved(path), resolved(other));
    path.starts_with(&other) || other.starts_with(&path)
}

/// Returns the absolute path, with links resolved in the part that exists.
fn resolved(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut resolved = PathBuf::new();
    for component in absolute.components() {
        if component == Component::ParentDir {
            resolved.pop();
        } else {
            resolved.push(component);
            if let Ok(real) = fs::canonicalize(&resolved) {
                resolved = real;
            }
        }
    }
    resolved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_marks_a_folder_and_a_name_alone_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        assert_eq!(Content::of(&folder.join("new")).unwrap(), Content::Empty);
        fs::write(folder.join(LOCK_FILE), "").unwrap();
        fs::write(folder.join(".run.jsonl.17"), "{").unwrap();
        assert_eq!(Content::of(folder).unwrap(), Content::Empty);
        for kind in FolderKind::ALL {
            let file = folder.join(kind.file());
            for foreign in ["", "{}\n", "[\"etalon\"]", "notes"] {
                fs::write(&file, foreign).unwrap();
                assert_eq!(Content::of(folder).unwrap(), Content::Other, "{foreign}");
            }
            fs::write(&file, "{\"format\":9,\"etalon\":\"1\",\"new\":[]}\n{").unwrap();
            assert_eq!(Content::of(folder).unwrap(), Content::Recorded(kind));
            fs::remove_file(&file).unwrap();
        }
        fs::write(folder.join(".run.jsonl.bak"), "mine").unwrap();
        assert_eq!(Content::of(folder).unwrap(), Content::Other);
    }

    #[test]
    fn paths_overlap_whether_they_exist_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        fs::create_dir_all(folder.join("cases/a")).unwrap();
        let overlaps = |path: &str| overlap(&folder.join(path), &folder.join("cases"));
        assert!(overlaps("cases") && overlaps("cases/new/run") && overlaps(""));
        assert!(overlaps("other/../cases/x"));
        assert!(!overlaps("cases-2") && !overlaps("cases/../runs"));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(folder.join("cases"), folder.join("link")).unwrap();
            assert!(overlaps("link/run"));
        }
    }
}
