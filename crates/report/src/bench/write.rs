//! Writing the reports of a bench.

use super::figures::{CaseFigures, TimedCase, figures};
use super::page;
use crate::error::ReportError;
use crate::files::Destination;
use crate::matrix::{self, Matrix};
use crate::numbers::change;
use etalon_dashboards::{ACTION_FILE, BENCHER_FILE, Benchmark, Figure, nanoseconds};
use etalon_record::{Bench, FolderKind, OutputFolder, Time};
use etalon_stats::Summary;
use std::path::{Path, PathBuf};

const HTML: &str = "index.html";
const MATRIX: &str = "matrix.html";
const MATRIX_CSV: &str = "matrix.csv";

/// The files that [`write_bench`] wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenBench {
    /// The page of the bench, `index.html`.
    pub html: PathBuf,
    /// Wall times in Bencher's metric format.
    pub bencher: PathBuf,
    /// Wall times for github-action-benchmark, tool `customSmallerIsBetter`.
    pub action: PathBuf,
    /// The page of the performance matrix and its cells as CSV; `None` if the bench has no cells.
    pub matrix: Option<[PathBuf; 2]>,
}

/// Writes `index.html`, `bencher.json` and `benchmark-action.json` into a bench folder, and `matrix.html` and
/// `matrix.csv` if it has cells of the performance matrix. Each is written to a temporary file and then
/// renamed, so a reader never sees half a report.
///
/// # Errors
/// Returns an error if the folder holds no readable bench, or cannot be written to.
pub fn write_bench(folder: &Path) -> Result<WrittenBench, ReportError> {
    let bench = Bench::read(folder)?;
    let out = OutputFolder::open(folder)?;
    out.check_reports(FolderKind::Bench)?;
    write_bench_to(&out, &bench)
}

/// Writes the reports of a bench, as [`write_bench`] does.
pub(crate) fn write_bench_to(
    to: &dyn Destination,
    bench: &Bench,
) -> Result<WrittenBench, ReportError> {
    let figures = figures(bench);
    let html = page::page(bench, &figures);
    let matrix = Matrix::new(bench);
    let benchmarks = benchmarks(&figures);
    let bencher = etalon_dashboards::bencher(&benchmarks).map_err(ReportError::Json)?;
    let action = etalon_dashboards::action(&benchmarks).map_err(ReportError::Json)?;
    Ok(WrittenBench {
        html: to.write(HTML, html.as_bytes())?,
        bencher: to.write(BENCHER_FILE, &bencher)?,
        action: to.write(ACTION_FILE, &action)?,
        matrix: if matrix.cells.is_empty() {
            None
        } else {
            Some([
                to.write(MATRIX, matrix::page(&matrix).as_bytes())?,
                to.write(MATRIX_CSV, matrix::csv(&matrix).as_bytes())?,
            ])
        },
    })
}

/// Returns all timed cases and adapters, in the order of the figures.
fn benchmarks(figures: &[CaseFigures<'_>]) -> Vec<Benchmark> {
    let each = |(case, timed): (&str, &TimedCase<'_>)| {
        let wall = [(Time::Wall, figure(&timed.wall))].into_iter();
        let others = timed.others.iter().map(|(time, s)| (*time, figure(s)));
        Benchmark {
            // Ids and adapter names contain no spaces.
            name: format!("{case} {}", timed.adapter()),
            times: wall.chain(others).collect(),
            extra: extra(timed),
        }
    };
    let timed = figures.iter().flat_map(|figures| {
        let adapters = figures.timed.iter().flatten();
        adapters.map(|timed| (figures.case, timed))
    });
    timed.map(each).collect()
}

fn figure(summary: &Summary) -> Figure {
    Figure {
        median: summary.median,
        interval: summary.interval,
    }
}

fn extra(timed: &TimedCase<'_>) -> String {
    let s = &timed.wall;
    let visible = s.visible.map_or_else(
        || "no change is visible with so few rounds".to_owned(),
        |v| format!("smallest visible change {}", change(v)),
    );
    format!(
        "{} rounds, {} samples, {} discarded as warm-up\np50 {} ns, p95 {} ns\n{visible}",
        s.rounds,
        s.samples,
        timed.record.discarded(),
        nanoseconds(s.p50),
        nanoseconds(s.p95),
    )
}
