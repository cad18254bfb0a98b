//! The encodings of a texel's channels.

use half::f16;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::LazyLock;

/// The encoding of one channel: the mapping between codes and values.
///
/// A *code* is the channel's bit pattern in the low bits of a `u32`. Its *order* is an integer that grows with
/// the code's value, by one from each code to the next. Intervals of values are therefore intervals of
/// integers, and distances are counted in codes (ULPs for floats).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChannelEncoding {
    /// Unsigned normalized integer of this many bits: code `c` has the value `c / (2^bits - 1)`.
    Unorm(u8),
    /// Signed normalized integer of this many bits in two's complement: code `c` has the value `max(c /
    /// (2^(bits - 1) - 1), -1)`, so -1 has two codes.
    Snorm(u8),
    /// 8-bit unsigned normalized integer that encodes a linear value in sRGB (IEC 61966-2-1).
    Srgb8,
    /// Unsigned integer of this many bits.
    Uint(u8),
    /// IEEE 754 binary16.
    Float16,
    /// IEEE 754 binary32.
    Float32,
    /// Unsigned float of 5 exponent bits and this many mantissa bits.
    Ufloat(u8),
}

impl ChannelEncoding {
    /// Returns the width of a code in bits.
    pub fn bits(self) -> u32 {
        match self {
            Self::Unorm(bits) | Self::Snorm(bits) | Self::Uint(bits) => u32::from(bits),
            Self::Srgb8 => 8,
            Self::Float16 => 16,
            Self::Float32 => 32,
            Self::Ufloat(mantissa) => u32::from(mantissa) + 5,
        }
    }

    /// Returns the mask of a code's bits.
    pub fn mask(self) -> u32 {
        u32::MAX >> (32 - self.bits().clamp(1, 32))
    }

    /// Returns the size of the range in codes: for a normalized or integer encoding, the whole range; for a
    /// float, from one power of two to the next.
    pub fn range(self) -> f64 {
        match self {
            Self::Unorm(bits) | Self::Uint(bits) => f64::from(bits).exp2() - 1.0,
            Self::Snorm(bits) => f64::from(bits).exp2() - 2.0,
            Self::Srgb8 => 255.0,
            Self::Float16 => 10_f64.exp2(),
            Self::Float32 => 23_f64.exp2(),
            Self::Ufloat(mantissa) => f64::from(mantissa).exp2(),
        }
    }

    /// Returns the largest order of any finite code.
    #[inline]
    pub fn max_order(self) -> i64 {
        match self {
            Self::Unorm(bits) | Self::Uint(bits) => (1_i64 << bits) - 1,
            Self::Snorm(bits) => (1_i64 << (bits - 1)) - 1,
            Self::Srgb8 => 255,
            Self::Float16 => i64::from(f16::MAX.to_bits()),
            Self::Float32 => i64::from(f32::MAX.to_bits()),
            Self::Ufloat(mantissa) => (31 << mantissa) - 1,
        }
    }

    /// Returns the smallest order of any finite code.
    #[inline]
    pub fn min_order(self) -> i64 {
        match self {
            Self::Unorm(_) | Self::Uint(_) | Self::Srgb8 | Self::Ufloat(_) => 0,
            Self::Snorm(_) => -self.max_order() - 1,
            Self::Float16 | Self::Float32 => -self.max_order(),
        }
    }

    /// Returns the order of the smallest normal value above 0; 0 for encodings without subnormal values.
    #[inline]
    pub fn least_normal_order(self) -> i64 {
        match self {
            Self::Ufloat(mantissa) => 1 << mantissa,
            Self::Float16 => 1 << 10,
            Self::Float32 => 1 << 23,
            Self::Unorm(_) | Self::Uint(_) | Self::Srgb8 | Self::Snorm(_) => 0,
        }
    }

    /// Returns true if the encoding is a float.
    #[inline]
    pub fn is_float(self) -> bool {
        matches!(self, Self::Float16 | Self::Float32 | Self::Ufloat(_))
    }

    /// Returns the range of values of a normalized encoding; `None` for floats and integers.
    #[inline]
    pub fn normalized_range(self) -> Option<(f32, f32)> {
        match self {
            Self::Unorm(_) | Self::Srgb8 => Some((0.0, 1.0)),
            Self::Snorm(_) => Some((-1.0, 1.0)),
            Self::Uint(_) | Self::Float16 | Self::Float32 | Self::Ufloat(_) => None,
        }
    }

