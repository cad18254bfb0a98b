//! A line of a run: the result of a case on an adapter.

use crate::adapter::AdapterRecord;
use crate::change::CaseResult;
use crate::expectations::{Expectation, Expectations};
use crate::expected_symptom::SymptomParts;
use crate::measured::Measured;
use crate::process_end::ProcessEnd;
use crate::reason::{self, Reason};
use crate::verdict::Verdict;
use etalon_frame::{
    Accuracy, Aspect, AspectStatistics, CaseId, CounterOutcome, ErrorKind, Story, TexelCounts,
    WrongTexel,
};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The maximum number of bytes of a record's line, including its newline.
pub const MAX_LINE: usize = 64 * 1024;
/// The maximum number of wrong texels that a record lists.
pub const MAX_WRONG_TEXELS: usize = 64;
/// The maximum number of validation messages that a record keeps.
pub const MAX_VALIDATION: usize = 16;

/// The result of one case on one adapter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The raw verdict, independent of expectations.
    pub verdict: Verdict,
    /// The expectation that the verdict agrees with, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<Expected>,
    /// The case of a finding with the same reduced scene, if the record is expected only for that reason. The
    /// finding does not name the record's own case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub look: Option<String>,
    /// The bad verdict that the expectations name, if the raw one is better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub improves: Option<Verdict>,
    /// True if the case is a selftest that must fail.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub due_fail: bool,
    /// The reasons for the verdict that no other field holds. Formats before 6 have a `message` instead.
    #[serde(
        default,
        alias = "message",
        deserialize_with = "reason::read",
        skip_serializing_if = "Vec::is_empty"
    )]
    pub reasons: Vec<Reason>,
    /// The number of samples by result; all zero if no frame came back.
    #[serde(default, skip_serializing_if = "TexelCounts::is_empty")]
    pub texels: TexelCounts,
    /// The asserted fraction and the sharpness, per aspect.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assertions: Vec<Assertion>,
    /// The distance of the frame from the ideal, for each aspect that is not exact. Formats before 5 have exact
    /// aspects too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accuracy: Vec<Accuracy>,
    /// Every counter with its legal range.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub counters: Vec<CounterOutcome>,
    /// The case whose record on this adapter has the story, the wrong samples and the frame of the same known
    /// failure. This record keeps the first wrong sample only. Formats before 5 lack it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub example: Option<String>,
    /// The first wrong samples, failures before imprecise ones; at most [`MAX_WRONG_TEXELS`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wrong: Vec<WrongTexel>,
    /// The reference's operations at the first wrong sample.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub story: Option<Story>,
    /// The frame file's path below the run folder, with `/` between its parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<String>,
    /// The time that drawing and judging took.
    #[serde(default, skip_serializing_if = "Seconds::is_zero")]
    pub seconds: Seconds,
    /// The measurements of a method case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// The kind of the backend's error, if it failed. Formats before 4 lack it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorKind>,
    /// The end of the process that drew the case, if it was lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub process: Option<ProcessEnd>,
    /// Messages of validation layers and debug output, at most [`MAX_VALIDATION`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub validation: Vec<String>,
    /// The verdicts of all repetitions in fresh processes, without the first verdict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub repeats: Vec<Verdict>,
    /// The cases that must be drawn earlier in the same process, in this order, for this verdict. Drawn
    /// alone, the case has a better verdict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub after: Vec<String>,
    /// The failed cases that prevented drawing a `Blocked` case: round trips, or what the API's version requires.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blocked_by: Vec<String>,
}

