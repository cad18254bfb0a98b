//! Three-valued answers: whether something happens under the rules.

/// The degree to which something can happen under the rules, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Possible {
    /// The event happens under no reading.
    Never,
    /// The event happens under some readings.
    Maybe,
    /// The event happens under all readings.
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

    /// Returns true if the event can happen.
    pub(crate) fn can(self) -> bool {
        self != Self::Never
    }

    /// Returns true if the event must happen.
    pub(crate) fn must(self) -> bool {
        self == Self::Always
    }

    /// Returns whether this event and another one both happen.
    pub(crate) fn and(self, other: Self) -> Self {
        self.min(other)
    }
}

#[cfg(test)]
mod tests {
    use super::Possible::{self, Always, Maybe, Never};

    #[test]
    fn two_events_both_happen_only_if_each_does() {
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
