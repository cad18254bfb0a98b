//! The outcome of a case on an adapter.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The outcome of one case on one adapter.
    Verdict: array {
        /// Every texel lies inside the yardstick, and something was asserted.
        Pass = "pass",
        /// Every texel is legal, and some lie outside the yardstick: a quality finding, no failure.
        Imprecise = "imprecise",
        /// A texel lies outside what the API's text allows.
        Fail = "fail",
        /// Nothing could be asserted.
        Open = "open",
        /// Numbers without judgement.
        Measured = "measured",
        /// The adapter lacks something that the scene needs.
        NotSupported = "not-supported",
        /// The expectations forbid drawing the case on this adapter.
        Skipped = "skipped",
        /// The same case gave different frames.
        Flaky = "flaky",
        /// The process that drew the case died.
        Crash = "crash",
        /// The case took longer than it may.
        Timeout = "timeout",
        /// The API reported the device lost.
        DeviceLost = "device-lost",
        /// The driver refused an allocation or an object.
        ResourceError = "resource-error",
        /// The suite's own logic failed; says nothing about the driver.
        InternalError = "internal-error",
    }
}

impl Verdict {
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
