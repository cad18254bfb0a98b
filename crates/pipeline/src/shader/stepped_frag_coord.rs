//! Twin of `shaders/stepped_frag_coord.wgsl`.

use super::arithmetic::{product, stepped};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [across, down, ..] = input.params.color.map(|v| a.constant(v));
    let w = product(a, input.reciprocal_w, across);
    let depth = product(a, input.depth, down);
    FragmentOutput::of(stepped(a, [w, depth]))
}
