//! Twin of `shaders/texel_discard.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, Kept};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        kept: Some(Kept::unless_below(
            input.texels[0][3],
            a.constant(input.params.color[3]),
        )),
        ..FragmentOutput::of(input.texels[0])
    }
}
