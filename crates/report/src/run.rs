//! The report of a run: `index.html` and the summary for a terminal.

mod beside;
mod blind;
mod dead;
pub(crate) mod grid;
mod index;
mod reasons;
mod sample;
mod table;
pub(crate) mod unexpected;
mod write;

pub use dead::dead_lines;
pub use sample::{RecordLine, record_html};
pub use table::table;
pub use write::{RunReport, RunReports, write};
