//! What a verdict says about a driver.

use crate::verdict::Verdict;

/// The meaning of a verdict for a release.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Standing {
    /// The case is drawn correctly.
    Good,
    /// The case is drawn wrong, or the driver fails to draw it.
    Bad,
    /// The case is drawn correctly only some of the time.
    Flaky,
    /// The case is not drawn, or nothing is asserted.
    Unknown,
}

impl Standing {
    /// Returns the standing of a verdict on a case. A selftest that is due to fail is good if it fails, and
    /// bad if its picture is right.
    pub fn of(verdict: Verdict, due_fail: bool) -> Self {
        match Self::from(verdict) {
            Self::Bad if due_fail && verdict.is_violation() => Self::Good,
            Self::Good if due_fail => Self::Bad,
            standing => standing,
        }
    }
}

impl From<Verdict> for Standing {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Pass | Verdict::Imprecise | Verdict::Measured => Self::Good,
            Verdict::Fail
            | Verdict::RequiredByCts
            | Verdict::Disputed
            | Verdict::Crash
            | Verdict::Timeout
            | Verdict::DeviceLost
            | Verdict::ResourceError => Self::Bad,
            Verdict::Flaky => Self::Flaky,
            Verdict::Open
            | Verdict::NotSupported
            | Verdict::Blocked
            | Verdict::Skipped
            | Verdict::InternalError => Self::Unknown,
        }
    }
}
