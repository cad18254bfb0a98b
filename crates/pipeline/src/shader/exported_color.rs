//! Twin of `shaders/exported_color.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, StencilReference};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        reference: Some(StencilReference::of(input.texels[0][0])),
        ..FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
    }
}
