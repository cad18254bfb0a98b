//! Closed intervals of real numbers.

use etalon_frame::{ChannelEncoding, CodeInterval, ValueRange};

/// The real numbers from `low` to `high`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

impl Interval {
    /// All values, including infinities and NaN.
    pub const EVERYTHING: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Returns true if the values can include NaN.
    #[inline]
    pub fn may_be_nan(self) -> bool {
        self == Self::EVERYTHING
    }

    /// Returns the interval of one number.
    #[inline]
    pub const fn exact(value: f64) -> Self {
        Self {
            low: value,
            high: value,
        }
    }

    /// Returns the interval between two numbers, in either order.
    #[inline]
    pub fn between(a: f64, b: f64) -> Self {
        Self {
            low: a.min(b),
            high: a.max(b),
        }
    }

    /// Returns the values of an interval of codes; all values if the codes include a NaN.
    #[inline]
    pub fn of_codes(encoding: ChannelEncoding, codes: CodeInterval) -> Self {
        let low = encoding.value_of_order(codes.low);
        let high = if codes.is_exact() {
            low
        } else {
            encoding.value_of_order(codes.high)
        };
        if low.is_nan() || high.is_nan() {
            return Self::EVERYTHING;
        }
        Self { low, high }
    }

    /// Returns true if the interval is exactly this number.
    #[inline]
    pub fn is(self, value: f64) -> bool {
        self.low == value && self.high == value
    }

    /// Returns true if the number is inside.
    #[inline]
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Returns the smallest interval that contains both.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Applies an increasing function.
    #[inline]
    pub fn map_increasing(self, f: impl Fn(f64) -> f64) -> Self {
        Self {
            low: f(self.low),
            high: f(self.high),
        }
    }

    /// Applies a function that is monotone in each argument alone, so that its extremes are at corners. If a
    /// corner is NaN, as from an infinite end, the result is all values.
    #[inline]
    pub fn corners(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let values = [
            f(self.low, other.low),
            f(self.low, other.high),
            f(self.high, other.low),
            f(self.high, other.high),
        ];
        if values.iter().any(|v| v.is_nan()) {
            return Self::EVERYTHING;
        }
        Self {
            low: values.iter().copied().fold(f64::INFINITY, f64::min),
            high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Applies the minimum or the maximum. Whether either of them passes a NaN on is not specified.
    #[inline]
    pub fn selected(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        if self.may_be_nan() || other.may_be_nan() {
            return Self::EVERYTHING;
        }
        self.corners(other, f)
    }

    /// Returns the interval of sums.
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        Self::of_ends(self.low + other.low, self.high + other.high)
    }

    /// Returns the interval of differences.
    #[inline]
    pub fn minus(self, other: Self) -> Self {
        Self::of_ends(self.low - other.high, self.high - other.low)
    }

    /// Returns the interval of products.
    #[inline]
    pub fn times(self, other: Self) -> Self {
        if self.low >= 0.0 && other.low >= 0.0 {
            return Self::of_ends(self.low * other.low, self.high * other.high);
        }
        self.corners(other, |a, b| a * b)
    }

    /// Returns the interval between two ends; all values if one of them is NaN.
    #[inline]
    fn of_ends(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::EVERYTHING;
        }
        Self { low, high }
    }

    /// Widens each end by a fraction of its magnitude; zero and infinities stay unchanged.
    #[inline]
    pub fn widen_relative(self, share: f64) -> Self {
        Self {
            low: widened(self.low, -self.low.abs() * share),
            high: widened(self.high, self.high.abs() * share),
        }
    }

    /// Widens each end by an amount; infinities stay unchanged.
    #[inline]
    pub fn widen(self, amount: f64) -> Self {
        Self {
            low: widened(self.low, -amount),
            high: widened(self.high, amount),
        }
    }

    /// Returns the results of a step that may be computed in 32-bit floats: an end beyond the greatest finite
    /// float can be infinite.
    #[inline]
    pub fn may_overflow(self) -> Self {
        self.may_exceed(f64::from(f32::MAX))
    }

    /// Returns the results of a step that may be computed in a format with this greatest number: an end
    /// beyond it can be infinite.
    #[inline]
    pub fn may_exceed(self, greatest: f64) -> Self {
        Self {
            low: if self.low < -greatest {
                f64::NEG_INFINITY
            } else {
                self.low
            },
            high: if self.high > greatest {
                f64::INFINITY
            } else {
                self.high
            },
        }
    }

    /// Returns the results of a step that may be computed in 32-bit floats without subnormal numbers: a result
    /// below the least normal one can be 0. The specifications promise a relative accuracy and no subnormal
    /// numbers (OpenGL 4.6 and OpenGL ES 3.2, 2.3.4.1; Vulkan, Floating-Point Computation).
    #[inline]
    pub fn may_underflow(self) -> Self {
        let least = f64::from(f32::MIN_POSITIVE);
        if self.low < least && self.high > -least {
            self.hull(Self::exact(0.0))
        } else {
            self
        }
    }

    /// Clamps both ends to another interval.
    #[inline]
    pub fn clamp_to(self, other: Self) -> Self {
        self.clamp(other.low, other.high)
    }

    /// Clamps a number to a range. No specification says what a clamp makes of NaN, and a computation without NaN may
    /// yield anything for it (Vulkan, Floating-Point Computation; OpenGL 4.6, 2.3.4.1), so NaN stays open.
    #[inline]
    pub fn clamp_number(self, low: f64, high: f64) -> Self {
        if self.may_be_nan() {
            self
        } else {
            self.clamp(low, high)
        }
    }

    /// Clamps both ends to a range.
    #[inline]
    pub fn clamp(self, low: f64, high: f64) -> Self {
        self.map_increasing(|v| v.clamp(low, high))
    }
}

impl From<Interval> for ValueRange {
    fn from(interval: Interval) -> Self {
        Self {
            low: interval.low,
            high: interval.high,
        }
    }
}

/// The least and the greatest value of each of several lanes, which one instruction computes.
pub(crate) struct Lanes<const N: usize> {
    least: [f64; N],
    most: [f64; N],
}

impl<const N: usize> Lanes<N> {
    /// Returns lanes without a value.
    #[inline]
    pub(crate) fn new() -> Self {
        Self {
            least: [f64::INFINITY; N],
            most: [f64::NEG_INFINITY; N],
        }
    }

    #[inline]
    pub(crate) fn add(&mut self, lane: usize, value: f64) {
        self.least[lane] = lesser(self.least[lane], value);
        self.most[lane] = -lesser(-self.most[lane], -value);
    }

    /// Returns the least value of all lanes.
    #[inline]
    pub(crate) fn least(&self) -> f64 {
        self.least.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Returns the hull of all lanes.
    #[inline]
    pub(crate) fn hull(&self) -> Interval {
        Interval {
            low: self.least(),
            high: self.most.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// Returns the lesser of two numbers in one instruction, unlike [`f64::min`].
#[inline]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// Returns an end plus an amount; infinite ends stay unchanged.
#[inline]
fn widened(end: f64, amount: f64) -> f64 {
    if end.is_infinite() { end } else { end + amount }
}
