//! Benches: the page, the files for dashboards and the summary for a terminal, computed from the recorded
//! samples each time, so that a bench can be reported anew by a later version.

mod charts;
pub(crate) mod figures;
mod page;
mod table;
mod write;

pub use table::bench_table;
pub use write::{BENCH_FILES, WrittenBench, write_bench};
