//! Twin of `shaders/hashed_sample.wgsl`.

use super::arithmetic::{product, scaled, sum};
use super::interface::{FragmentInput, FragmentOutput, KeepCondition};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, blue, alpha] = input.texels[0];
    let place = [0, 1].map(|axis| {
        let within = product(a, input.uv[axis], input.color[axis]);
        let place = sum(a, input.color[axis + 2], within);
        scaled(a, place, input.params.color[axis])
    });
    let threshold = a.cell_hash(place);
    FragmentOutput {
        kept: Some(KeepCondition::unless_below(alpha, threshold)),
        ..FragmentOutput::of([red, green, blue, a.constant(1.0)])
    }
}
