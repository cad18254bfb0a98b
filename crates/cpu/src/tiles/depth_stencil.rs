//! Depth and stencil kernels.

use super::AREA;
use super::lanes::{LaneBits, lanes, select_bytes};
use crate::lanes::LANES;
use etalon_pipeline::stencil_operation;
use etalon_scene::{CompareFunction, StencilFace, StencilOperation};
use fearless_simd::Simd;

/// The result of a depth or stencil test that is the same for a whole tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decided {
    Pass,
    Fail,
}

/// Returns the result of comparing a code with all codes of a range, if it is the same for all.
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

/// Returns whether the comparison passes for a number that is less than, equal to and greater than the stored
/// one.
#[inline(always)]
pub(crate) fn passing(compare: CompareFunction) -> [bool; 3] {
    match compare {
        CompareFunction::Never => [false, false, false],
        CompareFunction::Less => [true, false, false],
        CompareFunction::Equal => [false, true, false],
        CompareFunction::LessEqual => [true, true, false],
        CompareFunction::Greater => [false, false, true],
        CompareFunction::NotEqual => [true, false, true],
        CompareFunction::GreaterEqual => [false, true, true],
        CompareFunction::Always => [true, true, true],
    }
}

/// Returns three booleans that give the comparison's result as `greater ^ less_term ^ equal_term`: whether
/// the results for less and for equal differ from the result for greater, and the result for greater.
#[inline(always)]
pub(crate) fn answers([less, equal, greater]: [bool; 3]) -> [bool; 3] {
    [less != greater, equal != greater, greater]
}

/// Returns the result of a stencil test against all stored values of a range, if it is the same for all.
pub(crate) fn stencil_decided(face: &StencilFace, [low, high]: [u8; 2]) -> Option<Decided> {
    let mask = face.read_mask;
    // Masking does not keep the order of a range, unless the range is one value.
    let range = if mask == u8::MAX {
        [low, high]
    } else if low == high {
        [low & mask; 2]
    } else {
        [0, mask]
    };
    decided(
        face.compare,
        u32::from(face.reference & mask),
        range.map(u32::from),
    )
}

/// Returns true if an operation does not change stored values.
pub(crate) fn keeps(face: &StencilFace, operation: StencilOperation) -> bool {
    operation == StencilOperation::Keep || face.write_mask == 0
}

/// Returns a range that contains the results of an operation on the stored values of a range.
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

/// Returns the smallest range that contains two ranges.
pub(crate) fn hull<T: Ord>([a, b]: [T; 2], [c, d]: [T; 2]) -> [T; 2] {
    [a.min(c), b.max(d)]
}

/// Runs code once for an operation, with the operation on a face as a function of the stored value. `Keep`
/// runs nothing.
macro_rules! with_operation {
    ($face:expr, $operation:expr, |$new:ident| $run:expr) => {
        with_operation!($face, $operation, |$new| $run;
            Zero Replace Invert IncrementClamp DecrementClamp IncrementWrap DecrementWrap)
    };
    ($face:expr, $operation:expr, |$new:ident| $run:expr; $($name:ident)*) => {{
        let (mask, reference) = ($face.write_mask, $face.reference);
        match $operation {
            StencilOperation::Keep => {}
            $(StencilOperation::$name => {
                let $new = |value: u8| {
                    let new = stencil_operation(StencilOperation::$name, value, reference);
                    value & !mask | new & mask
                };
                $run
            })*
        }
    }};
}

/// Applies an operation to stored values.
#[inline(always)]
pub(crate) fn operate(face: &StencilFace, operation: StencilOperation, stored: &mut [u8]) {
    with_operation!(face, operation, |new| {
        for value in stored {
            *value = new(*value);
        }
    });
}

/// Applies an operation to the stored values of groups in a sample's plane, at the lanes of their masks.
#[inline(always)]
pub(crate) fn operate_groups<S: Simd>(
    simd: S,
    face: &StencilFace,
    operation: StencilOperation,
    plane: &mut [u8],
    groups: impl Iterator<Item = (usize, LaneBits)>,
) {
    with_operation!(face, operation, |new| {
        for (place, mask) in groups {
            let stored = lanes(plane, place);
            let mut values = *stored;
            for value in &mut values {
                *value = new(*value);
            }
            select_bytes(simd, stored, mask, &values);
        }
    });
}

/// A range that contains every code.
pub(crate) const ANY: [u32; 2] = [0, u32::MAX];

/// A range that contains every stencil value.
pub(crate) const ANY_STENCIL: [u8; 2] = [0, u8::MAX];

const _: () = assert!(AREA.is_multiple_of(LANES));
