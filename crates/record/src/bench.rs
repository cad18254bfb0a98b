//! A bench folder: `bench.jsonl`, the raw frame times of cases on adapters.
//!
//! The first line is a [`BenchHeader`], and every other line is a [`BenchLine`], in the order of events: first
//! the verdict of a case's picture on an adapter, its [`CountedInstructions`] instructions if they were asked
//! for, then a line per [`Round`] of frame times. A round is one fresh preparation of the scene. Rounds of cases
//! and adapters interleave, so the round counts of a bench that was killed differ by at most one. Nothing is
//! summarised, and only the warm-up is discarded and counted, because comparing two benches needs the samples.

mod cell;
mod counted;
mod header;
mod line;
mod read;
mod record;
mod time;
mod write;

pub use cell::{CellRate, Measure, cell};
pub use counted::{CountedInstructions, InstructionCounter};
pub use header::{BENCH_FORMAT, BenchHeader, BenchSettings, ProcessorLimits};
pub use line::{BenchLine, Done, Ended, Enough, Picture, Round};
pub use read::Bench;
pub use record::BenchRecord;
pub use time::Time;
pub use write::BenchWriter;
