//! Twin of `shaders/texel_discard.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(
            input.texels[0][3],
            a.constant(input.params.color[3]),
        )),
        ..FragmentOutput::of(input.texels[0])
    }
}
