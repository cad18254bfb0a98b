//! Writing the reports of a run.

use super::grid::Grid;
use super::index;
use crate::catalogue::CATALOGUE;
use crate::error::ReportError;
use crate::export::{ctrf, deqp, junit, markdown};
use crate::files::{make, replace};
use crate::methods::{self, Methods};
use crate::news::News;
use etalon_frame::threads::join;
use etalon_record::{Dead, Run};
use std::path::{Path, PathBuf};

/// The files that [`write()`] may write into a run folder.
pub const RUN_FILES: [&str; 5] = [HTML, methods::PAGE, JUNIT, CTRF, SUMMARY];
/// The folders that [`write()`] writes into a run folder, each with the extension of its files.
pub const RUN_FOLDERS: [(&str, &str); 2] = [(deqp::FOLDER, "csv"), (CATALOGUE, "js")];
const HTML: &str = "index.html";
const JUNIT: &str = "junit.xml";
const CTRF: &str = "ctrf.json";
const SUMMARY: &str = "summary.md";

/// The reports that [`write()`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunReports {
    /// The page.
    pub html: PathBuf,
    /// The page of methods, if the run has any.
    pub methods: Option<PathBuf>,
    /// The JUnit file, for continuous integration.
    pub junit: PathBuf,
    /// The run in the Common Test Report Format, if asked for.
    pub ctrf: Option<PathBuf>,
    /// The summary in Markdown for a job's page, of less than 1,000,000 bytes.
    pub summary: PathBuf,
    /// deqp-runner's `results.csv`, one per adapter, if asked for.
    pub results: Vec<PathBuf>,
}

impl RunReports {
    /// Every file, the page for people first.
    pub fn all(&self) -> impl Iterator<Item = &Path> {
        let single = [
            Some(&self.html),
            self.methods.as_ref(),
            Some(&self.junit),
            self.ctrf.as_ref(),
            Some(&self.summary),
        ];
        let files = single.into_iter().flatten().chain(&self.results);
        files.map(PathBuf::as_path)
    }
}

/// Files for other test systems. They repeat what `junit.xml` says, and are as large as a quarter of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OtherFormats {
    /// `ctrf.json`, in the Common Test Report Format.
    pub ctrf: bool,
    /// `results/<adapter>.csv`, in deqp-runner's format.
    pub deqp: bool,
}

impl OtherFormats {
    /// Every format.
    pub const ALL: Self = Self {
        ctrf: true,
        deqp: true,
    };

    /// These formats and any that the folder already has, so that no file in it is older than the others.
    fn with_those_of(self, folder: &Path) -> Self {
        Self {
            ctrf: self.ctrf || folder.join(CTRF).exists(),
            deqp: self.deqp || folder.join(deqp::FOLDER).exists(),
        }
    }
}

/// Reads the run in a folder and writes its reports in every format, as [`write_run_with_news`] does.
///
/// # Errors
/// Returns an error if the folder holds no readable run, or cannot be written to.
pub fn write(folder: &Path) -> Result<RunReports, ReportError> {
    write_run_with_news(folder, &Run::read(folder)?, None, OtherFormats::ALL)
}

/// Writes the reports of a run into its folder: `index.html`, `junit.xml`, `summary.md`, `methods.html` if the
/// run has records of methods, and the other formats that are asked for or already there. Each is written to
/// a temporary file and then renamed, so that a reader never sees half a report.
///
/// The page and the summary of a run that was compared with the last run tell news first. [`News::settle`] gives the run in
/// which what triage settled does not count.
///
/// # Errors
/// Returns an error if the folder cannot be written to or its list of dead expectations cannot be read. A frame
/// file that is missing or damaged is not an error: the page names it.
pub fn write_run_with_news(
    folder: &Path,
    run: &Run,
    news: Option<&News>,
    formats: OtherFormats,
) -> Result<RunReports, ReportError> {
    let found = Methods::of(run);
    let dead = Dead::read(folder)?;
    // The page reads frames and takes as long as all others together.
    let (html, others) = join(
        || {
            let page = index::page(folder, run, &dead, found.as_ref(), news);
            replace(folder, HTML, page.as_bytes())
        },
        || {
            others(
                folder,
                run,
                found.as_ref(),
                news,
                formats.with_those_of(folder),
            )
        },
    );
    Ok(RunReports {
        html: html?,
        ..others?
    })
}

/// Writes all reports except the page, and returns the page's path too.
fn others(
    folder: &Path,
    run: &Run,
    found: Option<&Methods<'_>>,
    news: Option<&News>,
    formats: OtherFormats,
) -> Result<RunReports, ReportError> {
    let methods = match found {
        Some(found) => {
            let page = methods::page(folder, run, found);
            Some(replace(folder, methods::PAGE, page.as_bytes())?)
        }
        None => None,
    };
    let grid = Grid::new(run);
    let junit = replace(folder, JUNIT, junit::xml(run, &grid)?.as_bytes())?;
    let ctrf = if formats.ctrf {
        Some(replace(folder, CTRF, &ctrf::json(run, &grid)?)?)
    } else {
        None
    };
    let summary = replace(folder, SUMMARY, markdown::summary(run, news).as_bytes())?;
    let results = if formats.deqp {
        lists(folder, run, &grid)?
    } else {
        Vec::new()
    };
    Ok(RunReports {
        html: folder.join(HTML),
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
    make(&below)?;
    let lists = deqp::lists(folder, run, grid).into_iter();
    lists
        .map(|list| replace(&below, &list.name, list.text.as_bytes()))
        .collect()
}
