//! Twin of `shaders/stochastic.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, blue, alpha] = input.color;
    // Samples past the fourth use the first one's threshold.
    let threshold = match input.sample {
        1 => input.texels[0][1],
        2 => input.texels[0][2],
        3 => input.texels[0][3],
        _ => input.texels[0][0],
    };
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(alpha, threshold)),
        ..FragmentOutput::of([red, green, blue, a.constant(1.0)])
    }
}
