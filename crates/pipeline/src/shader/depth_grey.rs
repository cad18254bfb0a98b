//! Twin of `shaders/depth_grey.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let grey = input.depth;
    FragmentOutput::of([grey, grey, grey, a.constant(1.0)])
}
