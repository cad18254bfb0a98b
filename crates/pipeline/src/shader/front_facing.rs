//! Twin of `shaders/front_facing.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let color = if input.front {
        input.params.color
    } else {
        input.params.back_color
    };
    FragmentOutput::of(color.map(|v| a.constant(v)))
}
