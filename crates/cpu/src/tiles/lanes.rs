//! Lanes of a tile's rows and their masks.

use super::image::Texel;
use crate::lanes::LANES;

/// All bits set where a lane is covered, none elsewhere.
pub(crate) type Lane = i32;

/// The lanes' numbers.
pub(crate) const NUMBERS: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// The mask of all lanes.
pub(crate) const ALL: [Lane; LANES] = [-1; LANES];

/// Returns true if a lane is set.
#[inline(always)]
pub(crate) fn any(mask: &[Lane; LANES]) -> bool {
    mask.iter().fold(0, |bits, lane| bits | lane) != 0
}

/// Returns lane by lane what two masks have in common.
#[inline(always)]
pub(crate) fn and(a: &[Lane; LANES], b: &[Lane; LANES]) -> [Lane; LANES] {
    let mut result = *a;
    for (result, b) in result.iter_mut().zip(b) {
        *result &= b;
    }
    result
}

/// Returns lane by lane what the first mask has and the second has not.
#[inline(always)]
pub(crate) fn and_not(a: &[Lane; LANES], b: &[Lane; LANES]) -> [Lane; LANES] {
    let mut result = *a;
    for (result, b) in result.iter_mut().zip(b) {
        *result &= !b;
    }
    result
}

/// Returns the mask of lanes where a condition on two numbers holds.
#[inline(always)]
pub(crate) fn where_<A: Copy, B: Copy>(
    a: &[A; LANES],
    b: &[B; LANES],
    holds: impl Fn(A, B) -> bool,
) -> [Lane; LANES] {
    let mut result = [0; LANES];
    for ((result, a), b) in result.iter_mut().zip(a).zip(b) {
        *result = -Lane::from(holds(*a, *b));
    }
    result
}

/// Replaces the texels of a mask.
#[inline(always)]
pub(crate) fn select_texels(
    texels: &mut [Texel; LANES],
    mask: &[Lane; LANES],
    new: &[Texel; LANES],
) {
    for ((texel, lane), new) in texels.iter_mut().zip(mask).zip(new) {
        let (old, new, lane) = (
            u32::from_ne_bytes(*texel),
            u32::from_ne_bytes(*new),
            *lane as u32,
        );
        *texel = (old & !lane | new & lane).to_ne_bytes();
    }
}

/// Replaces the codes of a mask.
#[inline(always)]
pub(crate) fn select(codes: &mut [u32; LANES], mask: &[Lane; LANES], new: &[u32; LANES]) {
    for ((code, lane), new) in codes.iter_mut().zip(mask).zip(new) {
        let lane = *lane as u32;
        *code = *code & !lane | new & lane;
    }
}

/// Replaces the bytes of a mask.
#[inline(always)]
pub(crate) fn select_bytes(bytes: &mut [u8; LANES], mask: &[Lane; LANES], new: &[u8; LANES]) {
    for ((byte, lane), new) in bytes.iter_mut().zip(mask).zip(new) {
        let lane = *lane as u8;
        *byte = *byte & !lane | new & lane;
    }
}
