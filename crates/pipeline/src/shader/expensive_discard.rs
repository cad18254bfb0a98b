//! Twin of `shaders/expensive_discard.wgsl`, without the cost.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let limit = a.constant(input.params.color[3]);
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(input.color[3], limit)),
        ..FragmentOutput::of(input.color)
    }
}
