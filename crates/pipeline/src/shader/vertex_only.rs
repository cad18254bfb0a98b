//! Twin of `shaders/vertex_only.wgsl`: without a fragment shader, nothing is written but what the
//! rasterizer made. The colour is undefined, and no scene lets it through its write masks.

use super::interface::FragmentOutput;
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(a: &mut A) -> FragmentOutput<A::Real> {
    FragmentOutput::of([0.0; 4].map(|v| a.constant(v)))
}
