//! The error of every report.

#[cfg(feature = "history")]
use etalon_history::HistoryError;
use etalon_record::RecordError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason why a report could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The run could not be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A report could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A source file of a report could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A folder for a site has no page.
    #[error("{0} holds no page; `etalon report {0}` writes the pages of a run or bench, `ci/page {0}` the suite as a page", path.display())]
    NoPage {
        /// The folder.
        path: PathBuf,
    },
    /// The folder for pages already has such pages.
    #[error("{} holds a {kind}; --force replaces it", path.display())]
    HasPages {
        /// The folder.
        path: PathBuf,
        /// The kind of pages.
        kind: &'static str,
    },
    /// A folder for pages has other files.
    #[error("{} is not empty and holds no {kind}; name another folder", path.display())]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// The kind of pages.
        kind: &'static str,
    },
    /// A file in a folder of pages does not belong to them.
    #[error("{} does not belong to the {kind} and would be lost; move it", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The kind of pages.
        kind: &'static str,
    },
    /// A recorded folder is inside the site, or the site is inside it.
    #[error("{} and {} must not contain each other; name another folder for the site", site.display(), folder.display())]
    Within {
        /// The site.
        site: PathBuf,
        /// The recorded folder.
        folder: PathBuf,
    },
    /// A history could not be read.
    #[cfg(feature = "history")]
    #[error(transparent)]
    History(#[from] HistoryError),
    /// A history has no run with these labels.
    #[error("{} holds no such run; `etalon history add RUN` adds one, and `etalon history show` lists them", path.display())]
    NoRuns {
        /// The file.
        path: PathBuf,
    },
    /// The JUnit report could not be written as XML.
    #[error("cannot write the JUnit report: {0}")]
    Junit(#[from] quick_junit::SerializeError),
    /// A report could not be written as JSON.
    #[error("cannot write a report as JSON: {0}")]
    Json(serde_json::Error),
    /// The path of a report does not end in a file name.
    #[error("{} names no file", path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
    /// The run lacks the requested adapter.
    #[error("{} has no adapter {adapter}; it has {known}", path.display())]
    NoAdapter {
        /// The run folder.
        path: PathBuf,
        /// The requested adapter.
        adapter: String,
        /// The adapters of the run.
        known: String,
    },
    /// Two runs have no adapter of the same name.
    #[error(
        "the runs have no adapter of the same name: {before} before, {after} after; name the two to compare \
         with --adapter-before and --adapter-after"
    )]
    NoCommonAdapter {
        /// The adapters of the first run.
        before: String,
        /// The adapters of the second run.
        after: String,
    },
}

impl ReportError {
    /// Returns a conversion of the system's error for a file that cannot be written.
    pub(crate) fn unwritten(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }

    /// Returns a conversion of the system's error for a file that cannot be read.
    pub(crate) fn unread(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Unread {
            path: path.to_owned(),
            source,
        }
    }
}
