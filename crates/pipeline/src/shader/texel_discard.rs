//! Twin of `shaders/texel_discard.wgsl`.

use super::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        color: input.texels[0],
        second: None,
        depth: None,
        kept: Some([input.texels[0][3], a.constant(input.params.color[3])]),
    }
}