impl Record {
    /// Returns a record with a verdict and nothing else yet.
    pub fn new(case: impl Into<String>, adapter: impl Into<String>, verdict: Verdict) -> Self {
        Self {
            case: case.into(),
            adapter: adapter.into(),
            verdict,
            expected: None,
            look: None,
            improves: None,
            due_fail: false,
            reasons: Vec::new(),
            texels: TexelCounts::default(),
            assertions: Vec::new(),
            accuracy: Vec::new(),
            counters: Vec::new(),
            example: None,
            wrong: Vec::new(),
            story: None,
            frame: None,
            seconds: Seconds::default(),
            measured: None,
            error: None,
            process: None,
            validation: Vec::new(),
            repeats: Vec::new(),
            after: Vec::new(),
            blocked_by: Vec::new(),
        }
    }

    /// Sets what the expectations say about the verdict.
    pub fn expect(&mut self, expectations: &Expectations, adapter: &AdapterRecord) {
        (self.expected, self.improves) =
            match expectations.look_up_record(adapter, &self.case, self.shown()) {
                Expectation::None => (None, None),
                Expectation::Agrees(entry) => (
                    Some(Expected {
                        reason: entry.reason.clone(),
                    }),
                    None,
                ),
                Expectation::Better(entry) => (None, Some(entry.verdict)),
                Expectation::Expired(entry) => {
                    let day = entry.expires.as_deref().unwrap_or_default();
                    self.reasons.push(Reason::Expired {
                        day: day.to_owned(),
                        reason: entry.reason.clone(),
                    });
                    (None, None)
                }
                Expectation::Differs(entry) => {
                    let reason = entry.reason.clone();
                    self.reasons.push(Reason::OtherSymptom(reason));
                    (None, None)
                }
            };
    }

    /// Returns the paths of its pictures below the run folder: the drawn one and the truth.
    pub(crate) fn pictures(&self) -> impl Iterator<Item = &str> {
        let measured = self.measured.as_ref().into_iter();
        let both = measured.flat_map(|m| [m.picture.as_deref(), m.truth_picture.as_deref()]);
        both.flatten()
    }

    /// Returns the paths of all its files below the run folder.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.pictures().chain(self.frame.as_deref())
    }

    /// Returns the parts that expectations compare.
    pub fn shown(&self) -> SymptomParts<'_> {
        SymptomParts {
            verdict: self.verdict,
            wrong: &self.wrong,
            counters: &self.counters,
        }
    }

    /// Returns true if the record counts against the run: a bad verdict that no expectation names, or a
    /// selftest that had to fail and did not.
    pub fn unexpected(&self) -> bool {
        CaseResult::from(self).unexpected()
    }

    /// Returns the reason why a wrong picture is expected: for a selftest that is due to fail, its case
    /// file. On one adapter, records with the same reason show the same bug.
    pub fn excuse(&self) -> Option<&str> {
        if self.due_fail && self.verdict.is_violation() {
            return Some(self.parts().file());
        }
        let pictured = self.verdict.is_violation() || self.verdict == Verdict::Flaky;
        let expected = self.expected.as_ref().filter(|_| pictured);
        expected.map(|expected| &*expected.reason)
    }

    /// Leaves out what the record of another case with the same [excuse](Self::excuse) shows.
    pub fn refer_to(&mut self, example: String) {
        self.wrong.truncate(1);
        self.story = None;
        self.example = Some(example);
    }

    /// Returns true if the verdict is better than expected.
    pub fn improvement(&self) -> bool {
        self.improves.is_some() && !self.unexpected()
    }

    /// Returns true if drawing the case was tried, whatever came of it.
    pub fn is_drawn(&self) -> bool {
        !matches!(
            self.verdict,
            Verdict::NotSupported | Verdict::Skipped | Verdict::Blocked
        )
    }

    /// Returns true if anything about the frame was checked.
    pub fn asserts(&self) -> bool {
        let judged = self.verdict.is_judged() && self.verdict != Verdict::Open;
        let channels = self.assertions.iter().any(|a| a.asserted > 0);
        judged || channels || self.counters.iter().any(CounterOutcome::is_asserted)
    }

    /// Returns true if stronger evidence forbids the value of a counter than that of any texel.
    pub fn is_decided_by_counter(&self) -> bool {
        let texels = self.wrong.iter().map(|texel| texel.band).max();
        self.counters.iter().any(|counter| counter.band > texels)
    }

    /// Returns the parts of the case's id.
    pub fn parts(&self) -> CaseId<'_> {
        CaseId::new(&self.case)
    }
}

