//! Errors of exports.

use etalon_history::HistoryError;
use etalon_record::RecordError;
use parquet::errors::ParquetError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason why a history could not be exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The history cannot be read.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// The selection contains no run of the history.
    #[error("{} holds no such run; `etalon history add RUN` adds one, and `etalon history show` lists them", path.display())]
    NoRuns {
        /// The history.
        path: PathBuf,
    },
    /// The chosen runs have no frame times.
    #[error("the chosen runs of {} have no frame times to export; `etalon bench` measures them", path.display())]
    NoTimes {
        /// The history.
        path: PathBuf,
    },
    /// The folder is not empty.
    #[error("{} is not empty; name another folder, or remove it first", path.display())]
    NotEmpty {
        /// The folder.
        path: PathBuf,
    },
    /// The folder cannot be made.
    #[error(transparent)]
    Folder(#[from] RecordError),
    /// The system refused to write.
    #[error("cannot write {}: {source}; check the permissions and the free space, or name another folder", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A value has no JSON form.
    #[error("cannot write {} as JSON: {source}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// The writer's error.
        source: serde_json::Error,
    },
    /// A table could not be written.
    #[error("cannot write {}: {source}; check the permissions and the free space, or name another folder", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// The writer's error.
        source: ParquetError,
    },
}

impl ExportError {
    pub(crate) fn io(path: &Path) -> impl Fn(io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Io {
            path: path.clone(),
            source,
        }
    }

    pub(crate) fn table(path: &Path) -> impl Fn(ParquetError) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Table {
            path: path.clone(),
            source,
        }
    }
}
