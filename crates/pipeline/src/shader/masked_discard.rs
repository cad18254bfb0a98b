//! Twin of `shaders/masked_discard.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition, SampleMask};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let texel = input.texels[0];
    let [red, green, blue, _] = input.params.color.map(|v| a.constant(v));
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(texel[2], blue)),
        mask: Some(SampleMask::of(texel[0])),
        ..FragmentOutput::of([red, green, blue, texel[3]])
    }
}
