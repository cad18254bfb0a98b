//! Pages, files for other programs and terminal tables, made from a run folder alone.
//!
//! [`write()`] puts `index.html`, `junit.xml`, `ctrf.json`, `summary.md` and deqp-runner's lists beside a
//! recorded run, and `methods.html` where it drew methods; [`table()`] is the summary for a terminal.
//! [`write_hunt`] and [`hunt_table`] do the same for planted bugs, [`write_bench`], [`bench_table`] and
//! [`diff()`] for frame times; [`runs`] holds two runs against each other. None of them knows anything
//! that the folder does not tell.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bench;
mod chart;
mod diff;
mod export;
mod hunt;
mod methods;
mod picture;
mod run;
mod words;

pub use bench::{WrittenBench, bench_table, diff_table, write_bench};
pub use diff::benches::compare::{Change, Diff, Gone, Side, diff};
pub use diff::benches::page::write_diff;
pub use diff::runs;
pub use hunt::{WrittenHunt, hunt_table, write_hunt};
pub use run::index::quoted;
pub use run::table::{TableOptions, table};

use etalon_record::{RecordError, Run};
use export::{ctrf, deqp, junit, markdown};
use run::grid::Grid;
use run::index;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reports that [`write()`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page for people.
    pub html: PathBuf,
    /// The page of methods, where the run has any.
    pub methods: Option<PathBuf>,
    /// The JUnit file, for continuous integration.
    pub junit: PathBuf,
    /// The run in the Common Test Report Format.
    pub ctrf: PathBuf,
    /// The summary in Markdown for a job's page, of less than 1,000,000 bytes.
    pub summary: PathBuf,
    /// deqp-runner's `results.csv`, one per adapter.
    pub results: Vec<PathBuf>,
}

impl Written {
    /// Every file, the page for people first.
    pub fn all(&self) -> impl Iterator<Item = &Path> {
        let single = [
            Some(&self.html),
            self.methods.as_ref(),
            Some(&self.junit),
            Some(&self.ctrf),
            Some(&self.summary),
        ];
        let all = single.into_iter().flatten().chain(&self.results);
        all.map(PathBuf::as_path)
    }
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
    /// A run was asked for an adapter that it does not have.
    #[error("{} has no adapter {adapter}; it has {known}", path.display())]
    NoAdapter {
        /// The run folder.
        path: PathBuf,
        /// The adapter.
        adapter: String,
        /// Those that it has.
        known: String,
    },
    /// Two runs have no adapter of the same name.
    #[error(
        "the runs have no adapter of the same name: {before} before, {after} after; say which are to be \
         held against each other with --adapter-before and --adapter-after"
    )]
    NoCommonAdapter {
        /// The first run's.
        before: String,
        /// The second run's.
        after: String,
    },
}

/// Writes the reports of a run into its folder: `index.html`, `junit.xml`, `ctrf.json`, `summary.md`,
/// `results/<adapter>.csv`, and `methods.html` where it has records of methods. Each is written beside
/// its place and then renamed, so that a reader never sees half a report.
///
/// # Errors
/// When the folder holds no readable run, or cannot be written to. A frame file that is missing or
/// damaged is no error: the page says so in its place.
pub fn write(folder: &Path) -> Result<Written, ReportError> {
    let run = Run::read(folder)?;
    let found = methods::Methods::of(&run);
    let page = index::page(folder, &run, found.as_ref());
    let html = replace(folder, "index.html", page.as_bytes())?;
    let methods = match &found {
        Some(found) => {
            let page = methods::page(folder, &run, found);
            Some(replace(folder, methods::PAGE, page.as_bytes())?)
        }
        None => None,
    };
    let grid = Grid::new(&run);
    let junit = replace(folder, "junit.xml", junit::xml(&run, &grid)?.as_bytes())?;
    let ctrf = replace(folder, "ctrf.json", &ctrf::json(&run, &grid)?)?;
    let summary = replace(folder, "summary.md", markdown::summary(&run).as_bytes())?;
    let results = lists(folder, &run, &grid)?;
    Ok(Written {
        html,
        methods,
        junit,
        ctrf,
        summary,
        results,
    })
}

/// deqp-runner's lists, in a folder of their own.
fn lists(folder: &Path, run: &Run, grid: &Grid<'_>) -> Result<Vec<PathBuf>, ReportError> {
    let below = folder.join(deqp::FOLDER);
    fs::create_dir_all(&below).map_err(|source| ReportError::Io {
        path: below.clone(),
        source,
    })?;
    let lists = deqp::lists(folder, run, grid).into_iter();
    lists
        .map(|list| replace(&below, &list.name, list.text.as_bytes()))
        .collect()
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
