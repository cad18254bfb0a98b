//! The report files of each kind of folder, which are removed together with the records that they were made
//! from.

use crate::failure_groups::Folders;
use etalon_record::{FolderKind, ReportFiles};

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

/// The case files of a search over random scenes.
pub(crate) const FUZZ: ReportFiles = ReportFiles {
    files: &[],
    folders: &[(Folders::FOUND, "json"), (Folders::KNOWN, "json")],
};

/// The table of a hunt with random scenes.
pub(crate) const RECALL: &str = "recall.txt";

/// Returns the reports of a kind of folder.
pub(crate) fn of(kind: FolderKind) -> ReportFiles {
    match kind {
        FolderKind::Run => RUN,
        FolderKind::Bench => BENCH,
        FolderKind::Fuzz => FUZZ,
        FolderKind::Versions => ReportFiles {
            files: &[etalon_report::VERSIONS_PAGE],
            folders: &[],
        },
        FolderKind::Hunt => ReportFiles {
            files: &[etalon_report::HUNT_PAGE, RECALL],
            folders: &[],
        },
    }
}
