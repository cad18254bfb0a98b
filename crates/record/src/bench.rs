//! A bench folder: `bench.jsonl`, the raw frame times of cases on adapters.
//!
//! The first line is a [`BenchHeader`], every other one a [`BenchLine`], in the order in which things
//! happened: what became of a case's picture on an adapter, and then a line per [`Round`] of frame
//! times. A round is one fresh preparation of the scene; rounds of cases and adapters interleave, so
//! a bench that was killed still holds the same number of rounds of each, give or take one. Nothing
//! is summarised and no sample is thrown away apart from the warm-up, which is counted: comparing two
//! benches needs the samples.

mod read;
mod write;

pub use read::Bench;
pub use write::BenchWriter;

use crate::header::{AbsentAdapter, AdapterRecord, Machine};
use crate::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::slice;

/// The format of `bench.jsonl` that this crate reads and writes.
pub const BENCH_FORMAT: u32 = 1;

/// The file in a bench folder.
pub(crate) const BENCH_FILE: &str = "bench.jsonl";

/// What was timed, where and when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BenchHeader {
    /// The format of the bench folder: [`BENCH_FORMAT`].
    pub format: u32,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The machine.
    pub machine: Machine,
    /// When the bench began, RFC 3339 in UTC.
    pub started: String,
    /// The command line, program first.
    pub command: Vec<String>,
    /// The profile of the cases: `quick` or `full`.
    pub profile: String,
    /// How many cases were selected.
    pub cases: u64,
    /// How many rounds each case has on each adapter in a complete bench.
    pub rounds: u32,
    /// What the drivers' shader caches held.
    pub shader_cache: ShaderCache,
    /// The fixed work on the processor that is timed around each round, in words that change when the
    /// work does. Benches with different rulers cannot be corrected by them.
    pub ruler: String,
    /// The adapters that were timed.
    pub adapters: Vec<AdapterRecord>,
    /// The adapters that were looked for and cannot be used.
    pub absent: Vec<AbsentAdapter>,
}

impl BenchHeader {
    /// The adapter of this name.
    pub fn adapter(&self, name: &str) -> Option<&AdapterRecord> {
        self.adapters.iter().find(|a| a.name == name)
    }
}

/// What a driver's shader cache on disk held when a bench began.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShaderCache {
    /// Nothing: it was put into an empty folder, or switched off.
    Cold,
    /// Whatever earlier runs left.
    Warm,
}

impl ShaderCache {
    /// The word in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cold => "cold",
            Self::Warm => "warm",
        }
    }
}

/// Any line of `bench.jsonl` but the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BenchLine {
    /// How a picture was judged, before anything of it was timed.
    Picture(Picture),
    /// A round of frame times.
    Round(Round),
    /// Why a case has no more rounds on an adapter although it had some.
    Ended(Ended),
}

/// How the picture of a case on an adapter was judged. It comes before the case's rounds, once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The verdict; see [`Picture::may_be_timed`].
    pub verdict: Verdict,
    /// The share of all channels of all samples of which something was asserted, 0 to 1.
    pub asserted: f64,
    /// The missing requirement, the error, or the first wrong texel.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub message: String,
}

impl Picture {
    /// Whether the picture was held against something and found right. A wrong picture has no frame
    /// time, and neither has one of which nothing was asserted.
    pub fn may_be_timed(&self) -> bool {
        matches!(
            self.verdict,
            Verdict::Pass | Verdict::Imprecise | Verdict::Measured
        )
    }
}

/// The frame times of one fresh preparation of a case on an adapter. All times are in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The round's number among the case's on this adapter, from 0, without gaps.
    pub round: u32,
    /// When the round began, since the bench did.
    pub at: f64,
    /// The ruler right before and right after the round.
    pub ruler: [f64; 2],
    /// Preparing the scene: what a driver does once, pipelines among it.
    pub prepare: f64,
    /// The first frame after preparing, until the device was done; part of the warm-up.
    pub first: f64,
    /// Frames drawn before the first sample, the very first among them; they are discarded.
    pub warm_up: u32,
    /// Frames, until the device was done.
    pub wall: Vec<f64>,
    /// The same frames, until the last call that submits work returned.
    pub cpu: Vec<f64>,
    /// The same frames, between GPU timestamps; empty where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gpu: Vec<f64>,
    /// Reading the frame back, where that was timed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub read_back: Vec<f64>,
}

impl Round {
    /// The samples of one time in the order of measuring; empty where it was not measured.
    pub fn samples(&self, time: Time) -> &[f64] {
        match time {
            Time::Wall => &self.wall,
            Time::Cpu => &self.cpu,
            Time::Gpu => &self.gpu,
            Time::ReadBack => &self.read_back,
            Time::Prepare => slice::from_ref(&self.prepare),
            Time::First => slice::from_ref(&self.first),
        }
    }

    /// The ruler's time for this round: the geometric mean of before and after.
    pub fn ruler_time(&self) -> f64 {
        (self.ruler[0] * self.ruler[1]).sqrt()
    }
}

/// The end of a case's rounds on an adapter before their time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ended {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// Crash, Timeout, DeviceLost, ResourceError, InternalError; Flaky or Fail where a picture after
    /// a round is not the one that was judged.
    pub verdict: Verdict,
    /// What happened.
    pub message: String,
}

/// The times of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Time {
    /// A frame until the device was done.
    Wall,
    /// A frame until the last call that submits work returned.
    Cpu,
    /// A frame between GPU timestamps.
    Gpu,
    /// Reading a frame back.
    ReadBack,
    /// Preparing the scene.
    Prepare,
    /// The first frame after preparing.
    First,
}

impl Time {
    /// Every time.
    pub const ALL: [Self; 6] = [
        Self::Wall,
        Self::Cpu,
        Self::Gpu,
        Self::ReadBack,
        Self::Prepare,
        Self::First,
    ];

    /// The word in records and reports: `read-back`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
            Self::ReadBack => "read-back",
            Self::Prepare => "prepare",
            Self::First => "first",
        }
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Everything that a bench tells of one case on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchRecord {
    /// How its picture was judged.
    pub picture: Picture,
    /// Its rounds, by number; empty where the picture may not be timed.
    pub rounds: Vec<Round>,
    /// Why it has fewer rounds than others.
    pub ended: Option<Ended>,
}

impl BenchRecord {
    /// The samples of one time, round by round; rounds without any are left out.
    pub fn samples(&self, time: Time) -> Vec<&[f64]> {
        let all = self.rounds.iter().map(|r| r.samples(time));
        all.filter(|s| !s.is_empty()).collect()
    }

    /// The ruler's time of each round that has samples of this time, as [`BenchRecord::samples`].
    pub fn rulers(&self, time: Time) -> Vec<f64> {
        let timed = |r: &&Round| !r.samples(time).is_empty();
        self.rounds
            .iter()
            .filter(timed)
            .map(Round::ruler_time)
            .collect()
    }

    /// How many frames were drawn and discarded as warm-up.
    pub fn discarded(&self) -> u64 {
        self.rounds.iter().map(|r| u64::from(r.warm_up)).sum()
    }
}

/// What a folder holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FolderKind {
    /// A run: `run.jsonl`.
    Run,
    /// A bench: `bench.jsonl`.
    Bench,
}

impl FolderKind {
    /// What a folder holds, by the file in it; `None` where it holds neither or is no folder.
    pub fn of(folder: &Path) -> Option<Self> {
        if folder.join(BENCH_FILE).is_file() {
            Some(Self::Bench)
        } else if folder.join("run.jsonl").is_file() {
            Some(Self::Run)
        } else {
            None
        }
    }
}
