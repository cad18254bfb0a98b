//! Twin of `shaders/logarithmic_depth.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [near, _, scale, _] = input.params.color.map(|v| a.constant(v));
    let near_over_w = a.mul(input.reciprocal_w, near);
    let near_over_w = a.rounded(near_over_w);
    let one = a.constant(1.0);
    let ratio = a.div(one, near_over_w);
    let ratio = a.rounded(ratio);
    let logarithm = a.log2(ratio);
    let depth = a.mul(logarithm, scale);
    FragmentOutput {
        depth: Some(a.rounded(depth)),
        ..FragmentOutput::of(input.color)
    }
}