    /// Returns the order of a code. Both float zeros have order 0: the specifications leave the sign of zero
    /// open (SPIR-V's default float controls; OpenGL 4.6, 2.3.4.1).
    #[inline]
    pub fn order_of_code(self, code: u32) -> i64 {
        let signed = |magnitude: u32, negative: bool| {
            let magnitude = i64::from(magnitude);
            if negative { -magnitude } else { magnitude }
        };
        match self {
            Self::Unorm(_) | Self::Uint(_) | Self::Srgb8 | Self::Ufloat(_) => i64::from(code),
            Self::Snorm(bits) => {
                let shift = 32 - u32::from(bits);
                i64::from(((code << shift) as i32) >> shift)
            }
            Self::Float16 => signed(code & 0x7fff, code & 0x8000 != 0),
            Self::Float32 => signed(code & 0x7fff_ffff, code >> 31 != 0),
        }
    }

    /// Returns the code of an order, the inverse of [`ChannelEncoding::order_of_code`].
    #[inline]
    pub fn code_of_order(self, order: i64) -> u32 {
        let magnitude = u32::try_from(order.unsigned_abs()).unwrap_or(u32::MAX);
        match self {
            Self::Unorm(_) | Self::Uint(_) | Self::Srgb8 | Self::Ufloat(_) => magnitude,
            Self::Snorm(bits) => (order as u32) & ((1 << bits) - 1),
            Self::Float16 if order < 0 => magnitude | 0x8000,
            Self::Float32 if order < 0 => magnitude | 0x8000_0000,
            Self::Float16 | Self::Float32 => magnitude,
        }
    }

    /// Returns the value of the code with this order; for sRGB, the linear value.
    #[inline]
    pub fn value_of_order(self, order: i64) -> f64 {
        match self {
            Self::Unorm(_) => order as f64 / self.max_order() as f64,
            Self::Snorm(_) => (order as f64 / self.max_order() as f64).max(-1.0),
            Self::Srgb8 => linear_of_half_codes(2 * order),
            Self::Uint(_) => order as f64,
            Self::Float16 if order < 0 => -small_float(HALF_MANTISSA, order.unsigned_abs()),
            Self::Float16 => small_float(HALF_MANTISSA, order.unsigned_abs()),
            Self::Float32 => f64::from(f32::from_bits(self.code_of_order(order))),
            Self::Ufloat(mantissa) => small_float(mantissa, order.unsigned_abs()),
        }
    }

    /// Returns the position of a value on the scale of orders, not rounded: the scale times the value; for
    /// sRGB, times the encoded value. `None` for encodings whose codes are not equidistant.
    #[inline]
    pub fn position(self, value: f64) -> Option<f64> {
        match self {
            Self::Unorm(_) | Self::Snorm(_) => Some(value * self.max_order() as f64),
            Self::Srgb8 => Some(linear_to_srgb(value) * 255.0),
            Self::Uint(_) => Some(value),
            Self::Float16 | Self::Float32 | Self::Ufloat(_) => None,
        }
    }

    /// Returns the code whose value is nearest to a number; an end of the range if it is out of range.
    pub fn nearest_code(self, value: f64) -> u32 {
        if let Some(position) = self.position(value) {
            let (low, high) = (self.least_converted() as f64, self.max_order() as f64);
            return self.code_of_order(position.round().clamp(low, high) as i64);
        }
        let (below, above) = (self.order_below(value), self.order_above(value));
        let distance = |order: i64| (self.value_of_order(order) - value).abs();
        let nearest = if distance(below) <= distance(above) {
            below
        } else {
            above
        };
        self.code_of_order(nearest)
    }

    /// Returns the largest order whose value is not above a number; the lowest if all are above it.
    #[inline]
    pub fn order_below(self, value: f64) -> i64 {
        if let Some([below, _]) = self.neighbours(value) {
            return below;
        }
        self.search(value, |order| self.value_of_order(order) <= value)
    }

    /// Returns the smallest order whose value is not below a number; the highest if all are below it.
    #[inline]
    pub fn order_above(self, value: f64) -> i64 {
        if let Some([_, above]) = self.neighbours(value) {
            return above;
        }
        let below = self.search(value, |order| self.value_of_order(order) < value);
        match self.value_of_order(below) {
            v if v >= value => below,
            _ => (below + 1).min(self.max_order()),
        }
    }

