//! Rounding of numbers to neighbouring codes, fractions and floats, on either side.

use crate::interval::Interval;
use etalon_frame::{ChannelEncoding, CodeInterval};

/// A code position this near to an integer counts as the integer, because of the rounding of 64-bit floats.
/// No 32-bit float times 255 comes this near to an integer unless it is one (the least distance is 2^-31).
pub(crate) const INTEGER_SLACK: f64 = 1e-10;

/// Widens to a normalized encoding's codes on either side.
#[inline]
pub(crate) fn to_codes(encoding: ChannelEncoding, value: Interval) -> Interval {
    to_steps(encoding.max_order() as f64, value)
}

/// Widens to multiples of one over `steps` on either side.
#[inline]
pub(crate) fn to_steps(steps: f64, value: Interval) -> Interval {
    // Rounding up is rounding down of the negated number.
    let [low, high] =
        [value.low, -value.high].map(|end| floor(end * steps + INTEGER_SLACK) / steps);
    Interval { low, high: -high }
}

/// Returns the largest integer that is not above a number. [`f64::floor`] is a call of a function on x86
/// processors without SSE4.1.
#[inline]
pub(crate) fn floor(value: f64) -> f64 {
    // Numbers of this size are integers, so adding it rounds to the nearest integer.
    const ROUND: f64 = 1.5 * (1_u64 << 52) as f64;
    if value.abs() >= (1_u64 << 51) as f64 {
        return value.floor();
    }
    let nearest = (value + ROUND) - ROUND;
    if nearest > value {
        nearest - 1.0
    } else {
        nearest
    }
}

/// Returns the smallest integer that is not below a number.
#[inline]
pub(crate) fn ceil(value: f64) -> f64 {
    -floor(-value)
}

/// Widens to the nearest floats on either side with `bits` significand bits.
#[inline]
pub(crate) fn to_significand(bits: u32, value: Interval) -> Interval {
    let unit = 1_u64 << (f64::MANTISSA_DIGITS - bits);
    let towards_zero = |v: f64| f64::from_bits(v.to_bits() & !(unit - 1));
    let away = |v: f64| {
        let truncated = towards_zero(v);
        if truncated == v {
            v
        } else {
            f64::from_bits(truncated.to_bits() + unit)
        }
    };
    Interval {
        low: if value.low < 0.0 {
            away(value.low)
        } else {
            towards_zero(value.low)
        },
        high: if value.high < 0.0 {
            towards_zero(value.high)
        } else {
            away(value.high)
        },
    }
}

/// Widens to the nearest 16-bit floats on either side; subnormal ones may be missing.
pub(crate) fn to_half(value: Interval) -> Interval {
    let half = ChannelEncoding::Float16;
    let normal = 1 << 10;
    let (low, high) = (half.order_below(value.low), half.order_above(value.high));
    let low = if (0..normal).contains(&low) { 0 } else { low };
    let high = if (1 - normal..=0).contains(&high) {
        0
    } else {
        high
    };
    Interval {
        low: half.value_of_order(low).min(value.low),
        high: half.value_of_order(high).max(value.high),
    }
}

/// Returns the order of the largest unsigned float that is not above a value: finite for a finite one.
pub(crate) fn towards_zero(encoding: ChannelEncoding, value: f64) -> i64 {
    let most = encoding.max_order();
    if value == f64::INFINITY {
        most + 1
    } else if value <= 0.0 {
        0
    } else if value >= encoding.value_of_order(most) {
        most
    } else {
        encoding.order_below(value)
    }
}

/// Returns the order of the nearest unsigned float, the larger one of a tie: finite for a finite value.
pub(crate) fn nearest(encoding: ChannelEncoding, value: f64) -> i64 {
    let below = towards_zero(encoding, value);
    if below >= encoding.max_order() || value <= 0.0 {
        return below;
    }
    let [low, high] = [below, below + 1].map(|order| encoding.value_of_order(order));
    if value - low < high - value {
        below
    } else {
        below + 1
    }
}

/// Returns all codes of a float encoding, including infinities and NaN.
pub(crate) fn all_codes(encoding: ChannelEncoding) -> CodeInterval {
    match encoding {
        ChannelEncoding::Ufloat(mantissa) => CodeInterval::new(0, (32 << mantissa) - 1),
        ChannelEncoding::Float16 => CodeInterval::new(-0x7fff, 0x7fff),
        _ => CodeInterval::new(-0x7fff_ffff, 0x7fff_ffff),
    }
}

/// Returns the order of the largest 32-bit float not above a value.
pub(crate) fn order_below(value: f64) -> i64 {
    let encoding = ChannelEncoding::Float32;
    let order = encoding.order_of_code((value as f32).to_bits());
    if encoding.value_of_order(order) > value {
        order - 1
    } else {
        order
    }
}

/// Returns the order of the smallest 32-bit float not below a value.
pub(crate) fn order_above(value: f64) -> i64 {
    let encoding = ChannelEncoding::Float32;
    let order = encoding.order_of_code((value as f32).to_bits());
    if encoding.value_of_order(order) < value {
        order + 1
    } else {
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floor_and_ceil_are_those_of_the_standard_library() {
        let two_51 = (1_u64 << 51) as f64;
        let large = [
            two_51 - 0.25,
            two_51 + 0.5,
            2.0 * two_51,
            1e300,
            f64::INFINITY,
        ];
        let small = [
            0.0,
            1e-300,
            0.25,
            0.5,
            0.75,
            1.0,
            1.5,
            2.5,
            254.999_999_999_99,
        ];
        for value in small.into_iter().chain(large) {
            for value in [value, -value] {
                assert_eq!(floor(value), value.floor(), "{value}");
                assert_eq!(ceil(value), value.ceil(), "{value}");
            }
        }
        assert!(floor(f64::NAN).is_nan());
    }

    #[test]
    fn short_significands_widen_an_interval_on_both_sides() {
        let widened = |low, high| to_significand(2, Interval { low, high });
        for (low, high, outer) in [
            (0.3, 0.3, (0.25, 0.375)),
            (-0.3, 0.3, (-0.375, 0.375)),
            (-0.3, -0.3, (-0.375, -0.25)),
            (0.5, 0.75, (0.5, 0.75)),
            (0.9, 0.9, (0.75, 1.0)),
            (0.0, 0.0, (0.0, 0.0)),
        ] {
            let (low, high) = (widened(low, high).low, widened(low, high).high);
            assert_eq!((low, high), outer);
        }
    }
}
