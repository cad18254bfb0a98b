//! Twin of `shaders/sharpened_sample.wgsl`.

use super::arithmetic::{clamp_to_unit, difference, magnitude, quotient, sum};
use super::interface::{FragmentInput, FragmentOutput};
use crate::arithmetic::Arithmetic;

pub(super) fn fragment<A: Arithmetic>(
    a: &mut A,
    input: &FragmentInput<'_, A::Real>,
) -> FragmentOutput<A::Real> {
    let [red, green, blue, alpha] = input.texels[0];
    let Some(neighbours) = input.neighbours else {
        let zero = a.constant(0.0);
        return FragmentOutput::of([red, green, blue, a.div(zero, zero)]);
    };
    let [across, down] = neighbours.map(|neighbour| {
        let step = difference(a, neighbour[3], alpha);
        magnitude(a, step)
    });
    let least = a.constant(0.0001);
    let slope = sum(a, across, down);
    let slope = a.max(slope, least);
    let cutoff = a.constant(input.params.color[3]);
    let above = difference(a, alpha, cutoff);
    let widths = quotient(a, above, slope);
    let half = a.constant(0.5);
    let sharpened = sum(a, widths, half);
    FragmentOutput::of([red, green, blue, clamp_to_unit(a, sharpened)])
}

#[cfg(test)]
mod tests {
    use super::super::interface::{InputMask, List, Taps};
    use super::*;
    use crate::plain::Plain;
    use etalon_scene::Params;

    /// Returns the sharpened alpha at a cutoff of 0.4, given the alphas of the texel and of its neighbours.
    fn sharpened([alpha, across, down]: [f32; 3]) -> f32 {
        let texel = |alpha: f32| [[0.0], [0.0], [0.0], [alpha]];
        let input = FragmentInput {
            color: [[0.0]; 4],
            front: true,
            depth: [0.0],
            sample: 0,
            mask: InputMask::NONE,
            position: [[0.5]; 2],
            texels: [texel(alpha), texel(0.0)],
            neighbours: Some([texel(across), texel(down)]),
            taps: Taps::NONE,
            list: List::Unknown,
            reciprocal_w: [1.0],
            uv: [[0.0]; 2],
            params: &Params {
                color: [0.0, 0.0, 0.0, 0.4],
                back_color: [0.0; 4],
            },
        };
        fragment(&mut Plain::<1>, &input).color[3][0]
    }

    #[test]
    fn an_edge_is_a_texel_wide_and_its_middle_is_at_the_cutoff() {
        for (alphas, expected) in [
            ([0.4, 0.5, 0.4], 0.5),
            ([0.45, 0.55, 0.45], 1.0),
            ([0.4, 0.3, 0.6], 0.5),
            ([0.35, 0.45, 0.25], 0.25),
        ] {
            let alpha = sharpened(alphas);
            assert!((alpha - expected).abs() < 1e-6, "{alphas:?}: {alpha}");
        }
        assert_eq!([sharpened([0.5; 3]), sharpened([0.3; 3])], [1.0, 0.0]);
    }
}
