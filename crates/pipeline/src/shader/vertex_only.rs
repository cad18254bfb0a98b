//! Twin of `shaders/vertex_only.wgsl`: without a fragment shader, only the rasterizer's values are written.
//! The colour is undefined, and every scene masks it.

use super::interface::FragmentOutput;
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(a: &mut A) -> FragmentOutput<A::Real> {
    FragmentOutput::of([0.0; 4].map(|v| a.constant(v)))
}
