//! Pages, files for other programs and terminal tables, made from a recorded folder alone.
//!
//! [`write()`] writes the reports of a run into its folder, [`table()`] is its summary for a terminal.
//! [`write_hunt`] and [`hunt_table`] do the same for planted bugs, [`write_bench`] and [`bench_table`]
//! for frame times. [`runs`] compares two runs, [`diff()`] two benches. A report holds nothing that the
//! folder and the [`RunNews`] against a history do not, so that an old run can be reported again.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bench;
mod catalogue;
mod chart;
mod command;
mod csv;
mod diff;
mod error;
mod export;
mod files;
#[cfg(feature = "history")]
mod history;
mod hunt;
mod innocents;
mod lists;
mod mark;
mod matrix;
mod methods;
mod news;
mod numbers;
mod page;
mod picture;
mod run;
mod sighting;
mod site;
mod staged;
mod table;
mod terminal;
mod threads;
mod versions;
mod words;

pub use bench::{WrittenBench, bench_table, write_bench};
pub use catalogue::{Catalogue, CatalogueCase, reference_png};
pub use command::quoted;
pub use diff::benches::{
    BenchDiff, BenchIdentity, InstructionChange, InstructionOutcome, OutcomeCounts, TimeChange,
    Untimed, diff, diff_table, write_diff,
};
pub use diff::runs;
pub use error::ReportError;
#[cfg(feature = "history")]
pub use history::{HISTORY_PAGE_FILE, write_history};
pub use hunt::{HUNT_PAGE, WrittenHunt, hunt_table, write_hunt};
pub use matrix::matrix_table;
pub use methods::{MethodPoint, method_points, methods_html};
pub use news::{NewsEntry, RunNews, Since, news_table};
pub use picture::{Ringed, Thumbnails, ringed_pictures};
pub use run::{RecordLine, RunReport, RunReports, dead_lines, record_html, table, write};
pub use site::{CasesOf, SITE_FILE, write_site};
pub use staged::WrittenFolder;
pub use terminal::TableOptions;
pub use versions::{VERSIONS_PAGE, versions_table, write_versions};
pub use words::{
    ReducedCase, api_name, conclusion, judged_by, message, operations_text, plain, reasons_text,
    sentence, story_text,
};
