//! One run: `index.html` and the summary for a terminal.

pub(crate) mod grid;
mod index;
mod table;
pub(crate) mod unexpected;
mod write;

pub use table::table;
pub use write::{RUN_FILES, RUN_FOLDERS, Written, write};
