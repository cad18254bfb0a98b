//! Twin of `shaders/moment_transmittance.wgsl`. Values that can be NaN are chosen by comparisons, whose
//! result is open in the judging number system.

use super::arithmetic::{difference, magnitude, premultiplied, product, quotient, scaled, sum};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [absorbance, moments] = input.texels;
    let least = a.constant(0.000_001);
    let total = larger(a, absorbance[0], least);
    let moved = a.constant(1.875e-7);
    let b = [0, 1, 2, 3].map(|i| {
        let moment = quotient(a, moments[i], total);
        let moment = scaled(a, moment, 0.999_999_5);
        match i {
            1 | 3 => sum(a, moment, moved),
            _ => moment,
        }
    });
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let twice = scaled(a, input.depth, 2.0);
    let z = difference(a, twice, one);
    let share = in_front(a, b, z);
    let before = product(a, total, share);
    let exponent = a.sub(zero, before);
    let transmittance = a.exp2(exponent);
    FragmentOutput::of([0, 1, 2, 3].map(|c| {
        let source = premultiplied(a, input.color, c);
        product(a, source, transmittance)
    }))
}

/// Returns the share of the absorbance in front of a depth.
fn in_front<A: Arithmetic>(a: &mut A, [b1, b2, b3, b4]: [A::Real; 4], z: A::Real) -> A::Real {
    let (zero, one) = (a.constant(0.0), a.constant(1.0));
    let less = |a: &mut A, from: A::Real, x: A::Real, y: A::Real| {
        let product = product(a, x, y);
        difference(a, from, product)
    };
    let mixed = less(a, b3, b1, b2);
    let d1 = less(a, b2, b1, b1);
    let l = quotient(a, mixed, d1);
    let spread = less(a, b4, b2, b2);
    let d2 = less(a, spread, mixed, l);
    let first = difference(a, z, b1);
    let square = product(a, z, z);
    let second = difference(a, square, b2);
    let second = less(a, second, first, l);
    let first_over = quotient(a, first, d1);
    let second_over = quotient(a, second, d2);
    let at_depth = {
        let of_first = product(a, first, first_over);
        let of_second = product(a, second, second_over);
        let both = sum(a, of_first, of_second);
        let total = sum(a, both, one);
        quotient(a, one, total)
    };
    let tiny = a.constant(1e-9);
    let size = magnitude(a, second_over);
    let c2 = a.select_less(size, tiny, tiny, second_over);
    let c1 = less(a, first_over, second_over, l);
    let c0 = {
        let start = less(a, one, b1, first_over);
        let along = product(a, b1, l);
        let along = difference(a, along, b2);
        let rest = product(a, second_over, along);
        sum(a, start, rest)
    };
    let root = {
        let square = product(a, c1, c1);
        let ends = product(a, c0, c2);
        let ends = scaled(a, ends, 4.0);
        let under = difference(a, square, ends);
        let under = larger(a, under, zero);
        let root = a.sqrt(under);
        let turned = a.sub(zero, root);
        a.select_less(c1, zero, turned, root)
    };
    let half = sum(a, c1, root);
    let half = scaled(a, half, -0.5);
    let (this, other) = (quotient(a, half, c2), quotient(a, c0, half));
    let near = a.select_less(this, other, this, other);
    let far = a.select_less(this, other, other, this);
    let of_near = {
        let both = product(a, far, z);
        let reach = sum(a, far, z);
        let over = less(a, both, reach, b1);
        let over = sum(a, over, b2);
        let to_own = difference(a, near, z);
        let to_far = difference(a, near, far);
        let under = product(a, to_own, to_far);
        quotient(a, over, under)
    };
    let of_both = difference(a, one, at_depth);
    let others = a.select_less(near, z, of_near, zero);
    let others = a.select_less(far, z, of_both, others);
    let quarter = scaled(a, at_depth, 0.25);
    let share = sum(a, quarter, others);
    let share = larger(a, share, zero);
    a.select_less(share, one, share, one)
}

/// Returns the larger of two values; the first can be NaN.
fn larger<A: Arithmetic>(a: &mut A, value: A::Real, least: A::Real) -> A::Real {
    a.select_less(value, least, least, value)
}

