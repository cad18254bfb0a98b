//! The outcome of a case on an adapter.

use etalon_frame::{Band, ErrorKind, state_enum};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The outcome of one case on one adapter.
    Verdict: array {
        /// Every texel is inside the yardstick, and something was asserted.
        Pass = "pass",
        /// Every texel is legal, and some are outside the yardstick: a quality finding, not a failure.
        Imprecise = "imprecise",
        /// A texel is outside the values that the API's specification allows.
        Fail = "fail",
        /// The specification is open, but a case of the Khronos CTS's mustpass lists forbids a texel.
        RequiredByCts = "required-by-cts",
        /// Only a contested reading of the specification forbids a texel.
        Disputed = "disputed",
        /// Nothing could be asserted.
        Open = "open",
        /// Numbers without a judgement.
        Measured = "measured",
        /// The adapter lacks something that the scene needs.
        NotSupported = "not-supported",
        /// Not drawn, because a case failed that it depends on: a round trip, or what the API's version requires.
        Blocked = "blocked",
        /// The expectations forbid drawing the case on this adapter.
        Skipped = "skipped",
        /// The same case gave different frames.
        Flaky = "flaky",
        /// The process that drew the case died.
        Crash = "crash",
        /// The case took longer than its time limit.
        Timeout = "timeout",
        /// The API reported that the device was lost.
        DeviceLost = "device-lost",
        /// The driver refused an allocation or an object.
        ResourceError = "resource-error",
        /// The suite's own logic failed; this says nothing about the driver.
        InternalError = "internal-error",
    }
}

impl Verdict {
    /// Returns the verdict on a case whose backend failed with an error of this kind.
    pub fn of_error(kind: &ErrorKind) -> Self {
        match kind {
            ErrorKind::DeviceLost => Self::DeviceLost,
            ErrorKind::Resource { .. } => Self::ResourceError,
            ErrorKind::Shader(_) | ErrorKind::Internal { .. } => Self::InternalError,
        }
    }

    /// Returns the verdict on a texel that is outside a band.
    pub fn of_band(band: Band) -> Self {
        match band {
            Band::Imprecise => Self::Imprecise,
            Band::Disputed => Self::Disputed,
            Band::RequiredByCts => Self::RequiredByCts,
            Band::Fail => Self::Fail,
        }
    }

    /// Returns true if the verdict counts against a run unless it was expected.
    pub fn is_bad(self) -> bool {
        match self {
            Self::Pass | Self::Imprecise | Self::Measured | Self::NotSupported | Self::Skipped => {
                false
            }
            Self::Fail
            | Self::RequiredByCts
            | Self::Disputed
            | Self::Blocked
            | Self::Open
            | Self::Flaky
            | Self::Crash
            | Self::Timeout
            | Self::DeviceLost
            | Self::ResourceError
            | Self::InternalError => true,
        }
    }

    /// Returns true if a texel is outside the values that the rules allow, whatever the grade of the
    /// evidence.
    pub fn is_violation(self) -> bool {
        matches!(self, Self::Fail | Self::RequiredByCts | Self::Disputed)
    }

    /// Returns true if a frame came back and was compared with its legal set.
    pub fn is_judged(self) -> bool {
        matches!(
            self,
            Self::Pass
                | Self::Imprecise
                | Self::Fail
                | Self::RequiredByCts
                | Self::Disputed
                | Self::Open
                | Self::Flaky
        )
    }

    /// Returns how much the verdict weighs, for choosing which of several drawings of a case a record shows,
    /// and the order of lists. `Fail` weighs most, because it is a proof. What a step from one run to another
    /// means is decided by [`Change`](crate::Change) instead.
    pub fn severity(self) -> u8 {
        match self {
            Self::Skipped => 0,
            Self::NotSupported => 1,
            Self::Measured => 2,
            Self::Pass => 3,
            Self::Imprecise => 4,
            Self::Open => 5,
            Self::Blocked => 6,
            Self::Flaky => 7,
            Self::ResourceError => 8,
            Self::InternalError => 9,
            Self::Timeout => 10,
            Self::Crash => 11,
            Self::DeviceLost => 12,
            Self::Disputed => 13,
            Self::RequiredByCts => 14,
            Self::Fail => 15,
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
        let mut severities: Vec<u8> = Verdict::ALL.iter().map(|v| v.severity()).collect();
        severities.sort_unstable();
        severities.dedup();
        assert_eq!(severities.len(), Verdict::ALL.len());
    }
}
