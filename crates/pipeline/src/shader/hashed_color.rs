//! Twin of `shaders/hashed_color.wgsl`.

use super::arithmetic::scaled;
use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, blue, alpha] = input.color;
    let place = [0, 1].map(|axis| scaled(a, input.uv[axis], input.params.color[axis]));
    let threshold = a.cell_hash(place);
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(alpha, threshold)),
        ..FragmentOutput::of([red, green, blue, a.constant(1.0)])
    }
}
