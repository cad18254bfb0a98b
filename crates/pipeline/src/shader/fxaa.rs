//! Twin of `shaders/fxaa.wgsl`. Choices are numbers, 1 for true, since lanes can differ in them.

use super::arithmetic::{difference, magnitude, product, quotient, scaled, sum};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

/// The length in texels of each step of the walk along an edge.
const STRIDES: [f32; 12] = [1.0, 1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 4.0, 8.0];

/// Runs the fragment shader. Line by line the twin of its WGSL.
pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [width, height, relative, least] = input.params.color.map(|v| a.constant(v));
    let amount = a.constant(input.params.back_color[0]);
    let (zero, one, half) = (a.constant(0.0), a.constant(1.0), a.constant(0.5));
    let [u, v] = input.uv;
    let (left, right) = (difference(a, u, width), sum(a, u, width));
    let (up, down) = (difference(a, v, height), sum(a, v, height));

    let m = luma(a, input, [u, v]);
    let n = luma(a, input, [u, up]);
    let s = luma(a, input, [u, down]);
    let w = luma(a, input, [left, v]);
    let e = luma(a, input, [right, v]);
    let (mut brightest, mut darkest) = (m, m);
    for neighbour in [n, s, w, e] {
        brightest = a.max(brightest, neighbour);
        darkest = a.min(darkest, neighbour);
    }
    let contrast = difference(a, brightest, darkest);
    let threshold = product(a, brightest, relative);
    let threshold = a.max(least, threshold);
    let center = tap(input, [u, v]);
    if a.always_less(contrast, threshold) {
        return FragmentOutput::of(center);
    }

    let nw = luma(a, input, [left, up]);
    let se = luma(a, input, [right, down]);
    let ne = luma(a, input, [right, up]);
    let sw = luma(a, input, [left, down]);

    let single = {
        let near = sum(a, n, s);
        let near = sum(a, near, w);
        let near = sum(a, near, e);
        let near = scaled(a, near, 2.0);
        let top = sum(a, nw, ne);
        let bottom = sum(a, sw, se);
        let total = sum(a, near, top);
        let total = sum(a, total, bottom);
        let twelve = a.constant(12.0);
        let mean = quotient(a, total, twelve);
        let apart = difference(a, mean, m);
        let apart = magnitude(a, apart);
        let apart = quotient(a, apart, contrast);
        let apart = a.min(apart, one);
        let square = product(a, apart, apart);
        let twice = scaled(a, apart, 2.0);
        let three = a.constant(3.0);
        let rest = difference(a, three, twice);
        let smoothed = product(a, square, rest);
        let square = product(a, smoothed, smoothed);
        product(a, square, amount)
    };

    let level = bend(a, [nw, w, sw], [n, m, s], [ne, e, se]);
    let upright = bend(a, [nw, n, ne], [w, m, e], [sw, s, se]);
    let choose = |a: &mut A, if_upright: A::Real, if_level: A::Real| {
        a.select_less(level, upright, if_upright, if_level)
    };
    let along = [choose(a, zero, width), choose(a, height, zero)];
    let across = [choose(a, width, zero), choose(a, zero, height)];
    let (before, behind) = (choose(a, w, n), choose(a, e, s));
    let rise = difference(a, before, m);
    let rise = magnitude(a, rise);
    let fall = difference(a, behind, m);
    let fall = magnitude(a, fall);
    let minus = a.constant(-1.0);
    let side = a.select_less(rise, fall, one, minus);
    let other = a.select_less(rise, fall, behind, before);
    let steepest = a.max(rise, fall);
    let enough = scaled(a, steepest, 0.25);
    let average = sum(a, other, m);
    let average = scaled(a, average, 0.5);

    let to_edge = scaled(a, side, 0.5);
    let start = moved(a, [u, v], across, to_edge);
    // For each of the two sides: the distance walked, the luma there minus the average, and whether the end
    // was reached.
    let mut walks = [(zero, zero, zero); 2];
    for stride in STRIDES {
        let stride = a.constant(stride);
        for (walk, direction) in walks.iter_mut().zip([-1.0, 1.0]) {
            let (walked, end, arrived) = *walk;
            let step = a.select_less(arrived, half, stride, zero);
            let walked = sum(a, walked, step);
            let signed = scaled(a, walked, direction);
            let position = moved(a, start, along, signed);
            let there = luma(a, input, position);
            let there = difference(a, there, average);
            let end = a.select_less(arrived, half, there, end);
            let size = magnitude(a, end);
            let there = a.select_less(size, enough, zero, one);
            *walk = (walked, end, a.max(arrived, there));
        }
        if walks
            .iter()
            .all(|(.., arrived)| a.always_less(half, *arrived))
        {
            break;
        }
    }

    let [(back, end_back, _), (forth, end_forth, _)] = walks;
    let end = a.select_less(back, forth, end_back, end_forth);
    let end_below = a.select_less(end, zero, one, zero);
    let own_below = a.select_less(m, average, one, zero);
    let differ = difference(a, end_below, own_below);
    let differ = magnitude(a, differ);
    let nearest = a.min(back, forth);
    let length = sum(a, back, forth);
    let share = quotient(a, nearest, length);
    let shift = difference(a, half, share);
    let shift = a.select_less(differ, half, zero, shift);
    let shift = a.max(shift, single);
    let shift = product(a, side, shift);
    let position = moved(a, [u, v], across, shift);
    let blended = tap(input, position);
    FragmentOutput::of(std::array::from_fn(|c| {
        a.select_less(contrast, threshold, center[c], blended[c])
    }))
}

fn tap<R: Copy>(input: &FragmentInput<'_, R>, position: [R; 2]) -> [R; 4] {
    input.taps.at(position).unwrap_or(input.texels[0])
}

fn luma<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
    position: [A::Real; 2],
) -> A::Real {
    let [red, green, blue, _] = tap(input, position);
    let red = scaled(a, red, 0.299);
    let green = scaled(a, green, 0.587);
    let blue = scaled(a, blue, 0.114);
    let total = sum(a, red, green);
    sum(a, total, blue)
}

/// Returns how sharply three lines of three texels bend; the middle line counts twice.
fn bend<A: Arithmetic>(
    a: &mut A,
    first: [A::Real; 3],
    middle: [A::Real; 3],
    last: [A::Real; 3],
) -> A::Real {
    let mut bend_of = |[before, center, after]: [A::Real; 3]| {
        let ends = sum(a, before, after);
        let twice = scaled(a, center, 2.0);
        let bend = difference(a, ends, twice);
        magnitude(a, bend)
    };
    let [first, middle, last] = [bend_of(first), bend_of(middle), bend_of(last)];
    let middle = scaled(a, middle, 2.0);
    let total = sum(a, first, middle);
    sum(a, total, last)
}

/// Returns a position moved by a number of steps.
fn moved<A: Arithmetic>(
    a: &mut A,
    from: [A::Real; 2],
    step: [A::Real; 2],
    steps: A::Real,
) -> [A::Real; 2] {
    [0, 1].map(|axis| {
        let way = product(a, step[axis], steps);
        sum(a, from[axis], way)
    })
}
