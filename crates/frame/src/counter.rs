//! Counters, and the counts that are legal.

use crate::band::Band;
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

state_enum! {
    /// The kind of a counter.
    CounterKind {
        /// Samples that passed all tests, exactly: a precise occlusion query.
        SamplesPassed = "samples-passed",
        /// 1 when any sample passed all tests, else 0: an occlusion query that is not precise.
        AnySamplesPassed = "any-samples-passed",
        /// Runs of the fragment shader that counted themselves in a storage buffer.
        ShaderRuns = "shader-runs",
        /// Runs of the fragment shader as the pipeline statistics tell them.
        FragmentInvocations = "fragment-invocations",
    }
}

impl CounterKind {
    /// True if it is an occlusion query, of which a draw has one at most.
    pub fn is_occlusion(self) -> bool {
        matches!(self, Self::SamplesPassed | Self::AnySamplesPassed)
    }
}

/// The legal values of one counter, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CountRange {
    /// At least so many.
    pub low: u64,
    /// At most so many; `None` where nothing limits it.
    pub high: Option<u64>,
}

impl CountRange {
    /// True if the count is legal.
    pub fn contains(self, count: u64) -> bool {
        self.low <= count && self.high.is_none_or(|high| count <= high)
    }

    /// True if every count of this kind is legal, so that nothing is asserted.
    pub fn is_open(self, kind: CounterKind) -> bool {
        let all = match kind {
            CounterKind::AnySamplesPassed => self.high.is_none_or(|high| high >= 1),
            _ => self.high.is_none(),
        };
        self.low == 0 && all
    }

    /// True if exactly one count is legal.
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

/// The counts of one counter that the rules allow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CounterSet {
    /// The counter's name in the scene.
    pub name: String,
    /// The kind of count.
    pub kind: CounterKind,
    /// The legal counts.
    pub range: CountRange,
}

/// One counter held against both bands.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CounterOutcome {
    /// The counter's name in the scene.
    pub name: String,
    /// The kind of count.
    pub kind: CounterKind,
    /// At least so many are legal.
    pub low: u64,
    /// At most so many are legal; absent where nothing limits it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<u64>,
    /// The count that came back.
    pub actual: u64,
    /// The worst band that the count fell out of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub band: Option<Band>,
}

impl CounterOutcome {
    /// Holds a count against what is legal and what the yardstick wants.
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

    /// The legal counts.
    pub fn range(&self) -> CountRange {
        CountRange {
            low: self.low,
            high: self.high,
        }
    }

    /// True if anything was asserted of the counter.
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
    fn the_worse_band_is_told() {
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
