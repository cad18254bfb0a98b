//! The values that a number can have, by way of computing.

use crate::interval::Interval;
use etalon_frame::ValueRange;

/// The values that the permitted ways of computing can reach.
///
/// A blend may be computed in floating-point throughout, or with every result rounded to a neighbouring code
/// of the destination, or to a neighbouring binary fraction with as many bits. The three are kept separate: if
/// they were joined early, the error of one would be added to the rounding of another, and the set would be
/// wider than any reading of the specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Results in floating-point of at least the minimum precision.
    pub float: Interval,
    /// Results that are rounded to destination codes at every step.
    pub codes: Interval,
    /// Results that are rounded to binary fractions at every step.
    pub fixed: Interval,
}

impl From<Range> for ValueRange {
    fn from(range: Range) -> Self {
        range.hull().into()
    }
}

impl Range {
    /// Returns exactly one value.
    #[inline]
    pub fn exact(value: f64) -> Self {
        Self::same(Interval::exact(value))
    }

    /// Returns the same interval for all ways of computing.
    #[inline]
    pub fn same(interval: Interval) -> Self {
        Self {
            float: interval,
            codes: interval,
            fixed: interval,
        }
    }

    /// Returns the values of all ways of computing.
    #[inline]
    pub fn hull(self) -> Interval {
        if self.is_same() {
            self.float
        } else {
            self.float.hull(self.codes).hull(self.fixed)
        }
    }

    /// Returns true if all ways of computing have the same values.
    #[inline]
    pub(crate) fn is_same(self) -> bool {
        self.codes == self.float && self.fixed == self.float
    }

    #[inline]
    pub(crate) fn zip(self, other: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        let float = f(self.float, other.float);
        if self.is_same() && other.is_same() {
            return Self::same(float);
        }
        Self {
            float,
            codes: f(self.codes, other.codes),
            fixed: f(self.fixed, other.fixed),
        }
    }

    /// Returns the values of a function of each way.
    #[inline]
    pub(crate) fn map(self, f: impl Fn(Interval) -> Interval) -> Self {
        self.zip(self, |value, _| f(value))
    }
}
