//! Hunts for planted bugs: `mutants.html` and the summary for a terminal.

mod page;
mod summary;
mod table;
mod write;

pub use table::hunt_table;
pub use write::{WrittenHunt, write_hunt};
