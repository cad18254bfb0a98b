//! Twin of `shaders/weighted_accumulate.wgsl`.

use super::arithmetic::premultiplied;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let alpha = input.color[3];
    let one = a.constant(1.0);
    let left = a.sub(one, input.depth);
    let mut power = a.rounded(left);
    let (left, scale) = (power, a.constant(3000.0));
    for factor in [left, left, scale] {
        power = a.mul(power, factor);
        power = a.rounded(power);
    }
    let least = a.constant(0.01);
    let weight = a.max(least, power);
    let weight = a.mul(alpha, weight);
    let weight = a.rounded(weight);
    let sum = std::array::from_fn(|c| {
        let source = premultiplied(a, input.color, c);
        let weighted = a.mul(source, weight);
        a.rounded(weighted)
    });
    FragmentOutput {
        others: Some([[alpha; 4], [a.constant(0.0); 4]]),
        ..FragmentOutput::of(sum)
    }
}
