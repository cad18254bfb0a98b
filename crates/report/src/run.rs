//! The report of a run: `index.html` and the summary for a terminal.

mod bad_ends;
mod dead;
pub(crate) mod grid;
mod index;
mod reasons;
mod sample;
mod table;
pub(crate) mod unexpected;
mod write;

pub use bad_ends::bad_end_lines;
pub use dead::dead_lines;
pub use sample::{RecordLine, record_html};
pub use table::table;
pub use write::{OtherFormats, RunReport, RunReports, write};
