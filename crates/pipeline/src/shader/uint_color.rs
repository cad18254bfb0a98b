//! Twin of `shaders/uint_color.wgsl`.

use super::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    FragmentOutput {
        color: input.params.color.map(|v| a.constant(v)),
        second: None,
        depth: None,
        kept: None,
    }
}
