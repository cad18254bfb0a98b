//! Twin of `shaders/exported_discard.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition, StencilReference};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, _, blue, _] = input.texels[0];
    let color = input.params.color.map(|v| a.constant(v));
    FragmentOutput {
        reference: Some(StencilReference::of(red)),
        kept: Some(KeepCondition::unless_below(blue, color[2])),
        ..FragmentOutput::of(color)
    }
}
