//! Twin of `shaders/nearest_compose.wgsl`.

use super::arithmetic::{difference, product, quotient, sum};
use super::interface::{FragmentInput, FragmentOutput, List};
use super::list_compose::composed;
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let List::Known(layers) = input.list else {
        let zero = a.constant(0.0);
        return FragmentOutput::of([a.div(zero, zero); 4]);
    };
    let (color, left) = composed(a, layers);
    let [tail, [through, ..]] = input.texels;
    let least = a.constant(0.00001);
    let weight = a.max(tail[3], least);
    let one = a.constant(1.0);
    let covered = difference(a, one, through);
    let share = product(a, covered, left);
    let [red, green, blue] = [0, 1, 2].map(|c| {
        let mean = quotient(a, tail[c], weight);
        let shown = product(a, mean, share);
        sum(a, color[c], shown)
    });
    let background = product(a, left, through);
    FragmentOutput::of([red, green, blue, background])
}
