//! Twin of `shaders/weighted_resolve.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [sum, left] = input.texels;
    let least = a.constant(0.00001);
    let weight = a.max(sum[3], least);
    let mean = |a: &mut A, c: usize| {
        let value = a.div(sum[c], weight);
        a.rounded(value)
    };
    FragmentOutput::of([mean(a, 0), mean(a, 1), mean(a, 2), left[0]])
}