    /// Returns the orders on either side of a number, for floats with 5 exponent bits; `None` for other
    /// encodings and for NaN.
    fn neighbours(self, value: f64) -> Option<[i64; 2]> {
        let mantissa = match self {
            Self::Float16 => HALF_MANTISSA,
            Self::Ufloat(mantissa) => mantissa,
            _ => return None,
        };
        if value.is_nan() {
            return None;
        }
        let [inner, outer] = magnitudes(mantissa, value.abs());
        let orders = if value < 0.0 {
            [-outer, -inner]
        } else {
            [inner, outer]
        };
        Some(orders.map(|order| order.clamp(self.min_order(), self.max_order())))
    }

    /// Returns the smallest order to which a number is converted: for -1, which has two codes, the upper one.
    fn least_converted(self) -> i64 {
        match self {
            Self::Snorm(_) => -self.max_order(),
            _ => self.min_order(),
        }
    }

    /// Returns an order near that of a number, if there is a cheap way to find one.
    fn guess(self, value: f64) -> Option<i64> {
        match self {
            // The cast saturates.
            Self::Unorm(_) | Self::Snorm(_) => Some((value * self.max_order() as f64) as i64),
            Self::Uint(_) => Some(value as i64),
            Self::Float32 => Some(self.order_of_code((value as f32).to_bits())),
            Self::Srgb8 | Self::Float16 | Self::Ufloat(_) => None,
        }
    }

    /// Returns the largest order that satisfies a condition, which must be true up to some order near that of
    /// a number and false beyond it.
    fn search(self, value: f64, holds: impl Fn(i64) -> bool) -> i64 {
        let (mut low, mut high) = (self.least_converted(), self.max_order());
        if let Some(guess) = self.guess(value) {
            let near =
                (guess.clamp(low, high) - 2).max(low)..(guess.clamp(low, high) + 2).min(high);
            let is_below = near.start == low || holds(near.start);
            if is_below && (near.end == high || !holds(near.end + 1)) {
                (low, high) = (near.start, near.end);
            }
        }
        while low < high {
            let middle = low + (high - low + 1) / 2;
            if holds(middle) {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        low
    }

    /// Returns true if the code is a NaN.
    pub fn is_nan(self, code: u32) -> bool {
        match self {
            Self::Float16 => f16::from_bits(code as u16).is_nan(),
            Self::Float32 => f32::from_bits(code).is_nan(),
            Self::Ufloat(mantissa) => code > 31 << mantissa,
            Self::Unorm(_) | Self::Snorm(_) | Self::Srgb8 | Self::Uint(_) => false,
        }
    }
}

/// The number of mantissa bits of a 16-bit float.
const HALF_MANTISSA: u8 = 10;

/// The exponent of a 64-bit float, with its bias, minus that of an equal float with 5 exponent bits.
const REBIAS: u64 = 1023 - 15;

/// Returns the value of an unsigned float with 5 exponent bits.
fn small_float(mantissa: u8, order: u64) -> f64 {
    let (exponent, fraction) = (order >> mantissa, order & ((1 << mantissa) - 1));
    match exponent {
        0 => fraction as f64 / f64::from(1_u32 << (14 + mantissa)),
        1..=30 => f64::from_bits((order + (REBIAS << mantissa)) << (52 - mantissa)),
        31 if fraction == 0 => f64::INFINITY,
        _ => f64::NAN,
    }
}

/// Returns the orders of the unsigned floats with 5 exponent bits on either side of a number that is not
/// negative; they can be beyond the largest order.
fn magnitudes(mantissa: u8, value: f64) -> [i64; 2] {
    let least_normal = small_float(mantissa, 1 << mantissa);
    let (below, exact) = if value < least_normal {
        let position = value * f64::from(1_u32 << (14 + mantissa));
        (position as i64, (position as i64) as f64 == position)
    } else {
        let (bits, shift) = (value.to_bits(), 52 - mantissa);
        let below = (bits >> shift) - (REBIAS << mantissa);
        (below as i64, bits & ((1 << shift) - 1) == 0)
    };
    [below, below + i64::from(!exact)]
}

/// The linear values of the codes of 8-bit sRGB, and of the middles between them.
static LINEAR: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let half_codes = 0..=2 * 255;
    half_codes
        .map(|n| srgb_to_linear(f64::from(n) / 2.0 / 255.0))
        .collect()
});

