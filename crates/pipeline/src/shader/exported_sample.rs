//! Twin of `shaders/exported_sample.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, StencilReference};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let bit = |n: u32| ((input.sample >> n) & 1) as f32;
    FragmentOutput {
        reference: Some(StencilReference {
            number: input.texels[0][0],
            plus: input.sample as i32,
        }),
        ..FragmentOutput::of([bit(0), bit(1), bit(2), 1.0].map(|v| a.constant(v)))
    }
}
