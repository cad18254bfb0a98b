//! Twin of `shaders/frag_coord_depth.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        depth: Some(input.depth),
        ..FragmentOutput::of(input.color)
    }
}
