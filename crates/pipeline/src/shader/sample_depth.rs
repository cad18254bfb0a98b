//! Twin of `shaders/sample_depth.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let depth = (input.sample + 1) as f32 / 32.0;
    FragmentOutput {
        depth: Some(a.constant(depth)),
        ..FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
    }
}
