//! Reports of a bench: the page, the files for dashboards and the summary for a terminal. All are computed
//! from the recorded samples, so a later version can report an old bench again.

mod charts;
mod drivers;
pub(crate) mod figures;
mod kind;
mod page;
mod table;
mod write;

pub(crate) use drivers::of_run;
pub(crate) use page::STYLE;
pub use table::bench_table;
pub(crate) use write::write_bench_to;
pub use write::{WrittenBench, write_bench};
