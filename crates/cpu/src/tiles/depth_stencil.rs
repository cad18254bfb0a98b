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

/// Returns the answer of a stencil test of stored values of a range, if it is one.
pub(crate) fn stencil_decided(face: &StencilFace, [low, high]: [u8; 2]) -> Option<Decided> {
    let mask = face.read_mask;
    // Masked values of a range are in no order, unless they are one.
    let range = match () {
        () if mask == u8::MAX => [low, high],
        () if low == high => [low & mask; 2],
        () => [0, mask],
    };
    decided(
        face.compare,
        u32::from(face.reference & mask),
        range.map(u32::from),
    )
}

/// True if an operation leaves stored values as they are.
pub(crate) fn keeps(face: &StencilFace, operation: StencilOperation) -> bool {
    operation == StencilOperation::Keep || face.write_mask == 0
}

/// Returns a range around what an operation makes of stored values of a range.
pub(crate) fn operated(
    face: &StencilFace,
    operation: StencilOperation,
    [low, high]: [u8; 2],
) -> [u8; 2] {
    if keeps(face, operation) || [low, high] == ANY_STENCIL {
        return [low, high];
    }
    let mut values: [u8; 256] = std::array::from_fn(|value| value as u8);
    let values = &mut values[usize::from(low)..=usize::from(high)];
    operate(face, operation, values);
    values
        .iter()
        .fold([u8::MAX, 0], |[a, b], v| [a.min(*v), b.max(*v)])
}

/// Returns the range around two.
pub(crate) fn hull<T: Ord>([a, b]: [T; 2], [c, d]: [T; 2]) -> [T; 2] {
    [a.min(c), b.max(d)]
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

/// The same of stencil values.
pub(crate) const ANY_STENCIL: [u8; 2] = [0, u8::MAX];

const _: () = assert!(AREA.is_multiple_of(LANES));
