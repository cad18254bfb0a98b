//! Errors of the history.

use etalon_record::{LabelError, RecordError};
use rusqlite::ErrorCode;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An error of reading or writing a history, or of adding a run.
#[derive(Debug, Error)]
pub enum HistoryError {
    /// There is no such file, or it is empty.
    #[error("there is no history at {}; `etalon history add RUN` makes one", path.display())]
    None {
        /// The file.
        path: PathBuf,
    },
    /// The file is not a history.
    #[error("{} is no history of etalon; name another file with --db", path.display())]
    Other {
        /// The file.
        path: PathBuf,
    },
    /// A newer version of the suite wrote the file.
    #[error(
        "{} has schema {found}, but this etalon reads schemas up to {known}: use the etalon that wrote it, or name \
         another file with --db",
        path.display()
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// The file's schema.
        found: u32,
        /// The newest schema that this version reads.
        known: u32,
    },
    /// Another process locked the file for too long.
    #[error("{} is in use by another process; try again when that has ended", path.display())]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The disk is full.
    #[error(
        "no space is left for {}; free some and try again; runs that were added earlier are kept",
        path.display()
    )]
    Full {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be written to.
    #[error("{} cannot be written to; change its permissions, or copy it and name the copy with --db", path.display())]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// The file is damaged.
    #[error("{} is damaged: {message}; restore a copy, or add the run folders to a new file", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The reason.
        message: String,
    },
    /// The database refused.
    #[error("cannot use {}: {source}", path.display())]
    Database {
        /// The file.
        path: PathBuf,
        /// The database's error.
        source: rusqlite::Error,
    },
    /// The system refused to read or write.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The attempted action: `read`, `create`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The path holds nothing that can be added.
    #[error(
        "{} holds no run.jsonl, bench.jsonl or versions.jsonl; name a folder that `etalon run`, `bench` or `bisect` wrote",
        path.display()
    )]
    NoRun {
        /// The path.
        path: PathBuf,
    },
    /// A run, bench or list of versions is damaged.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A value of a header is invalid.
    #[error("{}:1: {message}; record it again", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// The reason.
        message: String,
    },
    /// A file of release dates does not parse.
    #[error("{}: {message}", path.display())]
    Dates {
        /// The file.
        path: PathBuf,
        /// The reason.
        message: String,
    },
    /// A label is invalid.
    #[error(transparent)]
    Label(#[from] LabelError),
    /// A run has two adapters of the same timeline.
    #[error("the run has the adapter {adapter:?} twice")]
    Twice {
        /// The adapter's name.
        adapter: String,
    },
    /// There is no such run.
    #[error("{} has no run {run}; `etalon history show` lists runs", path.display())]
    NoSuchRun {
        /// The history.
        path: PathBuf,
        /// The number.
        run: u32,
    },
}

impl HistoryError {
    /// Returns a function that converts an error of the database.
    pub(crate) fn database(path: &Path) -> impl Fn(rusqlite::Error) -> Self + '_ {
        move |source| {
            let path = path.to_owned();
            match source.sqlite_error_code() {
                Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => Self::Busy { path },
                Some(ErrorCode::DiskFull) => Self::Full { path },
                Some(ErrorCode::ReadOnly) => Self::ReadOnly { path },
                Some(ErrorCode::NotADatabase) => Self::Other { path },
                Some(
                    ErrorCode::CannotOpen
                    | ErrorCode::PermissionDenied
                    | ErrorCode::OutOfMemory
                    | ErrorCode::OperationInterrupted
                    | ErrorCode::TooBig,
                ) => Self::Database { path, source },
                Some(ErrorCode::SystemIoFailure) if !is_short(&source) => {
                    Self::Database { path, source }
                }
                // Statements and types are right for a file of this schema, so the file is not what it should be.
                _ => Self::Damaged {
                    path,
                    message: match source {
                        rusqlite::Error::QueryReturnedNoRows => "a row is missing".to_owned(),
                        source => source.to_string(),
                    },
                },
            }
        }
    }

    pub(crate) fn damaged(path: &Path, message: impl Into<String>) -> Self {
        Self::Damaged {
            path: path.to_owned(),
            message: message.into(),
        }
    }

    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io {
            action,
            path,
            source,
        }
    }
}

/// Returns true if a file ends before a page that it should have.
fn is_short(error: &rusqlite::Error) -> bool {
    error.sqlite_error().map(|error| error.extended_code)
        == Some(rusqlite::ffi::SQLITE_IOERR_SHORT_READ)
}
