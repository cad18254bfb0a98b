//! Twin of `shaders/sample_index.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let bit = |n: u32| ((input.sample >> n) & 1) as f32;
    FragmentOutput::of([bit(0), bit(1), bit(2), 1.0].map(|v| a.constant(v)))
}
