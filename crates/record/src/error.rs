//! Errors of run folders, bench folders and expectations.

use crate::folder::FolderKind;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a run folder or an expectations file could not be read or written.
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
    /// A run was to be written over a bench, or a bench over another one.
    #[error(
        "{} holds a {}; choose another folder with --out, or replace it by --force",
        path.display(), kind.noun()
    )]
    Holds {
        /// The folder.
        path: PathBuf,
        /// Its content.
        kind: FolderKind,
    },
    /// The folder holds what no command recorded.
    #[error("{}; name another folder", foreign(path, *damaged))]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// The kind of the file in it whose header does not parse.
        damaged: Option<FolderKind>,
    },
    /// A bench is in the folder already.
    #[error(
        "{} already holds a bench, of which {missing} rounds are missing: choose another folder with --out, --resume \
         measures what is missing, --force replaces it",
        path.display()
    )]
    OccupiedByBench {
        /// The folder.
        path: PathBuf,
        /// Rounds that it lacks.
        missing: u64,
    },
    /// Another process writes into the folder.
    #[error(
        "another etalon is writing into {}; wait until it ends, or choose another folder with --out",
        path.display()
    )]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds a run, and neither resuming nor replacing it was asked for.
    #[error(
        "{} holds a run already, with {records} of {expected} records; {}--force replaces it",
        path.display(),
        if *resumes { "--resume draws what is missing, " } else { "" }
    )]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// Records that it holds.
        records: u64,
        /// Records of the whole run.
        expected: u64,
        /// True if the command can resume it.
        resumes: bool,
    },
    /// The run in the folder is not the one to resume.
    #[error(
        "what {} holds cannot be resumed: {reason}; --force replaces it",
        path.display()
    )]
    Another {
        /// The folder.
        path: PathBuf,
        /// The difference.
        reason: String,
    },
    /// Two folders do not hold parts of one run.
    #[error("{} and {} cannot be merged: {reason}", one.display(), other.display())]
    Apart {
        /// A folder.
        one: PathBuf,
        /// The other.
        other: PathBuf,
        /// The difference.
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
        "{} is in format {found} where this etalon reads formats up to {expected}; \
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
    #[error("{path:?} is no path below a run folder; the record that names it is damaged")]
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
        /// The limit.
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
            "{path} holds a {} without a header of etalon, so that nobody knows whose files these are",
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

    pub(crate) fn serialize(what: &'static str) -> impl FnOnce(serde_json::Error) -> Self {
        move |source| Self::Serialize { what, source }
    }
}
