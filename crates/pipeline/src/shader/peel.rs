//! Twin of `shaders/peel.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let zero = a.constant(0.0);
    FragmentOutput {
        others: Some([[input.depth, zero, zero, a.constant(1.0)], [zero; 4]]),
        kept: Some(KeepCondition::above(input.depth, input.texels[0][0])),
        ..FragmentOutput::of(input.color)
    }
}
