//! Twin of `shaders/texel_stencil.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [none, one] = [0.0, 1.0].map(|v| a.constant(v));
    FragmentOutput::of([input.texels[0][0], none, none, one])
}
