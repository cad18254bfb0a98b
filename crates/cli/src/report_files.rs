//! The reports of a folder: removed with the run or the bench that they were made from.

use etalon_record::ReportFiles;

/// The reports of a run.
pub(crate) const RUN: ReportFiles = ReportFiles {
    files: &etalon_report::RUN_FILES,
    folders: &etalon_report::RUN_FOLDERS,
};

/// The reports of a bench.
pub(crate) const BENCH: ReportFiles = ReportFiles {
    files: &etalon_report::BENCH_FILES,
    folders: &[],
};
