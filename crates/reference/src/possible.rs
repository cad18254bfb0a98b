//! Whether something happens under the rules.

/// Whether something happens under the rules, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Possible {
    /// Under no reading.
    Never,
    /// Under some readings.
    Maybe,
    /// Under all readings.
    Always,
}

impl Possible {
    /// Returns whether something happens that can happen if `can` is true, and must if `must` is true.
    pub(crate) fn of(can: bool, must: bool) -> Self {
        match (can, must) {
            (_, true) => Self::Always,
            (true, false) => Self::Maybe,
            (false, false) => Self::Never,
        }
    }

    /// Returns true if it can happen.
    pub(crate) fn can(self) -> bool {
        self != Self::Never
    }

    /// Returns true if it must happen.
    pub(crate) fn must(self) -> bool {
        self == Self::Always
    }

    /// Returns whether both this and another thing happen.
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
