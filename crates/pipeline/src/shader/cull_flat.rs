//! Twin of `shaders/cull_flat.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;
use etalon_scene::Vertex;

pub(super) fn distances(vertex: &Vertex) -> [f32; 2] {
    vertex.uv
}

pub(super) fn fragment<A: Arithmetic>(
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput::of(input.color)
}
