//! sRGB codes of 8 bits by tables, equal to the functions that they are made of.

use crate::rounding::{unit, whole};
use etalon_frame::{ChannelEncoding, linear_to_srgb};
use std::sync::LazyLock;

/// The parts of the values from 0 to 1 that have a least code of their own. Two codes begin at least 1/3295 apart
/// (12.92 · 255), so that at most one begins in a part.
const PARTS: usize = 4096;

/// The parts in memory, so that an index without its upper bits is one.
const SLOTS: usize = 2 * PARTS;

/// The codes of values.
#[derive(Debug)]
pub(crate) struct Codes {
    /// The code of each part's first value.
    first: Box<[u32; SLOTS]>,
    /// The least value of each part whose code is the next.
    limits: Box<[f32; SLOTS]>,
}

/// The codes of linear values.
pub(crate) static CODES: LazyLock<Codes> = LazyLock::new(Codes::new);

/// The linear values of codes.
pub(crate) static VALUES: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|c| ChannelEncoding::Srgb8.value_of_order(c as i64) as f32)
});

impl Codes {
    fn new() -> Self {
        let mut codes = Self {
            first: Box::new([0; SLOTS]),
            limits: Box::new([f32::INFINITY; SLOTS]),
        };
        let (mut code, mut limit) = (0, least(1));
        for part in 0..=PARTS {
            while part as f32 / PARTS as f32 >= limit {
                code += 1;
                limit = least(code + 1);
            }
            (codes.first[part], codes.limits[part]) = (code, limit);
        }
        codes
    }

    /// Returns the code of a linear value: 0 for NaN and negative ones, 255 above 1.
    #[inline(always)]
    pub(crate) fn of(&self, value: f32) -> u32 {
        let value = unit(value);
        let part = whole(value * PARTS as f32) as usize % SLOTS;
        self.first[part] + u32::from(value >= self.limits[part])
    }
}

/// Returns the code of a linear value, as it is defined.
fn defined(value: f32) -> u32 {
    let linear = f64::from(value.clamp(0.0, 1.0));
    (linear_to_srgb(linear) * 255.0 + 0.5) as u32
}

/// Returns the least value of a code; infinity if the code is above all.
fn least(code: u32) -> f32 {
    if code > 255 {
        return f32::INFINITY;
    }
    // The bits of floats that are not negative have their order.
    let (mut below, mut at) = (0, 1.0_f32.to_bits());
    while at - below > 1 {
        let middle = below + (at - below) / 2;
        match defined(f32::from_bits(middle)) < code {
            true => below = middle,
            false => at = middle,
        }
    }
    f32::from_bits(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_function() {
        let near = (1..=255).flat_map(|code| {
            let bits = least(code).to_bits();
            (bits - 200..bits + 200).map(f32::from_bits)
        });
        let all = (0..=300_000_u32).map(|i| i as f32 / 299_000.0 - 0.001);
        let ends = [0.0, -0.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        for value in near.chain(all).chain(ends) {
            assert_eq!(CODES.of(value), defined(value), "{value}");
        }
    }

    #[test]
    fn every_code_survives_a_round_trip() {
        for code in 0..=255 {
            assert_eq!(CODES.of(VALUES[code]), code as u32);
        }
    }
}
