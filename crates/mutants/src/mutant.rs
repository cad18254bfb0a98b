//! A planted change of the rasterizer: a bug, or what some specification permits.

use crate::permission::UsedPermission;
use crate::plant::Plant;
use etalon_backend::Backend;
use etalon_cpu::CpuBackend;
use etalon_frame::{Grade, Limits};
use etalon_reference::Rules;

/// A planted change.
#[derive(Debug)]
pub struct Mutant {
    /// The stable name, its class first: `depth/write-ignored`.
    pub name: String,
    /// The effect, in one sentence.
    pub about: String,
    /// The driver that had the bug, or the kind of mistake.
    pub source: &'static str,
    /// The area whose cases alone must catch the bug.
    pub area: &'static str,
    /// The permissions that it uses; none if no specification permits it.
    pub permissions: Vec<UsedPermission>,
    /// Sets the limits that a driver that behaves so reports.
    pub(super) reports: Option<fn(&mut Limits)>,
    /// True if it is no bug where a specification forbids it: no driver's bug is known to be of its kind.
    pub(super) is_innocent_alone: bool,
    pub(super) plant: Plant,
}

impl Mutant {
    /// Returns the limits of an adapter that behaves so.
    pub(super) fn reported(&self, mut limits: Limits) -> Limits {
        if let Some(reports) = self.reports {
            reports(&mut limits);
        }
        limits
    }

    /// Returns the strongest evidence of a specification that forbids the change; `None` if it is permitted.
    pub(super) fn forbidden_by(&self, rules: &Rules) -> Option<Grade> {
        if self.permissions.is_empty() {
            return Some(Grade::Proven);
        }
        let each = self.permissions.iter();
        each.filter_map(|used| used.forbidden_by(rules)).max()
    }

    /// Returns true if the suite must catch the change.
    pub(super) fn is_bug(&self) -> bool {
        !self.is_innocent_alone && !self.is_legal()
    }

    /// Returns true if the specification that binds the rasterizer permits the change.
    fn is_legal(&self) -> bool {
        let limits = || CpuBackend::spans("cpu").limits().clone();
        let is_permitted = |limits| self.forbidden_by(&Rules::of(&limits)).is_none();
        !self.permissions.is_empty() && is_permitted(self.reported(limits()))
    }
}
