//! Reports of one run: `index.html` and the summary for a terminal.

pub(crate) mod grid;
pub(crate) mod index;
pub(crate) mod table;
