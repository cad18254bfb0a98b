//! Depth and stencil kernels.

use super::image::AREA;
use super::lanes::{Lane, where_};
use crate::lanes::LANES;
use etalon_pipeline::stencil_operation;
use etalon_scene::{CompareFunction, StencilFace, StencilOperation};

/// The answer to a depth test that is the same all over a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decided {
    Pass,
    Fail,
}

/// Returns the answer of a comparison of one code with codes of a range, if it is one.
pub(crate) fn decided(
    function: CompareFunction,
    code: u32,
    [low, high]: [u32; 2],
) -> Option<Decided> {
    use CompareFunction::{Always, Equal, Greater, GreaterEqual, Less, LessEqual, Never, NotEqual};
    let outside = code < low || code > high;
    let equal = low == high && code == low;
    let (passes, fails) = match function {
        Never => (false, true),
        Always => (true, false),
        Less => (code < low, code >= high),
        LessEqual => (code <= low, code > high),
        Greater => (code > high, code <= low),
        GreaterEqual => (code >= high, code < low),
        Equal => (equal, outside),
        NotEqual => (outside, equal),
    };
    match (passes, fails) {
        (true, _) => Some(Decided::Pass),
        (_, true) => Some(Decided::Fail),
        _ => None,
    }
}

/// Returns the lanes whose comparison holds.
#[inline(always)]
pub(crate) fn compared<T: Copy + PartialOrd>(
    function: CompareFunction,
    incoming: &[T; LANES],
    stored: &[T; LANES],
) -> [Lane; LANES] {
    match function {
        CompareFunction::Never => [0; LANES],
        CompareFunction::Less => where_(incoming, stored, |a, b| a < b),
        CompareFunction::Equal => where_(incoming, stored, |a, b| a == b),
        CompareFunction::LessEqual => where_(incoming, stored, |a, b| a <= b),
        CompareFunction::Greater => where_(incoming, stored, |a, b| a > b),
        CompareFunction::NotEqual => where_(incoming, stored, |a, b| a != b),
        CompareFunction::GreaterEqual => where_(incoming, stored, |a, b| a >= b),
        CompareFunction::Always => [-1; LANES],
    }
}

/// Returns the lanes that pass the stencil test.
#[inline(always)]
pub(crate) fn stencil_passes(face: &StencilFace, stored: &[u8; LANES]) -> [Lane; LANES] {
    let seen = stored.map(|s| s & face.read_mask);
    compared(
        face.compare,
        &[face.reference & face.read_mask; LANES],
        &seen,
    )
}

/// Returns true if every stored value passes a stencil test.
pub(crate) fn always_passes(face: &StencilFace) -> bool {
    face.compare == CompareFunction::Always
}

/// Applies an operation to stored values.
#[inline(always)]
pub(crate) fn operate(face: &StencilFace, operation: StencilOperation, stored: &mut [u8]) {
    let (mask, reference) = (face.write_mask, face.reference);
    macro_rules! run {
        ($($name:ident)*) => {
            match operation {
                StencilOperation::Keep => {}
                $(StencilOperation::$name => {
                    for value in stored {
                        let new = stencil_operation(StencilOperation::$name, *value, reference);
                        *value = *value & !mask | new & mask;
                    }
                })*
            }
        };
    }
    run!(Zero Replace Invert IncrementClamp DecrementClamp IncrementWrap DecrementWrap);
}

/// A range of codes that holds whatever is stored.
pub(crate) const ANY: [u32; 2] = [0, u32::MAX];

const _: () = assert!(AREA.is_multiple_of(LANES));
