//! Twin of `shaders/depth_linearized.wgsl`.

use super::arithmetic::{distance_behind, share_between};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [near, far] = [0, 1].map(|c| a.constant(input.params.color[c]));
    let distance = distance_behind(a, input.depth, near, far);
    let grey = share_between(a, distance, near, far);
    FragmentOutput::of([grey, grey, grey, a.constant(1.0)])
}
