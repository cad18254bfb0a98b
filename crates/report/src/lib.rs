//! HTML, JUnit and terminal reports, made from a run folder alone.
//!
//! [`write()`] puts `index.html` and `junit.xml` beside a recorded run, and `methods.html` where it drew
//! methods; [`table()`] is the summary for a terminal. [`write_hunt`] and [`hunt_table`] do the same for
//! planted bugs, [`write_bench`], [`bench_table`] and [`diff()`] for frame times. None of them knows
//! anything that the folder does not tell.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bench;
mod grid;
mod html;
mod hunt;
mod junit;
mod methods;
mod picture;
mod table;
mod words;

pub use bench::{
    Change, Diff, Gone, Side, WrittenBench, bench_table, diff, diff_table, write_bench, write_diff,
};
pub use hunt::{WrittenHunt, hunt_table, write_hunt};
pub use table::{TableOptions, table};

use etalon_record::{RecordError, Run};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reports that [`write()`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page for people.
    pub html: PathBuf,
    /// The file for continuous integration.
    pub junit: PathBuf,
    /// The page of methods, where the run has any.
    pub methods: Option<PathBuf>,
}

/// Why a report could not be made.
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
        /// The system's word.
        source: io::Error,
    },
    /// The JUnit report has no XML form.
    #[error("cannot write the JUnit report: {0}")]
    Junit(#[from] quick_junit::SerializeError),
    /// A file for a dashboard has no JSON form.
    #[error("cannot write a report as JSON: {0}")]
    Json(serde_json::Error),
    /// A report was to be written to what is no file's name.
    #[error("{} names no file", path.display())]
    NoFile {
        /// The path.
        path: PathBuf,
    },
}

/// Writes `index.html` and `junit.xml` into a run folder, and `methods.html` where it has records of
/// methods. Each is written beside its place and then
/// renamed, so that a reader never sees half a report.
///
/// # Errors
/// When the folder holds no readable run, or cannot be written to. A frame file that is missing or
/// damaged is no error: the page says so in its place.
pub fn write(folder: &Path) -> Result<Written, ReportError> {
    let run = Run::read(folder)?;
    let found = methods::Methods::of(&run);
    let page = html::page(folder, &run, found.as_ref());
    let html = replace(folder, "index.html", page.as_bytes())?;
    let methods = match &found {
        Some(found) => {
            let page = methods::page(folder, &run, found);
            Some(replace(folder, methods::PAGE, page.as_bytes())?)
        }
        None => None,
    };
    let junit = replace(folder, "junit.xml", junit::xml(&run)?.as_bytes())?;
    Ok(Written {
        html,
        junit,
        methods,
    })
}

fn replace(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    let beside = folder.join(format!(".{name}.{}", std::process::id()));
    let result = fs::write(&beside, bytes).and_then(|()| fs::rename(&beside, &path));
    match result {
        Ok(()) => Ok(path),
        Err(source) => {
            // Best effort: the first error is the one to tell.
            let _ = fs::remove_file(&beside);
            Err(ReportError::Io { path, source })
        }
    }
}
