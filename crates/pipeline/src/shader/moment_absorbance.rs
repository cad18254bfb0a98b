//! Twin of `shaders/moment_absorbance.wgsl`.

use super::arithmetic::{difference, product, scaled};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let left = difference(a, one, input.color[3]);
    let least = a.constant(0.000_045_4);
    let left = a.max(left, least);
    let halvings = a.log2(left);
    let absorbance = a.sub(zero, halvings);
    let twice = scaled(a, input.depth, 2.0);
    let z = difference(a, twice, one);
    let square = product(a, z, z);
    let cube = product(a, square, z);
    let fourth = product(a, square, square);
    let moments = [z, square, cube, fourth].map(|power| product(a, power, absorbance));
    FragmentOutput {
        others: Some([moments, [zero; 4]]),
        ..FragmentOutput::of([absorbance; 4])
    }
}
