//! 8-bit sRGB codes by tables, equal to the functions that define them.

use crate::rounding::{integer_part, unit};
use etalon_frame::{ChannelEncoding, linear_to_srgb};
use std::sync::LazyLock;

/// The number of equal parts of the range 0 to 1 in the table. Code boundaries are at least 1/3295 apart
/// (12.92 · 255), so each part contains at most one.
const PARTS: usize = 4096;

/// The number of parts in memory: a power of two, so that masking an index keeps it in range.
const SLOTS: usize = 2 * PARTS;

/// The codes of values, in tables that fit into the processor's cache.
#[derive(Debug)]
pub(crate) struct SrgbCodes {
    /// The code of each part's first value.
    first: Box<[u8; SLOTS]>,
    /// The least value of each code, and infinity.
    least: [f32; 257],
}

/// The codes of linear values.
pub(crate) static CODES: LazyLock<SrgbCodes> = LazyLock::new(SrgbCodes::new);

/// The linear values of codes.
pub(crate) static VALUES: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|c| ChannelEncoding::Srgb8.value_of_order(c as i64) as f32)
});

impl SrgbCodes {
    fn new() -> Self {
        let least = std::array::from_fn(|code| match code {
            0 => 0.0,
            code => least(code as u32),
        });
        let mut first = Box::new([0; SLOTS]);
        let mut code = 0_u8;
        for (part, first) in first.iter_mut().enumerate().take(PARTS + 1) {
            while part as f32 / PARTS as f32 >= least[usize::from(code) + 1] {
                code += 1;
            }
            *first = code;
        }
        Self { first, least }
    }

    /// Returns the code of a linear value: 0 for NaN and negative values, 255 above 1.
    #[inline(always)]
    pub(crate) fn of(&self, value: f32) -> u32 {
        let value = unit(value);
        self.at(part(value), value)
    }

    /// Returns the code of a value from 0 to 1 in a part.
    #[inline(always)]
    fn at(&self, part: u32, value: f32) -> u32 {
        let code = self.first[part as usize % SLOTS];
        u32::from(code) + u32::from(value >= self.least[usize::from(code) + 1])
    }
}

/// Writes the codes of linear values: 0 for NaN and negative values, 255 above 1.
#[inline(always)]
pub fn srgb_codes(values: &[f32], codes: &mut [u32]) {
    let tables = &*CODES;
    // Separate from the look-ups, so that this loop is vectorized.
    for (code, value) in codes.iter_mut().zip(values) {
        *code = part(unit(*value));
    }
    for (code, value) in codes.iter_mut().zip(values) {
        *code = tables.at(*code, unit(*value));
    }
}

/// Writes the linear values of codes.
#[inline(always)]
pub fn srgb_values(codes: &[u32], values: &mut [f32]) {
    let table = &*VALUES;
    for (value, code) in values.iter_mut().zip(codes) {
        *value = table[(code & 0xff) as usize];
    }
}

/// Returns the part of a value from 0 to 1.
#[inline(always)]
fn part(value: f32) -> u32 {
    integer_part(value * PARTS as f32)
}

/// Returns the code of a linear value by its definition.
fn defined(value: f32) -> u32 {
    let linear = f64::from(value.clamp(0.0, 1.0));
    (linear_to_srgb(linear) * 255.0 + 0.5) as u32
}

/// Returns the least value of a code; infinity for codes above all.
fn least(code: u32) -> f32 {
    if code > 255 {
        return f32::INFINITY;
    }
    // The bits of non-negative floats have the order of their values.
    let (mut below, mut above) = (0, 1.0_f32.to_bits());
    while above - below > 1 {
        let middle = below + (above - below) / 2;
        if defined(f32::from_bits(middle)) < code {
            below = middle
        } else {
            above = middle
        }
    }
    f32::from_bits(above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_codes_are_those_of_the_defining_function() {
        let near = (1..=255).flat_map(|code| {
            let bits = least(code).to_bits();
            (bits - 200..bits + 200).map(f32::from_bits)
        });
        let grid = (0..=300_000_u32).map(|i| i as f32 / 299_000.0 - 0.001);
        let ends = [0.0, -0.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        let values: Vec<f32> = near.chain(grid).chain(ends).collect();
        let mut codes = vec![0; values.len()];
        srgb_codes(&values, &mut codes);
        for (value, code) in values.into_iter().zip(codes) {
            assert_eq!([code, CODES.of(value)], [defined(value); 2], "{value}");
        }
    }

    #[test]
    fn every_code_survives_a_round_trip() {
        for code in 0..=255 {
            assert_eq!(CODES.of(VALUES[code]), code as u32);
        }
    }
}