#[cfg(test)]
mod tests {
    use super::super::interface::{InputMask, List, Taps};
    use super::super::moment_absorbance;
    use super::*;
    use crate::plain::Plain;
    use etalon_scene::Params;

    fn input<'a>(
        (depth, alpha): (f32, f32),
        texels: [[[f32; 1]; 4]; 2],
        params: &'a Params,
    ) -> FragmentInput<'a, [f32; 1]> {
        FragmentInput {
            color: [[1.0], [1.0], [1.0], [alpha]],
            front: true,
            depth: [depth],
            sample: 0,
            mask: InputMask::NONE,
            position: [[0.5]; 2],
            texels,
            neighbours: None,
            taps: Taps::NONE,
            list: List::Unknown,
            reciprocal_w: [1.0],
            uv: [[0.0]; 2],
            params,
        }
    }

    /// Returns the transmittance that the moments of layers, given as depth and alpha, yield at each layer.
    fn transmittances(layers: &[(f32, f32)]) -> Vec<f32> {
        let params = Params::default();
        let mut sums = [[[0.0_f32; 1]; 4]; 2];
        for layer in layers {
            let output = moment_absorbance::fragment(
                &mut Plain::<1>,
                &input(*layer, [[[0.0]; 4]; 2], &params),
            );
            for (sum, value) in sums[0].iter_mut().zip(output.color) {
                sum[0] += value[0];
            }
            let others = output.others.expect("moments are a second output");
            for (sum, value) in sums[1].iter_mut().zip(others[0]) {
                sum[0] += value[0];
            }
        }
        let shown = layers.iter().map(|layer| {
            let output = fragment(&mut Plain::<1>, &input(*layer, sums, &params));
            output.color[3][0] / layer.1
        });
        shown.collect()
    }

    /// Returns the transmittance in front of each layer, including a quarter of its own absorbance.
    fn exact_transmittances(layers: &[(f32, f32)]) -> Vec<f32> {
        let in_front = |depth: f32| {
            let nearer = layers.iter().filter(|l| l.0 < depth);
            nearer.map(|l| 1.0 - l.1).product::<f32>()
        };
        let transmittance = |l: &(f32, f32)| in_front(l.0) * (1.0 - l.1).powf(0.25);
        layers.iter().map(transmittance).collect()
    }

    #[test]
    fn moments_separate_up_to_three_depths() {
        let depths = [0.15, 0.3, 0.45, 0.5, 0.62, 0.85];
        let alphas = [0.1, 0.5, 0.9];
        let mut worst = [0.0_f32; 3];
        for (i, first) in depths.into_iter().enumerate() {
            for (j, second) in depths.into_iter().enumerate().skip(i + 1) {
                for third in depths.into_iter().skip(j + 1) {
                    for n in 0..27_usize {
                        let alpha = |by: usize| alphas[n / by % 3];
                        // Drawn in an order that differs from that of the depths.
                        let drawn = [(second, alpha(1)), (third, alpha(3)), (first, alpha(9))];
                        for count in 1..=3 {
                            let layers = &drawn[..count];
                            for (shown, expected) in transmittances(layers)
                                .into_iter()
                                .zip(exact_transmittances(layers))
                            {
                                worst[count - 1] = worst[count - 1].max((shown - expected).abs());
                            }
                        }
                    }
                }
            }
        }
        let most = [1e-6, 1e-4, 2e-3];
        let apart = worst.iter().zip(most).all(|(worst, most)| *worst < most);
        assert!(apart, "{worst:?}");
    }

    #[test]
    fn opaque_layers_and_layers_that_absorb_nothing_give_numbers() {
        for alphas in [[1.0, 1.0], [1.0, 0.5], [0.0, 1.0], [1e-7, 1e-7], [0.0, 0.0]] {
            for depths in [[0.2, 0.8], [0.5, 0.5], [0.0, 1.0]] {
                let layers = [(depths[0], alphas[0]), (depths[1], alphas[1])];
                let shown = transmittances(&layers).into_iter().zip(alphas);
                for (value, alpha) in shown {
                    // Without alpha, nothing is visible.
                    let known = if alpha == 0.0 { 0.0 } else { value };
                    assert!((0.0..=1.0).contains(&known), "{layers:?}: {value}");
                }
            }
        }
    }
}
