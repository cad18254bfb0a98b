//! Twin of `shaders/expensive_discard.wgsl`, without the cost.

use super::interface::{FragmentInput, FragmentOutput, Kept};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let limit = a.constant(input.params.color[3]);
    FragmentOutput {
        kept: Some(Kept::unless_below(input.color[3], limit)),
        ..FragmentOutput::of(input.color)
    }
}
