//! Twin of `shaders/depth_range.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let negative = a.sub(zero, input.depth);
    FragmentOutput::of([negative, input.depth, zero, one])
}
