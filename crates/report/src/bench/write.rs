//! Writing the reports of a bench.

use super::benchmarks::benchmarks;
use super::figures::Figures;
use super::page;
use crate::error::ReportError;
use crate::files::replace;
use crate::matrix::{self, Matrix};
use etalon_dashboards::{ACTION_FILE, BENCHER_FILE};
use etalon_record::Bench;
use std::path::{Path, PathBuf};

/// The files that [`write_bench`] writes.
pub const BENCH_FILES: [&str; 5] = [HTML, BENCHER_FILE, ACTION_FILE, MATRIX, MATRIX_CSV];
const HTML: &str = "index.html";
const MATRIX: &str = "matrix.html";
const MATRIX_CSV: &str = "matrix.csv";

/// The files that [`write_bench`] made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenBench {
    /// The page.
    pub html: PathBuf,
    /// Wall times in Bencher's metric format.
    pub bencher: PathBuf,
    /// Wall times for github-action-benchmark, tool `customSmallerIsBetter`.
    pub action: PathBuf,
    /// The page of the performance matrix and its cells as CSV, of a bench that has cells.
    pub matrix: Option<[PathBuf; 2]>,
}

/// Writes `index.html`, `bencher.json` and `benchmark-action.json` into a bench folder, and `matrix.html` and
/// `matrix.csv` where it has cells of the performance matrix. Each is
/// written beside its place and then renamed, so that a reader never sees half a report.
///
/// # Errors
/// Returns an error if the folder holds no readable bench, or cannot be written to.
pub fn write_bench(folder: &Path) -> Result<WrittenBench, ReportError> {
    let bench = Bench::read(folder)?;
    let figures = Figures::new(&bench);
    let html = page::page(&bench, &figures);
    let matrix = Matrix::new(&bench);
    let benchmarks = benchmarks(&figures);
    let bencher = etalon_dashboards::bencher(&benchmarks).map_err(ReportError::Json)?;
    let action = etalon_dashboards::action(&benchmarks).map_err(ReportError::Json)?;
    Ok(WrittenBench {
        html: replace(folder, HTML, html.as_bytes())?,
        bencher: replace(folder, BENCHER_FILE, &bencher)?,
        action: replace(folder, ACTION_FILE, &action)?,
        matrix: match matrix.cells.is_empty() {
            true => None,
            false => Some([
                replace(folder, MATRIX, matrix::page(&matrix).as_bytes())?,
                replace(folder, MATRIX_CSV, matrix::csv(&matrix).as_bytes())?,
            ]),
        },
    })
}
