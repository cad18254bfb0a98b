//! Twin of `shaders/frag_coord_color.wgsl`.

use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [across, down, blue, alpha] = input.params.color.map(|v| a.constant(v));
    let [x, y] = input.position;
    let (red, green) = (a.mul(x, across), a.mul(y, down));
    FragmentOutput::of([a.rounded(red), a.rounded(green), blue, alpha])
}
