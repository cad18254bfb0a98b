//! What a place for a folder holds.
//!
//! A folder is known by a file of a name alone when it is read, so that a damaged one is told as such. It is replaced only
//! if that file begins with a header of ours: a folder of somebody else may have files of the same names.

use crate::error::RecordError;
use crate::folder::FolderKind;
use crate::lock::LOCK_FILE;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};

/// The content of a place for a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Nothing.
    Empty,
    /// What a command recorded.
    Recorded(FolderKind),
    /// Something else.
    Other,
}

impl Content {
    /// Looks at a place for a folder, which need not exist.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn of(folder: &Path) -> Result<Self, RecordError> {
        let mut entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Self::Empty),
            Err(e) => return Err(RecordError::io("read", folder)(e)),
        };
        let marked = |kind: &FolderKind| is_marked(&folder.join(kind.file()));
        if let Some(kind) = FolderKind::ALL.into_iter().find(marked) {
            return Ok(Self::Recorded(kind));
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

    /// [`Content::of`], if a command may write into the place.
    ///
    /// # Errors
    /// When the place holds something else, or cannot be read.
    pub fn writable(folder: &Path) -> Result<Self, RecordError> {
        match Self::of(folder)? {
            Self::Other => Err(RecordError::Foreign {
                path: folder.to_owned(),
                damaged: FolderKind::of(folder),
            }),
            content => Ok(content),
        }
    }
}

/// True if a process leaves a file of this name behind when it ends before its header is written.
fn is_remnant(name: &str) -> bool {
    let unfinished = |kind: FolderKind| {
        let hidden = name.strip_prefix('.');
        hidden.is_some_and(|name| name.strip_prefix(kind.file()).is_some_and(is_process))
    };
    name == LOCK_FILE || FolderKind::ALL.into_iter().any(unfinished)
}

/// True for the ending of an unfinished file: a point and the number of a process.
fn is_process(ending: &str) -> bool {
    ending
        .strip_prefix('.')
        .is_some_and(|id| id.parse::<u32>().is_ok())
}

/// The most bytes of a header that are read to recognize it.
const MAX_MARK: u64 = 64 << 20;

/// True if a file begins with a header of ours: a line with a JSON object that has the key `etalon`.
pub fn is_marked(file: &Path) -> bool {
    let mut line = Vec::new();
    let mut read = || {
        let file = File::open(file)?.take(MAX_MARK);
        BufReader::new(file).read_until(b'\n', &mut line)
    };
    // A pipe would be waited for.
    file.is_file() && read().is_ok() && has_key(&line)
}

/// True if a line is a JSON object with the key `etalon`.
fn has_key(line: &[u8]) -> bool {
    let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
    let object: Result<BTreeMap<String, IgnoredAny>, _> = serde_json::from_slice(line);
    object.is_ok_and(|object| object.contains_key("etalon"))
}

/// True if one of two paths lies in the other, or both name one place. They need not exist.
pub fn overlap(path: &Path, other: &Path) -> bool {
    let (path, other) = (resolved(path), resolved(other));
    path.starts_with(&other) || other.starts_with(&path)
}

/// Returns the absolute path without links of as much as exists, and the rest as it is.
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
