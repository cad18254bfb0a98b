//! Twin of `shaders/masked_sample.wgsl`.

use super::interface::{FragmentInput, FragmentOutput, SampleMask};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let bit = |n: u32| ((input.sample >> n) & 1) as f32;
    FragmentOutput {
        mask: Some(SampleMask {
            bits: input.texels[0][0],
            turned_but: Some(input.sample),
        }),
        ..FragmentOutput::of([bit(0), bit(1), bit(2), 1.0].map(|v| a.constant(v)))
    }
}
