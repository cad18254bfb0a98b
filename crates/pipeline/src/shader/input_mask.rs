//! Twin of `shaders/input_mask.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let first = input.params.color[0] as u32;
    FragmentOutput::of([0, 1, 2, 3].map(|n| {
        let bit = input.mask.bit(first + n);
        bit.unwrap_or_else(|| a.constant(0.0))
    }))
}
