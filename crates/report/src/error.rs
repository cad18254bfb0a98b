//! The error of every report.

use etalon_history::HistoryError;
use etalon_record::RecordError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason for which a report could not be made.
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
    /// A file that a report is made from could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A folder for a site holds no page.
    #[error("{0} holds no page; `etalon report {0}` writes those of a run or bench", path.display())]
    NoPage {
        /// The folder.
        path: PathBuf,
    },
    /// The folder for a site holds one.
    #[error("{} holds a site; --force replaces it", path.display())]
    HasSite {
        /// The folder.
        path: PathBuf,
    },
    /// A folder for pages holds something else.
    #[error("{} is not empty and holds no {kind}; name another folder", path.display())]
    Occupied {
        /// The folder.
        path: PathBuf,
        /// The kind of pages.
        kind: &'static str,
    },
    /// A file in a folder of pages that is not of it.
    #[error("{} is not of the {kind} and would be lost; move it", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// The kind of pages.
        kind: &'static str,
    },
    /// A recorded folder lies in the site, or the site in it.
    #[error("{} and {} must not lie one in the other; name another folder for the site", site.display(), folder.display())]
    Within {
        /// The site.
        site: PathBuf,
        /// The recorded folder.
        folder: PathBuf,
    },
    /// A history could not be read.
    #[error(transparent)]
    History(#[from] HistoryError),
    /// A history has no run of these labels.
    #[error("{} holds no such run; `etalon history add RUN` adds one, and `etalon history show` lists them", path.display())]
    NoRuns {
        /// The file.
        path: PathBuf,
    },
    /// The JUnit report has no XML form.
    #[error("cannot write the JUnit report: {0}")]
    Junit(#[from] quick_junit::SerializeError),
    /// A report has no JSON form.
    #[error("cannot write a report as JSON: {0}")]
    Json(serde_json::Error),
    /// The path of a report does not end in a file name.
    #[error("{} names no file", path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
    /// The run does not have the adapter that was asked for.
    #[error("{} has no adapter {adapter}; it has {known}", path.display())]
    NoAdapter {
        /// The run folder.
        path: PathBuf,
        /// The adapter that was asked for.
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
    /// The error of a file that cannot be written.
    pub(crate) fn unwritten(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }

    /// The error of a file that cannot be read.
    pub(crate) fn unread(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Unread {
            path: path.to_owned(),
            source,
        }
    }
}