/// Returns the number of records that count against the run.
pub fn count_unexpected<'r>(records: impl IntoIterator<Item = &'r Record>) -> u64 {
    let unexpected = records.into_iter().filter(|record| record.unexpected());
    unexpected.count() as u64
}

impl From<&Record> for CaseResult {
    fn from(record: &Record) -> Self {
        Self {
            verdict: record.verdict,
            due_fail: record.due_fail,
            expected: record.expected.is_some(),
        }
    }
}

/// The expectation that a record agrees with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// The reason why the verdict is accepted.
    pub reason: String,
}

/// The times of one case, in seconds of wall time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seconds {
    /// Preparing, drawing and reading back.
    pub draw: f64,
    /// Computing the legal set, and comparing the frame with it.
    pub judge: f64,
}

impl Seconds {
    /// Returns the times, rounded to microseconds.
    pub fn new(draw: Duration, judge: Duration) -> Self {
        let rounded = |time: Duration| time.as_micros() as f64 / 1e6;
        Self {
            draw: rounded(draw),
            judge: rounded(judge),
        }
    }

    fn is_zero(&self) -> bool {
        *self == Self::default()
    }
}

/// The amount that the legal set and the yardstick assert about one aspect. A *channel* here is one channel of
/// one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "WrittenAssertion", into = "WrittenAssertion")]
pub struct Assertion {
    /// The aspect, over all attachments that were read back.
    pub aspect: Aspect,
    /// Channels in all samples, whether anything is asserted about them or not.
    pub channels: u64,
    /// Channels that the legal set asserts something about.
    pub asserted: u64,
    /// Channels with exactly one legal code.
    pub exact: u64,
    /// The number of legal codes, summed over the asserted channels.
    pub codes: u64,
    /// Channels with exactly one code inside the yardstick.
    pub yardstick_exact: u64,
    /// The number of codes inside the yardstick, summed over the channels that it asserts.
    pub yardstick_codes: u64,
    /// Channels that the yardstick asserts something about.
    pub yardstick_asserted: u64,
}

/// The file form of an [`Assertion`]. An absent number equals `channels`, as most do.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenAssertion {
    aspect: Aspect,
    channels: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    asserted: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    exact: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    codes: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    yardstick_exact: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    yardstick_codes: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    yardstick_asserted: Option<u64>,
}

impl From<Assertion> for WrittenAssertion {
    fn from(assertion: Assertion) -> Self {
        let written = |number| (number != assertion.channels).then_some(number);
        Self {
            aspect: assertion.aspect,
            channels: assertion.channels,
            asserted: written(assertion.asserted),
            exact: written(assertion.exact),
            codes: written(assertion.codes),
            yardstick_exact: written(assertion.yardstick_exact),
            yardstick_codes: written(assertion.yardstick_codes),
            yardstick_asserted: written(assertion.yardstick_asserted),
        }
    }
}

impl From<WrittenAssertion> for Assertion {
    fn from(written: WrittenAssertion) -> Self {
        let channels = written.channels;
        let number = |written: Option<u64>| written.unwrap_or(channels);
        Self {
            aspect: written.aspect,
            channels,
            asserted: number(written.asserted),
            exact: number(written.exact),
            codes: number(written.codes),
            yardstick_exact: number(written.yardstick_exact),
            yardstick_codes: number(written.yardstick_codes),
            yardstick_asserted: number(written.yardstick_asserted),
        }
    }
}

