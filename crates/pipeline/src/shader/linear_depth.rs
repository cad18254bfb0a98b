//! Twin of `shaders/linear_depth.wgsl`.

use super::arithmetic::share_between;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [near, far] = [0, 1].map(|c| a.constant(input.params.color[c]));
    let one = a.constant(1.0);
    let distance = a.div(one, input.reciprocal_w);
    let distance = a.rounded(distance);
    FragmentOutput {
        depth: Some(share_between(a, distance, near, far)),
        ..FragmentOutput::of(input.color)
    }
}
