//! Twin of `shaders/texel_dual_source.wgsl`.

use super::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        color: input.texels[0],
        second: Some(input.texels[1]),
        depth: None,
        kept: None,
    }
}
