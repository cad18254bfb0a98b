//! Twin of `shaders/centroid.wgsl`. Inside a primitive whose first texture coordinates are not negative, the
//! interpolated coordinate is not negative either.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput::of(input.params.color.map(|v| a.constant(v)))
}
