//! Run, record and verdict: the wire format of run folders, bench folders and expectations.
//!
//! A run folder holds `run.jsonl`, one [`Header`] line and then one [`Record`] line per case and adapter,
//! and below `frames/` one [`FrameFile`] per frame that is not entirely right. [`RunWriter`] writes such a
//! folder and [`Run`] reads it; reports are made from it alone. [`Expectations`] name the verdicts that are
//! known and explained. A [`Hunt`] holds the results of planted bugs. A bench folder holds `bench.jsonl`,
//! the raw frame times that [`BenchWriter`] writes and [`Bench`] reads.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod adapter;

mod bench;
pub mod beside;
mod change;
mod conflict;
mod content;
mod date;
mod dead;
mod driver_version;
mod error;
mod expectation_files;
mod expectations;
mod expected_symptom;
mod findings;
mod folder;
mod frame_file;
mod frame_writer;
mod grade;
mod hash;
mod header;
mod hunt;
mod innocent;
mod json;
mod json_file;
mod json_lines;
mod known;
mod labels;
mod line;
mod line_writer;
mod list;
mod lists;
mod lock;
mod machine;
mod measured;
mod merge;
mod output_folder;
mod parts;
mod paths;
mod png_file;
mod process_end;
mod provenance;
mod reason;
mod record;
mod run;
mod selection;
mod shader_cache;
mod shorten;
mod sighting;
mod standing;
mod unlisted;
mod verdict;
mod versions;
mod writer;

pub use adapter::{AbsentAdapter, AdapterRecord, Release};

pub use bench::{
    BENCH_FORMAT, Bench, BenchHeader, BenchLine, BenchRecord, BenchSettings, BenchWriter, CellRate,
    CountedInstructions, Done, Ended, Enough, InstructionCounter, Measure, Picture,
    ProcessorLimits, Round, Time, cell,
};
pub use change::{CaseResult, Change};
pub use content::{Content, check_folder, is_marked, overlap};
pub use dead::{Dead, DeadKind, DeadSearch};
pub use driver_version::version_of;
pub use error::RecordError;
pub use etalon_stats::Standing;
pub use expectations::{Expectation, Expectations};
pub use expected_symptom::{ExpectedSymptom, Side, SymptomParts};
pub use findings::{Evidence, Finding, Reading, ReadingVerdict, Seen};
pub use folder::{
    BENCH_FILE, BESIDE_FILE, CASES_FILE, DEAD_FILE, FUZZ_FILE, FolderKind, HUNT_FILE, MISSING_FILE,
    RUN_FILE, TIMED_FOLDER, VERSIONS_FILE, WORK_FOLDER,
};
pub use frame_file::{FrameFile, FrameImage};
pub use frame_writer::FrameWriter;
pub use grade::Grade;
pub use header::{FORMAT, Header, ModelFile, Settings, Shard};
pub use hunt::{AreaTally, Catch, HUNT_FORMAT, Hunt, MutantInfo, MutantRecord};
pub use innocent::{InnocentInfo, InnocentRecord, InnocentTally};
pub use known::{Entry, Known, KnownSource};
pub use labels::{LabelError, Labels, parse_labels};
pub use line::{frame_file, header_line, picture_file, record_line};
pub use lists::{About, Imported, ListError, ListKind, Lists};
pub use lock::FolderLock;
pub use machine::Machine;
pub use measured::{Clock, Cost, Estimate, Measured, Parameter, SizedFrame, Times};
pub use merge::{Merge, Merged};
pub use output_folder::OutputFolder;
pub use paths::open_below;
pub use png_file::png_file;
pub use process_end::{ExitStatus, LossKind, ProcessEnd};
pub use provenance::Provenance;
pub use reason::{ComparedPair, Denial, FailedRoundTrip, Fresh, Reason};
pub use record::{
    Assertion, Expected, MAX_LINE, MAX_VALIDATION, MAX_WRONG_TEXELS, Record, Seconds,
    count_unexpected,
};
pub use run::Run;
pub use selection::{read_cases, selection_digest, shard_of};
pub use shader_cache::ShaderCache;
pub use sighting::Sighting;
pub use verdict::Verdict;
pub use versions::{CaseVersions, ReleaseRecord, VERSIONS_FORMAT, Versions, VersionsHeader};
pub use writer::RunWriter;
