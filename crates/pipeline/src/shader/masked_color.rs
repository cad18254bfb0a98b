//! Twin of `shaders/masked_color.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, SampleMask};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let texel = input.texels[0];
    let [red, green, blue, _] = input.params.color.map(|v| a.constant(v));
    FragmentOutput {
        mask: Some(SampleMask::of(texel[0])),
        ..FragmentOutput::of([red, green, blue, texel[3]])
    }
}