impl Assertion {
    /// Combines the statistics of a legal set and its yardstick.
    pub fn new(aspect: Aspect, legal: AspectStatistics, yardstick: AspectStatistics) -> Self {
        Self {
            aspect,
            channels: legal.channels,
            asserted: legal.asserted,
            exact: legal.exact,
            codes: legal.codes,
            yardstick_exact: yardstick.exact,
            yardstick_codes: yardstick.codes,
            yardstick_asserted: yardstick.asserted,
        }
    }

    /// Adds another case's figures of the same aspect.
    pub fn add(&mut self, other: &Self) {
        self.channels = self.channels.saturating_add(other.channels);
        self.asserted = self.asserted.saturating_add(other.asserted);
        self.exact = self.exact.saturating_add(other.exact);
        self.codes = self.codes.saturating_add(other.codes);
        self.yardstick_exact = self.yardstick_exact.saturating_add(other.yardstick_exact);
        self.yardstick_codes = self.yardstick_codes.saturating_add(other.yardstick_codes);
        self.yardstick_asserted = self
            .yardstick_asserted
            .saturating_add(other.yardstick_asserted);
    }

    /// Returns the asserted fraction of all channels, 0 to 1; 0 without channels.
    pub fn share(&self) -> f64 {
        ratio(self.asserted, self.channels).unwrap_or(0.0)
    }

    /// Returns the mean number of legal codes per asserted channel; 1 is the sharpest.
    pub fn sharpness(&self) -> Option<f64> {
        ratio(self.codes, self.asserted)
    }

    /// Returns the mean number of codes inside the yardstick per channel that it asserts.
    pub fn yardstick_sharpness(&self) -> Option<f64> {
        ratio(self.yardstick_codes, self.yardstick_asserted)
    }

    /// Returns the fraction of all channels that the yardstick asserts, 0 to 1.
    pub fn yardstick_share(&self) -> f64 {
        ratio(self.yardstick_asserted, self.channels).unwrap_or(0.0)
    }
}

fn ratio(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_verdicts_are_unexpected_unless_an_entry_agrees() {
        for verdict in Verdict::ALL {
            let mut record = Record::new("depth/a", "cpu", verdict);
            assert_eq!(record.unexpected(), verdict.is_bad(), "{verdict}");
            record.expected = Some(Expected {
                reason: "known".to_owned(),
            });
            assert!(!record.unexpected(), "{verdict}");
        }
    }

    #[test]
    fn a_selftest_that_does_not_fail_is_unexpected() {
        for verdict in Verdict::ALL {
            let mut record = Record::new("selftest/a", "cpu", verdict);
            record.due_fail = true;
            let caught = matches!(
                verdict,
                Verdict::Fail
                    | Verdict::RequiredByCts
                    | Verdict::Disputed
                    | Verdict::NotSupported
                    | Verdict::Skipped
            );
            assert_eq!(record.unexpected(), !caught, "{verdict}");
        }
    }

    #[test]
    fn the_case_file_is_the_id_without_axis_values() {
        let file = |id: &str| {
            Record::new(id, "cpu", Verdict::Pass)
                .parts()
                .file()
                .to_owned()
        };
        assert_eq!(
            file("depth/compare/compare=less/write=true"),
            "depth/compare"
        );
        assert_eq!(file("depth/a/b"), "depth/a/b");
        assert_eq!(file("a=1/b"), "a=1/b");
        assert_eq!(file(""), "");
    }

    #[test]
    fn without_channels_the_share_is_zero_and_the_sharpness_unknown() {
        let mut a = Assertion::new(
            Aspect::Color,
            AspectStatistics::default(),
            AspectStatistics::default(),
        );
        assert_eq!((a.share(), a.sharpness()), (0.0, None));
        let some = AspectStatistics {
            channels: 4,
            asserted: 2,
            exact: 1,
            codes: 3,
        };
        a.add(&Assertion::new(Aspect::Color, some, some));
        assert_eq!((a.share(), a.sharpness()), (0.5, Some(1.5)));
        assert_eq!(a.yardstick_sharpness(), Some(1.5));
    }
}
