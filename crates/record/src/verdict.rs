//! The outcome of a case on an adapter.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The outcome of one case on one adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Every texel lies inside the yardstick, and something was asserted.
    Pass,
    /// Every texel is legal, and some lie outside the yardstick: a quality finding, no failure.
    Imprecise,
    /// A texel lies outside what the API's text allows.
    Fail,
    /// Nothing could be asserted.
    Open,
    /// Numbers without judgement.
    Measured,
    /// The adapter lacks something that the scene needs.
    NotSupported,
    /// The expectations forbid drawing the case on this adapter.
    Skipped,
    /// The same case gave different frames.
    Flaky,
    /// The process that drew the case died.
    Crash,
    /// The case took longer than it may.
    Timeout,
    /// The API reported the device lost.
    DeviceLost,
    /// The driver refused an allocation or an object.
    ResourceError,
    /// The suite's own logic failed; says nothing about the driver.
    InternalError,
}

impl Verdict {
    /// Every verdict, in declaration order.
    pub const ALL: [Self; 13] = [
        Self::Pass,
        Self::Imprecise,
        Self::Fail,
        Self::Open,
        Self::Measured,
        Self::NotSupported,
        Self::Skipped,
        Self::Flaky,
        Self::Crash,
        Self::Timeout,
        Self::DeviceLost,
        Self::ResourceError,
        Self::InternalError,
    ];

    /// The verdict's name in records and reports: `not-supported`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Imprecise => "imprecise",
            Self::Fail => "fail",
            Self::Open => "open",
            Self::Measured => "measured",
            Self::NotSupported => "not-supported",
            Self::Skipped => "skipped",
            Self::Flaky => "flaky",
            Self::Crash => "crash",
            Self::Timeout => "timeout",
            Self::DeviceLost => "device-lost",
            Self::ResourceError => "resource-error",
            Self::InternalError => "internal-error",
        }
    }

    /// True if the verdict counts against a run unless it was expected.
    pub fn is_bad(self) -> bool {
        match self {
            Self::Pass | Self::Imprecise | Self::Measured | Self::NotSupported | Self::Skipped => {
                false
            }
            Self::Fail
            | Self::Open
            | Self::Flaky
            | Self::Crash
            | Self::Timeout
            | Self::DeviceLost
            | Self::ResourceError
            | Self::InternalError => true,
        }
    }

    /// True if a frame came back and was compared with its legal set.
    pub fn is_judged(self) -> bool {
        matches!(
            self,
            Self::Pass | Self::Imprecise | Self::Fail | Self::Open | Self::Flaky
        )
    }

    /// The badness of the verdict, for picking the worst of several of one case: larger is worse. A Fail, as
    /// a proof, is worst.
    pub fn severity(self) -> u8 {
        match self {
            Self::Skipped => 0,
            Self::NotSupported => 1,
            Self::Measured => 2,
            Self::Pass => 3,
            Self::Imprecise => 4,
            Self::Open => 5,
            Self::Flaky => 6,
            Self::ResourceError => 7,
            Self::InternalError => 8,
            Self::Timeout => 9,
            Self::Crash => 10,
            Self::DeviceLost => 11,
            Self::Fail => 12,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_serialized_names() {
        for verdict in Verdict::ALL {
            let json = serde_json::to_string(&verdict).unwrap();
            assert_eq!(json, format!("\"{verdict}\""));
        }
    }

    #[test]
    fn severities_differ() {
        let mut all: Vec<u8> = Verdict::ALL.iter().map(|v| v.severity()).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), Verdict::ALL.len());
    }
}
