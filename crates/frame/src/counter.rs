//! Counters and their legal counts.

use crate::band::Band;
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

state_enum! {
    /// The kind of a counter.
    CounterKind {
        /// The exact number of samples that passed all tests: a precise occlusion query.
        SamplesPassed = "samples-passed",
        /// 1 if any sample passed all tests, otherwise 0: an occlusion query that is not precise.
        AnySamplesPassed = "any-samples-passed",
        /// The number of fragment shader runs that counted themselves in a storage buffer.
        ShaderRuns = "shader-runs",
        /// The number of fragment shader runs that the pipeline statistics report.
        FragmentInvocations = "fragment-invocations",
    }
}

impl CounterKind {
    /// Returns true for an occlusion query; a draw has at most one of these.
    pub fn is_occlusion(self) -> bool {
        matches!(self, Self::SamplesPassed | Self::AnySamplesPassed)
    }
}

/// The legal values of one counter, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CountRange {
    /// The least legal count; 0 permits that nothing is counted.
    pub low: u64,
    /// The greatest legal count; `None` if there is no limit.
    pub high: Option<u64>,
}

impl CountRange {
    /// Returns true if the count is legal.
    pub fn contains(self, count: u64) -> bool {
        self.low <= count && self.high.is_none_or(|high| count <= high)
    }

    /// Returns true if every count of this kind is legal, so that nothing is asserted.
    pub fn is_open(self, kind: CounterKind) -> bool {
        let unbounded = match kind {
            CounterKind::AnySamplesPassed => self.high.is_none_or(|high| high >= 1),
            _ => self.high.is_none(),
        };
        self.low == 0 && unbounded
    }

    /// Returns true if exactly one count is legal.
    pub fn is_exact(self) -> bool {
        self.high == Some(self.low)
    }
}

impl fmt::Display for CountRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.high {
            Some(high) if high == self.low => write!(f, "{high}"),
            Some(high) => write!(f, "{} to {high}", self.low),
            None => write!(f, "{} or more", self.low),
        }
    }
}

/// The counts that the rules allow for one counter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CounterSet {
    /// The counter's name in the scene.
    pub name: String,
    /// What is counted, as the scene asks for it.
    pub kind: CounterKind,
    /// The counts that a driver can return without breaking a rule.
    pub range: CountRange,
}

/// A counter compared with both bands.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CounterOutcome {
    /// The counter's name in the scene.
    pub name: String,
    /// What is counted.
    pub kind: CounterKind,
    /// The least legal count.
    pub low: u64,
    /// The greatest legal count; absent if there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<u64>,
    /// The count that came back.
    pub actual: u64,
    /// The worst band that the count is outside of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Band>,
}

impl CounterOutcome {
    /// Compares a count with its legal range and the yardstick's.
    pub fn new(legal: &CounterSet, yardstick: CountRange, actual: u64) -> Self {
        let band = if !legal.range.contains(actual) {
            Some(Band::Fail)
        } else if !yardstick.contains(actual) {
            Some(Band::Imprecise)
        } else {
            None
        };
        Self {
            name: legal.name.clone(),
            kind: legal.kind,
            low: legal.range.low,
            high: legal.range.high,
            actual,
            band,
        }
    }

    /// Returns the legal counts.
    pub fn range(&self) -> CountRange {
        CountRange {
            low: self.low,
            high: self.high,
        }
    }

    /// Returns true if anything was asserted about the counter.
    pub fn is_asserted(&self) -> bool {
        !self.range().is_open(self.kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_is_legal_between_its_ends() {
        let range = |low, high| CountRange { low, high };
        assert!(range(3, Some(5)).contains(3) && range(3, Some(5)).contains(5));
        assert!(!range(3, Some(5)).contains(2) && !range(3, Some(5)).contains(6));
        let words = [range(3, Some(3)), range(3, Some(5)), range(3, None)].map(|r| r.to_string());
        assert_eq!(words, ["3", "3 to 5", "3 or more"]);
        assert!(range(3, None).contains(u64::MAX));
        assert!(range(0, None).is_open(CounterKind::ShaderRuns));
        assert!(!range(1, None).is_open(CounterKind::ShaderRuns));
        assert!(range(0, Some(1)).is_open(CounterKind::AnySamplesPassed));
        assert!(!range(0, Some(0)).is_open(CounterKind::AnySamplesPassed));
    }

    #[test]
    fn a_count_outside_both_bands_fails() {
        let legal = CounterSet {
            name: "n".to_owned(),
            kind: CounterKind::SamplesPassed,
            range: CountRange {
                low: 2,
                high: Some(8),
            },
        };
        let tight = CountRange {
            low: 4,
            high: Some(4),
        };
        let band = |actual| CounterOutcome::new(&legal, tight, actual).band;
        assert_eq!(band(4), None);
        assert_eq!(band(2), Some(Band::Imprecise));
        assert_eq!(band(9), Some(Band::Fail));
    }
}
