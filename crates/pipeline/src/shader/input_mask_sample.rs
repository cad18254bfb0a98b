//! Twin of `shaders/input_mask_sample.wgsl`.

use super::input_mask;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let mut output = input_mask::fragment(a, input);
    let first = input.params.color[0] as u32;
    let bit_index = input.sample.checked_sub(first);
    if let Some(bit) = bit_index.and_then(|n| output.color.get_mut(n as usize)) {
        let one = a.constant(1.0);
        *bit = a.sub(one, *bit);
    }
    output
}
