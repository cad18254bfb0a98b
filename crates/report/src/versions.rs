//! Cases over the releases of one driver: `versions.html` and the summary for a terminal.

mod groups;
mod page;
mod table;
mod write;

pub use table::versions_table;
pub use write::write_versions;
