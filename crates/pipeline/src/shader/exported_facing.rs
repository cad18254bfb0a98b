//! Twin of `shaders/exported_facing.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, StencilReference};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, _, _, alpha] = input.texels[0];
    let (number, color) = if input.front {
        (red, input.params.color)
    } else {
        (alpha, input.params.back_color)
    };
    FragmentOutput {
        reference: Some(StencilReference::of(number)),
        ..FragmentOutput::of(color.map(|v| a.constant(v)))
    }
}
