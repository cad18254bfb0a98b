//! The outcome of a case on an adapter: what the history keeps of a record.
//!
//! Values that change from run to run without meaning, such as drawing times and process ids in messages,
//! are left out, and so are large values. A run with the same results as an earlier one therefore adds no
//! outcome.

use etalon_frame::{Aspect, Distance, TexelCounts};
use etalon_record::{CaseResult, Measured, Record, Standing, Verdict};
use serde::{Deserialize, Serialize};

/// The part of a record that the history keeps.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The raw verdict.
    pub verdict: Verdict,
    /// The reason why the verdict is expected; `None` if it is not.
    pub expected: Option<String>,
    /// The bad verdict that was expected, if the raw one is better.
    pub improves: Option<Verdict>,
    /// True if the case is a selftest that must fail.
    pub due_fail: bool,
    /// True if the case was not drawn: the releases before and after have the same standing, and it has the
    /// verdict of the earlier one.
    pub inferred: bool,
    /// The numbers.
    pub measures: Measures,
}

/// The numbers of an outcome.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measures {
    /// The assertions, per aspect.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub asserted: Vec<Asserted>,
    /// Samples by result; all zero if no frame came back.
    #[serde(default, skip_serializing_if = "is_none")]
    pub texels: TexelCounts,
    /// Accuracy and work of a method case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<MethodMeasures>,
}

fn is_none(counts: &TexelCounts) -> bool {
    *counts == TexelCounts::default()
}

/// The assertions of the legal sets about one aspect. A channel is one channel of one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asserted {
    /// The aspect.
    pub aspect: Aspect,
    /// The number of channels in all samples.
    pub channels: u64,
    /// The number of channels about which something was asserted.
    pub asserted: u64,
    /// Legal codes, summed over the asserted channels.
    pub codes: u64,
}

/// Accuracy and work of a method case. Distances have seven digits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodMeasures {
    /// The root mean square difference from the truth.
    pub rmse: f32,
    /// The largest difference of any channel.
    pub max: f32,
    /// The mean FLIP difference.
    pub flip: f32,
    /// The share of texels that differ visibly, 0 to 1.
    pub wrong: f32,
    /// The number of render passes.
    pub passes: u32,
    /// The number of draw calls.
    pub draws: u32,
    /// The number of fragment shader invocations, if the adapter has statistics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fragments: Option<u64>,
    /// The number of bytes of all attachments.
    pub bytes: u64,
}

impl Outcome {
    /// Returns an outcome with a verdict and nothing else.
    pub fn new(verdict: Verdict) -> Self {
        Self {
            verdict,
            expected: None,
            improves: None,
            due_fail: false,
            inferred: false,
            measures: Measures::default(),
        }
    }

    /// Returns true if the record counts against its run, as in [`Record::unexpected`].
    pub fn unexpected(&self) -> bool {
        CaseResult::from(self).unexpected()
    }

    /// Returns true if the verdict is better than expected.
    pub fn improvement(&self) -> bool {
        self.improves.is_some() && !self.unexpected()
    }

    /// Returns the standing of the driver. A selftest that fails as it must is good, and one that does not
    /// fail is bad.
    pub fn standing(&self) -> Standing {
        self.verdict.standing(self.due_fail)
    }

    /// Returns the asserted share of the channels of all aspects, 0 to 1; `None` without channels.
    pub fn asserted_share(&self) -> Option<f64> {
        let sum = |field: fn(&Asserted) -> u64| -> f64 {
            self.measures.asserted.iter().map(|a| field(a) as f64).sum()
        };
        let channels = sum(|a| a.channels);
        (channels > 0.0).then(|| sum(|a| a.asserted) / channels)
    }
}

impl From<&Outcome> for CaseResult {
    fn from(outcome: &Outcome) -> Self {
        Self {
            verdict: outcome.verdict,
            due_fail: outcome.due_fail,
            expected: outcome.expected.is_some(),
        }
    }
}

impl From<&Record> for Outcome {
    fn from(record: &Record) -> Self {
        let asserted = record.assertions.iter().map(|a| Asserted {
            aspect: a.aspect,
            channels: a.channels,
            asserted: a.asserted,
            codes: a.codes,
        });
        Self {
            verdict: record.verdict,
            expected: record.expected.as_ref().map(|e| e.reason.clone()),
            improves: record.improves,
            due_fail: record.due_fail,
            inferred: false,
            measures: Measures {
                asserted: asserted.collect(),
                texels: record.texels,
                method: record.measured.as_ref().map(MethodMeasures::from),
            },
        }
    }
}

impl From<&Measured> for MethodMeasures {
    fn from(measured: &Measured) -> Self {
        let Distance {
            rmse,
            max,
            flip,
            wrong,
            ..
        } = measured.distance;
        Self {
            rmse: rmse as f32,
            max: max as f32,
            flip: flip as f32,
            wrong: wrong as f32,
            passes: measured.passes,
            draws: measured.draws,
            fragments: measured.fragments,
            bytes: measured.bytes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::Expected;

    #[test]
    fn an_outcome_is_unexpected_exactly_if_its_record_is() {
        for verdict in Verdict::ALL {
            for due_fail in [false, true] {
                for expected in [false, true] {
                    let mut record = Record::new("depth/a", "cpu", verdict);
                    record.due_fail = due_fail;
                    record.expected = expected.then(|| Expected {
                        reason: "known".to_owned(),
                    });
                    let outcome = Outcome::from(&record);
                    assert_eq!(outcome.unexpected(), record.unexpected(), "{verdict}");
                }
            }
        }
    }

    #[test]
    fn a_selftest_is_good_if_it_fails() {
        let standing = |verdict, due_fail| {
            let mut outcome = Outcome::new(verdict);
            outcome.due_fail = due_fail;
            outcome.standing()
        };
        assert_eq!(standing(Verdict::Fail, true), Standing::Good);
        assert_eq!(standing(Verdict::Pass, true), Standing::Bad);
        assert_eq!(standing(Verdict::Fail, false), Standing::Bad);
        assert_eq!(standing(Verdict::Crash, true), Standing::Bad);
        assert_eq!(standing(Verdict::NotSupported, true), Standing::Unknown);
    }
}
