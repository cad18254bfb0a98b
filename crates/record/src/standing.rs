//! The meaning of a verdict for a driver.

use crate::verdict::Verdict;
use etalon_stats::Standing;

impl Verdict {
    /// Returns its meaning for a case. A selftest that is due to fail is good if it fails, and bad if its picture is
    /// right.
    pub fn standing(self, due_fail: bool) -> Standing {
        match Standing::from(self) {
            Standing::Bad if due_fail && self.is_violation() => Standing::Good,
            Standing::Good if due_fail => Standing::Bad,
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
