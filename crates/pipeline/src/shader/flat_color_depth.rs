//! Twin of `shaders/flat_color_depth.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        depth: Some(input.color[0]),
        ..FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
    }
}
