//! Twin of `shaders/clip_uniform.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;
use etalon_scene::Vertex;

pub(super) fn distances(vertex: &Vertex) -> [f32; 8] {
    let [red, green, blue, alpha] = vertex.color;
    let [u, v] = vertex.uv;
    [red, green, blue, alpha, u, v, alpha - u, blue - v]
}

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
}
