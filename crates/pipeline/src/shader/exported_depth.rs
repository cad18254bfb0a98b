//! Twin of `shaders/exported_depth.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, StencilReference};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, ..] = input.texels[0];
    FragmentOutput {
        reference: Some(StencilReference::of(red)),
        depth: Some(green),
        ..FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
    }
}
