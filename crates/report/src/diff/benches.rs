//! The comparison of two benches: as data, for a terminal, and as a page.

mod compare;
mod instructions;
mod notes;
mod page;
mod phrases;
mod table;

pub use compare::{BenchDiff, BenchIdentity, OutcomeCounts, TimeChange, Untimed, diff};
pub use instructions::{InstructionChange, InstructionOutcome};
pub use page::write_diff;
pub use table::diff_table;
