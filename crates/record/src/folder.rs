//! The names of the files in a run or bench folder, and the folder's kind.

use std::path::Path;

/// The file of a run folder that holds the header and the records.
pub const RUN_FILE: &str = "run.jsonl";
/// The file of a bench folder that holds the header and the frame times.
pub const BENCH_FILE: &str = "bench.jsonl";
/// The file of a run folder that lists the selected ids, one per line, before sharding.
pub const CASES_FILE: &str = "cases.txt";
/// The file of a merged run that lists the records that no part has: adapter, space, case.
pub const MISSING_FILE: &str = "missing.txt";
/// The file of a run folder that lists the dead expectations.
pub const DEAD_FILE: &str = "dead-expectations.json";
/// The folder of frame files in a run folder.
pub(crate) const FRAMES: &str = "frames";
/// The folder of pictures in a run folder.
pub(crate) const PICTURES: &str = "pictures";

/// The kind of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FolderKind {
    /// A run: `run.jsonl`.
    Run,
    /// A bench: `bench.jsonl`.
    Bench,
}

impl FolderKind {
    /// The noun: run or bench.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Bench => "bench",
        }
    }

    /// The kind of a folder, by the file in it; `None` where it holds neither or is no folder.
    pub fn of(folder: &Path) -> Option<Self> {
        if folder.join(BENCH_FILE).is_file() {
            Some(Self::Bench)
        } else if folder.join(RUN_FILE).is_file() {
            Some(Self::Run)
        } else {
            None
        }
    }
}
