//! The lines of a bench after the first.

use super::counted::CountedInstructions;
use super::time::Time;
use crate::reason::{self, Reason};
use crate::verdict::Verdict;
use etalon_frame::{Accuracy, Work, state_enum};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::slice;

/// Any line of `bench.jsonl` except the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BenchLine {
    /// The verdict of a picture, before any frame of it was timed.
    Picture(Picture),
    /// The instructions of a frame.
    Counted(CountedInstructions),
    /// A round of frame times.
    Round(Round),
    /// The reason why a case has no more rounds on an adapter.
    Ended(Ended),
    /// The reason why a case needs no more rounds on an adapter.
    Done(Done),
}

/// The verdict of a case's picture on an adapter. It comes once, before the case's rounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The verdict; see [`Picture::may_be_timed`].
    pub verdict: Verdict,
    /// The fraction of asserted channels among all channels of all samples, 0 to 1.
    pub asserted: f64,
    /// The reasons for the verdict. Formats before 4 have a `message` instead.
    #[serde(
        default,
        alias = "message",
        deserialize_with = "reason::read",
        skip_serializing_if = "Vec::is_empty"
    )]
    pub reasons: Vec<Reason>,
    /// The work of a frame. Older versions have it for cells of the performance matrix only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub work: Option<Work>,
    /// The distance of the picture from the ideal, for each aspect and encoding that was read back, exact ones
    /// too. Older versions lack it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accuracy: Vec<Accuracy>,
}

impl Picture {
    /// Returns true if the picture was judged and is right. A picture that is wrong, or about which nothing
    /// was asserted, has no frame times.
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
    /// The number of the round, counted from 0 without gaps over the rounds of the case on this adapter.
    pub round: u32,
    /// The time from the start of the bench to the start of the round.
    pub at: f64,
    /// The ruler's times right before and right after the round.
    pub ruler: [f64; 2],
    /// The time to prepare the scene: everything that a driver does once, such as creating pipelines.
    pub prepare: f64,
    /// The time of the first frame after preparing, until the device was done; part of the warm-up.
    pub first: f64,
    /// Frames drawn before the first sample, including the very first; they are discarded.
    pub warm_up: u32,
    /// The times of the frames, until the device was done.
    pub wall: Vec<f64>,
    /// The times of the same frames, until the last call that submits work returned.
    pub cpu: Vec<f64>,
    /// The times of the same frames, between GPU timestamps; empty if the device has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gpu: Vec<f64>,
    /// The mean clock of the processors in MHz right before and right after the round, if the system
    /// reports it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clock: Option<[f64; 2]>,
    /// The times of reading the frame back, if they were measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub read_back: Vec<f64>,
}

impl Round {
    /// Returns the samples of one kind of time in the order of measuring; empty if it was not measured.
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

    /// Returns the ruler's time for this round: the geometric mean of the times before and after it.
    pub fn ruler_time(&self) -> f64 {
        (self.ruler[0] * self.ruler[1]).sqrt()
    }
}

/// The early end of a case's rounds on an adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ended {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// `Crash`, `Timeout`, `DeviceLost`, `ResourceError` or `InternalError`; `Flaky` or `Fail` if a picture
    /// after a round differs from the judged one.
    pub verdict: Verdict,
    /// The cause. Formats before 4 have a `message` instead.
    #[serde(alias = "message", deserialize_with = "reason::read")]
    pub reasons: Vec<Reason>,
}

state_enum! {
    /// The reason why a case needs no more rounds.
    Enough {
        /// The interval of the pair's value is narrow enough.
        Within = "within",
        /// The bench's time for the adapter has run out.
        Limit = "limit",
    }
}

/// The line that ends a case's rounds on an adapter because it needs no more; the case is then complete.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Done {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The reason why the case needs no more rounds.
    pub enough: Enough,
}
