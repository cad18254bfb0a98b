//! Whether something happens, as far as the rules tell.

/// Whether something happens, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Possible {
    /// Under no reading of the rules.
    Never,
    /// Under some.
    Maybe,
    /// Under all.
    Always,
}

impl Possible {
    /// Returns the possibility of what can happen, and must where `must` is true.
    pub(crate) fn of(can: bool, must: bool) -> Self {
        match (can, must) {
            (_, true) => Self::Always,
            (true, false) => Self::Maybe,
            (false, false) => Self::Never,
        }
    }

    /// True if it can happen.
    pub(crate) fn can(self) -> bool {
        self != Self::Never
    }

    /// True if it must happen.
    pub(crate) fn must(self) -> bool {
        self == Self::Always
    }

    /// Returns the possibility that this and another thing happen.
    pub(crate) fn and(self, other: Self) -> Self {
        self.min(other)
    }
}

#[cfg(test)]
mod tests {
    use super::Possible::{self, Always, Maybe, Never};

    #[test]
    fn both_happen_if_each_does() {
        for (a, b, both) in [
            (Always, Always, Always),
            (Always, Maybe, Maybe),
            (Maybe, Never, Never),
        ] {
            assert_eq!((a.and(b), b.and(a)), (both, both));
        }
        assert_eq!(Possible::of(true, false), Maybe);
        assert!(Maybe.can() && !Maybe.must() && !Never.can() && Always.must());
    }
}
