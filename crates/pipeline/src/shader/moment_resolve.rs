//! Twin of `shaders/moment_resolve.wgsl`.

use super::arithmetic::quotient;
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [sum, absorbance] = input.texels;
    let (zero, least) = (a.constant(0.0), a.constant(0.00001));
    let weight = a.select_less(sum[3], least, least, sum[3]);
    let [red, green, blue] = [0, 1, 2].map(|c| quotient(a, sum[c], weight));
    let exponent = a.sub(zero, absorbance[0]);
    FragmentOutput::of([red, green, blue, a.exp2(exponent)])
}
