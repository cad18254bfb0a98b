//! Twin of `shaders/edge_alpha.wgsl`.

use super::arithmetic::clamp_to_unit;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, blue, alpha] = input.color;
    let half = a.constant(0.5);
    let coverage = a.add(input.uv[0], half);
    let coverage = a.rounded(coverage);
    let coverage = clamp_to_unit(a, coverage);
    let alpha = a.mul(alpha, coverage);
    FragmentOutput::of([red, green, blue, a.rounded(alpha)])
}
