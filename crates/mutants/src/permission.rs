//! The permissions that a change of the rasterizer uses.

use etalon_frame::Grade;
use etalon_reference::Rules;

/// A permission that a change uses: where the rules grant it, the change is legal.
#[derive(Clone, Copy, Debug)]
pub struct UsedPermission {
    /// The name, a field of [`Rules`].
    pub name: &'static str,
    pub(super) granted: fn(&Rules) -> bool,
}

impl UsedPermission {
    /// Returns the strongest evidence that forbids the change; `None` if the rules grant the permission.
    pub fn forbidden_by(&self, rules: &Rules) -> Option<Grade> {
        let forbids = |grade: &Grade| !(self.granted)(&rules.bound_by(*grade));
        Grade::ALL.into_iter().rev().find(forbids)
    }
}

/// Returns a permission that is granted where the value of a field of [`Rules`] matches a pattern, or where that of
/// another one does.
macro_rules! under {
    ($field:ident: true) => {
        $crate::permission::UsedPermission {
            name: stringify!($field),
            granted: |rules| rules.$field.value(),
        }
    };
    ($field:ident: false $(, or $other:ident: false)?) => {
        $crate::permission::UsedPermission {
            name: stringify!($field),
            granted: |rules| !rules.$field.value() $(|| !rules.$other.value())?,
        }
    };
    ($field:ident: $granted:pat, or $other:ident: $also:pat) => {
        $crate::permission::UsedPermission {
            name: stringify!($field),
            granted: |rules| matches!(rules.$field.value(), $granted) || matches!(rules.$other.value(), $also),
        }
    };
    ($field:ident: $($pattern:tt)+) => {
        $crate::permission::UsedPermission {
            name: stringify!($field),
            granted: |rules| matches!(rules.$field.value(), $($pattern)+),
        }
    };
}

pub(super) use under;
