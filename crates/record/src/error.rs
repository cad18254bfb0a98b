//! Errors of run folders, bench folders and expectations.

use crate::folder::FolderKind;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An error of reading or writing a run folder, a bench folder or an expectations file.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The system refused to read or write.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// `read`, `write`, `create`, `remove`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The folder holds no run.
    #[error(
        "{} holds no run.jsonl; name a folder that `etalon run --out` wrote",
        path.display()
    )]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds no bench.
    #[error(
        "{} holds no bench.jsonl; name a folder that `etalon bench --out` wrote",
        path.display()
    )]
    NoBench {
        /// The folder.
        path: PathBuf,
    },
    /// A command would overwrite a recording of another kind.
    #[error(
        "{} holds a {}; choose another folder with --out, or replace it by --force",
        path.display(), kind.noun()
    )]
    Holds {
        /// The folder.
        path: PathBuf,
        /// The kind of the folder's content.
        kind: FolderKind,
    },
    /// The folder holds files that no command recorded.
    #[error("{}; name another folder", foreign(path, *damaged))]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// The kind of the file in it whose header does not parse.
        damaged: Option<FolderKind>,
    },
    /// A file is in the way that no command recorded.
    #[error("{} is not a file of etalon and would be replaced; move it, or name another folder", path.display())]
    NotOurs {
        /// The file.
        path: PathBuf,
    },
    /// A link is in the way.
    #[error("{} is a link or no regular file, and nothing is written through it; remove it, or name another folder", path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A frame file cannot be read.
    #[error("cannot read the frame {}: {source}; copy the file anew, or draw the case again", path.display())]
    Frame {
        /// The file.
        path: PathBuf,
        /// The system's error, or that of the compressed file.
        source: io::Error,
    },
    /// A file to read is a link, a pipe, a device or a folder.
    #[error("{} is a link or no regular file, so it is not read; put the file itself there", path.display())]
    Irregular {
        /// The path.
        path: PathBuf,
    },
    /// The folder already holds a bench.
    #[error(
        "{} already holds a bench, which lacks {missing} rounds: choose another folder with --out, --resume \
         measures what is missing, --force replaces it",
        path.display()
    )]
    OccupiedByBench {
        /// The folder.
        path: PathBuf,
        /// The number of rounds that the bench lacks.
        missing: u64,
    },
    /// A file is in the place of a folder.
    #[error("{} is no folder; name another", path.display())]
    NoFolder {
        /// The path.
        path: PathBuf,
    },
    /// A link that leads nowhere is in the place of a folder or a file.
    #[error("{} is a link that leads nowhere; remove it, or name another path", path.display())]
    DeadLink {
        /// The link.
        path: PathBuf,
    },
    /// Another process is writing to the folder.
    #[error(
        "another etalon is writing into {}; wait until it ends, or choose another folder with --out",
        path.display()
    )]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds a run, and the caller asked neither to resume nor to replace it.
    #[error(
        "{} holds a run already, with {records} of {expected} records; {}--force replaces it",
        path.display(),
        if *resumes { "--resume draws what is missing, " } else { "" }
    )]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// The number of records that the folder holds.
        records: u64,
        /// The number of records of the complete run.
        expected: u64,
        /// True if the command can resume it.
        resumes: bool,
    },
    /// The run in the folder does not match the run to resume.
    #[error(
        "what {} holds cannot be resumed: {reason}; --force replaces it",
        path.display()
    )]
    Another {
        /// The folder.
        path: PathBuf,
        /// The first difference.
        reason: String,
    },
    /// Two folders do not hold parts of one run.
    #[error("{} and {} cannot be merged: {reason}", one.display(), other.display())]
    Apart {
        /// One of the two folders.
        one: PathBuf,
        /// The other folder.
        other: PathBuf,
        /// The first difference.
        reason: String,
    },
    /// A folder cannot be merged with any other.
    #[error("{} cannot be merged: {reason}", path.display())]
    Unmergeable {
        /// The folder.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The file is in another format.
    #[error(
        "{} is in format {found}, but this etalon reads formats up to {expected}; \
         read it with the version that wrote it, or record the run again",
        path.display()
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// The format that the file states.
        found: u32,
        /// The format that this crate reads.
        expected: u32,
    },
    /// A folder of findings has other files only.
    #[error("{} holds files, and none is a finding (*.json); name the folder of findings", path.display())]
    NoFinding {
        /// The folder.
        path: PathBuf,
    },
    /// A line of a run, a frame file or an expectations file does not parse.
    #[error("{}:{line}: {message}; {remedy}", path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The error.
        message: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// A path in a record leaves the run folder.
    #[error("{path:?} is not a path below a run folder; the record that names it is damaged")]
    Outside {
        /// The path as recorded.
        path: String,
    },
    /// A record is too long even without wrong texels, story and message.
    #[error("the record of {case:?} on {adapter:?} cannot be shortened to {limit} bytes")]
    TooLong {
        /// The case.
        case: String,
        /// The adapter.
        adapter: String,
        /// The largest number of bytes of a record.
        limit: usize,
    },
    /// A value has no JSON form.
    #[error("cannot write {what} as JSON: {source}")]
    Serialize {
        /// The value that was to be written.
        what: &'static str,
        /// The reason.
        source: serde_json::Error,
    },
}

fn foreign(path: &Path, damaged: Option<FolderKind>) -> String {
    let path = path.display();
    match damaged {
        None => format!("{path} is not empty, and etalon did not record what it holds"),
        Some(kind) => format!(
            "{path} holds a {} without a header of etalon, so the files may belong to another program",
            kind.file()
        ),
    }
}

impl RecordError {
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io {
            action,
            path,
            source,
        }
    }

    /// Returns true if a file does not exist, or what should be its folder is a file.
    pub(crate) fn is_missing(&self) -> bool {
        use io::ErrorKind::{NotADirectory, NotFound};
        matches!(self, Self::Io { source, .. } if matches!(source.kind(), NotFound | NotADirectory))
    }

    pub(crate) fn serialize(what: &'static str) -> impl FnOnce(serde_json::Error) -> Self {
        move |source| Self::Serialize { what, source }
    }
}
