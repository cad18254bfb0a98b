//! Twin of `shaders/stepped_perspective.wgsl`.

use super::arithmetic::stepped;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput::of(stepped(a, input.uv))
}