/// Returns the linear value of a number of half codes of 8-bit sRGB.
pub fn linear_of_half_codes(half_codes: i64) -> f64 {
    let known = usize::try_from(half_codes).ok();
    let known = known.and_then(|n| LINEAR.get(n).copied());
    known.unwrap_or_else(|| srgb_to_linear(half_codes as f64 / 2.0 / 255.0))
}

/// Converts an sRGB-encoded value in 0..=1 to a linear one (IEC 61966-2-1; Khronos Data Format, 13.3.2).
pub fn srgb_to_linear(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Converts a linear value to an sRGB-encoded one: the inverse of [`srgb_to_linear`].
pub fn linear_to_srgb(value: f64) -> f64 {
    if value <= 0.003_130_8 {
        value * 12.92
    } else {
        1.055 * value.powf(1.0 / 2.4) - 0.055
    }
}

impl fmt::Display for ChannelEncoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unorm(bits) => write!(f, "{bits}-bit unorm"),
            Self::Snorm(bits) => write!(f, "{bits}-bit snorm"),
            Self::Srgb8 => f.write_str("8-bit sRGB"),
            Self::Uint(bits) => write!(f, "{bits}-bit uint"),
            Self::Float16 => f.write_str("16-bit float"),
            Self::Float32 => f.write_str("32-bit float"),
            Self::Ufloat(mantissa) => write!(f, "{}-bit unsigned float", mantissa + 5),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn float_order_is_monotone_and_inverts() {
        let e = ChannelEncoding::Float32;
        let values = [-f32::MAX, -1.0, -1e-40, 0.0, 1e-45, 0.5, 1.0, f32::MAX];
        let orders: Vec<i64> = values
            .iter()
            .map(|v| e.order_of_code(v.to_bits()))
            .collect();
        assert!(orders.is_sorted());
        for (value, order) in values.iter().zip(orders) {
            assert_eq!(e.value_of_order(order), f64::from(*value));
        }
    }

    #[test]
    fn every_encoding_orders_its_values_and_finds_its_codes() {
        let encodings = [
            ChannelEncoding::Unorm(5),
            ChannelEncoding::Snorm(8),
            ChannelEncoding::Srgb8,
            ChannelEncoding::Float16,
            ChannelEncoding::Ufloat(6),
            ChannelEncoding::Ufloat(5),
        ];
        for e in encodings {
            let orders: Vec<i64> = (e.min_order()..=e.max_order()).collect();
            for pair in orders.windows(2) {
                assert!(
                    e.value_of_order(pair[0]) <= e.value_of_order(pair[1]),
                    "{e}"
                );
            }
            for order in orders {
                assert_eq!(e.order_of_code(e.code_of_order(order)), order, "{e}");
                let value = e.value_of_order(order);
                let found = e.order_of_code(e.nearest_code(value));
                assert_eq!(e.value_of_order(found), value, "{e} {order}");
            }
        }
    }

    #[test]
    fn a_conversion_never_gives_the_lowest_signed_code() {
        let e = ChannelEncoding::Snorm(8);
        for value in [-1.0, -1.005, -2.0] {
            assert_eq!(e.order_of_code(e.nearest_code(value)), -127);
            assert_eq!([e.order_below(value), e.order_above(value)], [-127; 2]);
        }
    }

    #[test]
    fn packed_encodings_have_their_golden_values() {
        let value = |e: ChannelEncoding, code| e.value_of_order(e.order_of_code(code));
        assert_eq!(value(ChannelEncoding::Ufloat(6), 0x3c0), 1.0);
        assert_eq!(value(ChannelEncoding::Ufloat(5), 0x1e0), 1.0);
        assert_eq!(value(ChannelEncoding::Ufloat(6), 0x7bf), 65024.0);
        assert_eq!(value(ChannelEncoding::Float16, 0x3555), 0.333_251_953_125);
        assert_eq!(value(ChannelEncoding::Snorm(8), 0x80), -1.0);
        assert_eq!(value(ChannelEncoding::Snorm(8), 0x81), -1.0);
        assert!((value(ChannelEncoding::Srgb8, 188) - 0.502_886_5).abs() < 1e-6);
    }
}
