//! Linear functions of 8-bit codes, in integers.

use super::image::TexelWord;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u8x16, u8x32, u16x16};

/// The number of codes of a channel.
pub(crate) const CODES: usize = 256;

/// The number of bytes of neighbouring texels that a function processes at once.
pub(crate) const BYTES: usize = 16;

/// A linear function of each channel's code. It optionally inverts the code, multiplies it by a 16-bit
/// fraction, adds and subtracts with saturation, and keeps the upper byte. The parameters are stored per byte
/// of neighbouring texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearCodes {
    /// All bits set for channels whose codes are inverted.
    invert: [u8; BYTES],
    /// The upper and the lower byte of the factor.
    upper: [u16; BYTES],
    lower: [u16; BYTES],
    plus: [u16; BYTES],
    minus: [u16; BYTES],
}

/// A linear function of one channel.
#[derive(Clone, Copy, Debug, Default)]
struct ChannelFunction {
    invert: bool,
    factor: u16,
    plus: u16,
    minus: u16,
}

impl LinearCodes {
    /// Returns the function that equals the tables for all codes, if a function near their slopes does. A
    /// slope is the difference between the results of the last and the first code.
    #[inline(always)]
    pub(crate) fn fitted(tables: &[[u8; CODES]; 4], slopes: [f32; 4]) -> Option<Self> {
        let mut found = [ChannelFunction::default(); 4];
        for c in 0..4 {
            let known = (0..c).find(|k| tables[*k] == tables[c] && slopes[*k] == slopes[c]);
            found[c] = match known {
                Some(known) => found[known],
                None => ChannelFunction::fitted(&tables[c], slopes[c])?,
            };
        }
        let part = |part: fn(&ChannelFunction) -> u16| std::array::from_fn(|i| part(&found[i % 4]));
        Some(Self {
            invert: std::array::from_fn(|i| if found[i % 4].invert { 0xff } else { 0 }),
            upper: part(|c| c.factor >> 8),
            lower: part(|c| c.factor & 0xff),
            plus: part(|c| c.plus),
            minus: part(|c| c.minus),
        })
    }

    /// Applies the function to texels, whose number of bytes must be a multiple of twice [`BYTES`].
    #[inline(always)]
    pub(crate) fn apply<S: Simd>(&self, simd: S, texels: &mut [TexelWord]) {
        // Copied into locals, so that they stay in registers.
        let [upper, lower, plus, minus] = [&self.upper, &self.lower, &self.plus, &self.minus]
            .map(|part| u16x16::from_slice(simd, part));
        let invert = u8x16::from_slice(simd, &self.invert);
        let invert = invert.combine(invert);
        let mapped = |code: u16x16<S>| {
            // 256 times the code times the fraction, in two parts that fit 16 bits.
            let product = code * upper + ((code * lower) >> 8);
            product.saturating_add(plus).saturating_sub(minus) >> 8
        };
        let bytes = texels.as_flattened_mut();
        for bytes in bytes.as_chunks_mut::<{ 2 * BYTES }>().0 {
            let (low, high) = (u8x32::from_slice(simd, bytes) ^ invert).widen();
            mapped(low).narrow(mapped(high)).store_slice(bytes);
        }
    }
}

impl ChannelFunction {
    /// Returns the function that equals a table for all codes, if there is one near a slope.
    #[inline(always)]
    fn fitted(table: &[u8; CODES], slope: f32) -> Option<Self> {
        if slope >= 0.0 {
            return Self::rising(table, slope);
        }
        let mut inverted = *table;
        inverted.reverse();
        let found = Self::rising(&inverted, -slope)?;
        Some(Self {
            invert: true,
            ..found
        })
    }

    /// Returns the function that equals a table without falling steps, if there is one near a slope.
    #[inline(always)]
    fn rising(table: &[u8; CODES], slope: f32) -> Option<Self> {
        let near = (f64::from(slope) * 65536.0).round();
        if !(0.0..=65537.0).contains(&near) {
            return None;
        }
        for off in [0, -1, 1, -2, 2, -4, 4, -8, 8] {
            let factor = (near as i64 + off).clamp(0, 65535) as u16;
            let (mut least, mut most) = (-65535, 65535);
            for (code, expected) in table.iter().enumerate() {
                let (product, expected) =
                    (i32::from(product(code as u8, factor)), i32::from(*expected));
                let low = 256 * expected - product;
                least = least.max(if expected > 0 { low } else { -65535 });
                most = most.min(if expected < 255 { low + 255 } else { 65535 });
            }
            let sum = (least + most).div_euclid(2);
            let found = Self {
                invert: false,
                factor,
                plus: sum.clamp(0, 65535) as u16,
                minus: (-sum).clamp(0, 65535) as u16,
            };
            // Without an early exit, so that the loop is vectorized.
            let mut different = 0;
            for (code, expected) in table.iter().enumerate() {
                different |= found.at(code as u8) ^ expected;
            }
            if different == 0 {
                return Some(found);
            }
        }
        None
    }

    /// Returns the result for a code that is not inverted.
    #[inline(always)]
    fn at(&self, code: u8) -> u8 {
        let sum = product(code, self.factor).saturating_add(self.plus);
        (sum.saturating_sub(self.minus) >> 8) as u8
    }
}

/// Returns 256 times a code times a 16-bit fraction.
#[inline(always)]
fn product(code: u8, factor: u16) -> u16 {
    ((u32::from(code) * u32::from(factor)) >> 8) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    #[test]
    fn a_fitted_function_agrees_with_its_tables() {
        let tables = [
            std::array::from_fn(|i| (i / 2) as u8),
            std::array::from_fn(|i| 255 - i as u8),
            std::array::from_fn(|i| (i + 10).min(255) as u8),
            std::array::from_fn(|i| (i * 3 / 4).saturating_sub(20) as u8),
        ];
        let function =
            LinearCodes::fitted(&tables, [0.5, -1.0, 1.0, 0.75]).expect("they are linear");
        for code in 0..=255_u8 {
            let mut texels = [[code; 4]; 8];
            dispatch!(Level::new(), simd => function.apply(simd, &mut texels));
            for texel in texels {
                for (c, byte) in texel.into_iter().enumerate() {
                    assert_eq!(byte, tables[c][usize::from(code)], "{code}");
                }
            }
        }
    }

    #[test]
    fn tables_that_are_not_linear_have_no_function() {
        let square = std::array::from_fn(|i| (i * i / 255) as u8);
        assert!(LinearCodes::fitted(&[square; 4], [1.0; 4]).is_none());
    }
}
