//! Run, record and verdict: the wire format of a run folder and of the expectations.
//!
//! A run folder holds `run.jsonl`, one [`Header`] line and then one [`Record`] line per case and
//! adapter, and below `frames/` one [`FrameFile`] per frame that is worth looking at. [`RunWriter`]
//! writes such a folder, [`Run`] reads it; reports are made from it alone. [`Expectations`] name
//! the verdicts that are known and explained. A [`Hunt`] tells what became of planted bugs. A bench
//! folder holds `bench.jsonl`, the raw frame times that [`BenchWriter`] writes and [`Bench`] reads.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod bench;
mod bless;
mod driver_version;
mod error;
mod expectations;
mod frame_file;
mod header;
mod hunt;
mod lists;
mod lock;
mod measured;
mod merge;
mod record;
mod run;
mod selection;
mod verdict;
mod writer;

pub use bench::{
    BENCH_FORMAT, Bench, BenchHeader, BenchLine, BenchRecord, BenchWriter, Ended, FolderKind,
    Picture, Round, ShaderCache, Time,
};
pub use bless::Blessing;
pub use error::RecordError;
pub use expectations::{Entry, Expectation, Expectations};
pub use frame_file::{FrameFile, FrameImage};
pub use header::{AbsentAdapter, AdapterRecord, FORMAT, Header, Machine, Settings, Shard};
pub use hunt::{AreaTally, Catch, HUNT_FORMAT, Hunt, MutantInfo, MutantRecord, Sighting};
pub use lists::{About, Imported, ListError, ListKind, Lists};
pub use lock::FolderLock;
pub use measured::{Measured, Parameter, Times};
pub use merge::{Merge, Merged};
pub use record::{
    Assertion, Expected, LossKind, MAX_VALIDATION, MAX_WRONG_TEXELS, ProcessEnd, Record, Seconds,
};
pub use run::Run;
pub use selection::{read_cases, selection_digest, shard_of};
pub use verdict::Verdict;
pub use writer::{CASES_FILE, MAX_LINE, MISSING_FILE, RunWriter};
