//! Twin of `shaders/texel_dual_source.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        second: Some(input.texels[1]),
        ..FragmentOutput::of(input.texels[0])
    }
}
