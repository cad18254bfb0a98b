//! Writing the reports of a run.

use super::grid::RunGrid;
use super::index::{self, INDEX, PageParts, RECORDS};
use crate::catalogue::{CATALOGUE, Catalogue, write_scripts};
use crate::error::ReportError;
use crate::export::{deqp, junit, markdown};
use crate::files::Destination;
use crate::methods::{self, Methods};
use crate::news::RunNews;
use etalon_frame::threads::join;
use etalon_record::{Bench, Dead, FolderKind, OutputFolder, Run, TIMED_FOLDER};
use std::path::{Path, PathBuf};

const JUNIT: &str = "junit.xml";
const SUMMARY: &str = "summary.md";

/// The reports that [`write()`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunReports {
    /// The page of the run, `index.html`.
    pub html: PathBuf,
    /// The page of methods, if the run has any.
    pub methods: Option<PathBuf>,
    /// The JUnit file, for continuous integration.
    pub junit: PathBuf,
    /// The summary in Markdown for a job's page, of less than 1,000,000 bytes.
    pub summary: PathBuf,
    /// deqp-runner's `results.csv`, one per adapter, if asked for.
    pub results: Vec<PathBuf>,
    /// The pages and scripts, as paths below the folder.
    pub(crate) views: Vec<String>,
}

impl RunReports {
    /// Returns every file, the page for people first.
    pub fn all(&self) -> impl Iterator<Item = &Path> {
        let single = [
            Some(&self.html),
            self.methods.as_ref(),
            Some(&self.junit),
            Some(&self.summary),
        ];
        let files = single.into_iter().flatten().chain(&self.results);
        files.map(PathBuf::as_path)
    }
}

/// The sources of the reports of a run.
#[derive(Clone, Copy, Debug)]
pub struct RunReport<'a> {
    /// The run folder, for frames, pictures and dead expectations.
    pub folder: &'a Path,
    /// The run. [`RunNews::settle`] gives the one in which what triage settled does not count.
    pub run: &'a Run,
    /// The cases, for the pages of single cases; `None` if they are unknown.
    pub catalogue: Option<&'a Catalogue>,
    /// The changes since the last run, which the page and the summary tell first.
    pub news: Option<&'a RunNews>,
    /// True to write `results/<adapter>.csv` in deqp-runner's format. It repeats what `junit.xml` says. A folder that
    /// has it gets it anew anyway, so that no file in it is older than the others.
    pub deqp: bool,
}

/// Reads the run in a folder and writes its reports in every format, without pages of single cases.
///
/// # Errors
/// Returns an error if the folder holds no readable run, or cannot be written to.
pub fn write(folder: &Path) -> Result<RunReports, ReportError> {
    RunReport {
        folder,
        run: &Run::read(folder)?,
        catalogue: None,
        news: None,
        deqp: true,
    }
    .write()
}

impl RunReport<'_> {
    /// Writes the reports into the run folder: `index.html`, `details.html`, scripts of the records, `junit.xml`, `summary.md`, `methods.html` if the run
    /// has records of methods, scripts of the cases, and deqp-runner's lists if they are asked for or already there.
    /// Pages and scripts of earlier reports are removed.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written to or its list of dead expectations cannot be read. A
    /// frame file that is missing or damaged is not an error: the page names it.
    pub fn write(&self) -> Result<RunReports, ReportError> {
        let out = OutputFolder::open(self.folder)?;
        // A page of somebody else under a name of ours would look like a report.
        out.check_reports(FolderKind::Run)?;
        let written = self.write_to(&out)?;
        let is_view = |name: &str| {
            let within = |folder| {
                name.strip_prefix(folder)
                    .is_some_and(|rest: &str| rest.starts_with('/'))
            };
            name.ends_with(".html") || within(CATALOGUE) || within(RECORDS)
        };
        out.retain(|name| !is_view(name) || written.views.iter().any(|view| view == name))?;
        Ok(written)
    }

    /// Writes the reports, as [`RunReport::write`] does.
    pub(crate) fn write_to(&self, to: &dyn Destination) -> Result<RunReports, ReportError> {
        let found = Methods::of(self.run);
        let dead = Dead::read(self.folder)?;
        let timed = self.folder.join(TIMED_FOLDER);
        let timed = match FolderKind::of(&timed) {
            Some(FolderKind::Bench) => Some(Bench::read(&timed)?),
            _ => None,
        };
        let scripts = match self.catalogue {
            Some(catalogue) => write_scripts(to, catalogue)?,
            None => Vec::new(),
        };
        // The pages read frames and take as long as all others together.
        let (pages, others) = join(
            || {
                let parts = PageParts {
                    scripts: &scripts,
                    dead: &dead,
                    methods: found.as_ref(),
                    news: self.news,
                    timed: timed.as_ref(),
                };
                index::write(to, self.folder, self.run, &parts)
            },
            || self.others(to, found.as_ref()),
        );
        let (pages, mut others) = (pages?, others?);
        others.views.extend(pages);
        others
            .views
            .extend(scripts.into_iter().map(|(_, path)| path));
        Ok(others)
    }

    /// Writes all reports except the pages and their scripts.
    fn others(
        &self,
        to: &dyn Destination,
        found: Option<&Methods<'_>>,
    ) -> Result<RunReports, ReportError> {
        let Self { folder, run, .. } = *self;
        let mut views = Vec::new();
        let methods = match found {
            Some(found) => {
                let page = methods::page(folder, run, found);
                views.push(methods::PAGE.to_owned());
                let page = to.write(methods::PAGE, page.as_bytes())?;
                let points = methods::csv(&methods::method_points(run));
                to.write(methods::POINTS, points.as_bytes())?;
                Some(page)
            }
            None => None,
        };
        let grid = RunGrid::new(run);
        let junit = to.write(JUNIT, junit::xml(run, &grid)?.as_bytes())?;
        let summary = to.write(SUMMARY, markdown::summary(run, self.news).as_bytes())?;
        let results = if self.deqp || folder.join(deqp::FOLDER).exists() {
            let lists = deqp::lists(folder, run, &grid).into_iter();
            let write = |list: deqp::CaseList| {
                to.write(
                    &format!("{}/{}", deqp::FOLDER, list.name),
                    list.text.as_bytes(),
                )
            };
            lists.map(write).collect::<Result<_, _>>()?
        } else {
            Vec::new()
        };
        Ok(RunReports {
            html: folder.join(INDEX),
            methods,
            junit,
            summary,
            results,
            views,
        })
    }
}
