//! Lanes of a tile's rows and their masks.

use crate::lanes::{LANES, LaneCodes};
use fearless_simd::prelude::*;
use fearless_simd::{mask8x16, mask32x16, u8x16, u32x16};

/// A bit per lane, from the lowest on, which is set if the lane is covered.
pub(crate) type LaneBits = u16;

/// The mask of all lanes.
pub(crate) const ALL: LaneBits = LaneBits::MAX;

/// The numbers of the lanes.
pub(crate) const NUMBERS: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Returns the lanes of a row, which begin at column `x`, that are in the columns from `start` up to but not
/// including `end`.
#[inline(always)]
pub(crate) fn columns(x: i32, [start, end]: [i32; 2]) -> LaneBits {
    // A mask of the lanes before a column.
    let before = |column: i32| (1_u32 << (column - x).clamp(0, LANES as i32)) - 1;
    (before(end) & !before(start)) as LaneBits
}

/// Returns the lanes at an index of planes.
#[inline(always)]
pub(crate) fn lanes<T>(planes: &mut [T], start: usize) -> &mut [T; LANES] {
    let (lanes, _) = planes[start..start + LANES].as_chunks_mut();
    &mut lanes[0]
}

/// Returns the lanes of texels of bytes whose alpha is at least `least`.
#[inline(always)]
pub(crate) fn alphas_from<S: Simd>(simd: S, texels: &LaneCodes, least: u32) -> LaneBits {
    let mut alphas = *texels;
    for alpha in &mut alphas {
        *alpha = u32::from_le(*alpha) >> 24;
    }
    let kept = u32x16::from_slice(simd, &alphas).simd_ge(least);
    kept.to_bitmask() as LaneBits
}

/// Replaces the words in the lanes of a mask.
#[inline(always)]
pub(crate) fn select<S: Simd>(simd: S, words: &mut LaneCodes, mask: LaneBits, new: &LaneCodes) {
    let mask = mask32x16::from_bitmask(simd, mask.into());
    let old = u32x16::from_slice(simd, words);
    let new = u32x16::from_slice(simd, new);
    mask.select(new, old).store_slice(words);
}

/// Replaces the bytes in the lanes of a mask.
#[inline(always)]
pub(crate) fn select_bytes<S: Simd>(
    simd: S,
    bytes: &mut [u8; LANES],
    mask: LaneBits,
    new: &[u8; LANES],
) {
    let mask = mask8x16::from_bitmask(simd, mask.into());
    let old = u8x16::from_slice(simd, bytes);
    let new = u8x16::from_slice(simd, new);
    mask.select(new, old).store_slice(bytes);
}
