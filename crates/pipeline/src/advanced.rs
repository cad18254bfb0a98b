//! Advanced blending (KHR_blend_equation_advanced; OpenGL ES 3.2, 15.1.5.3; Vulkan, Advanced Blend
//! Operations).
//!
//! The steps are those of the specification, in its order: divide by alpha, apply the mode's function, weigh
//! by the three parts of coverage, add. A shortcut without the division would have the same real value, but a
//! number system adds its freedom around each step, so the steps must be the ones that the specification
//! names.

use crate::arithmetic::Arithmetic;
use etalon_frame::ChannelEncoding;
use etalon_scene::AdvancedBlend;

/// Blends one premultiplied colour onto another by a mode. `encodings` are those of the destination's four
/// channels; a destination without alpha is opaque.
pub fn advanced_blend<A: Arithmetic>(
    a: &mut A,
    mode: AdvancedBlend,
    encodings: [ChannelEncoding; 4],
    src: [A::Real; 4],
    dst: [A::Real; 4],
) -> [A::Real; 4] {
    let mut operands = |colors: [A::Real; 4]| {
        let mut result = colors;
        for (value, encoding) in result.iter_mut().zip(encodings) {
            *value = a.blend_operand(encoding, *value);
        }
        result
    };
    let (src, dst) = (operands(src), operands(dst));
    let (src_alpha, dst_alpha) = (src[3], dst[3]);
    std::array::from_fn(|c| {
        let encoding = encodings[c];
        let without_src = a.blend_complement(encoding, src_alpha);
        let without_dst = a.blend_complement(encoding, dst_alpha);
        let both = a.blend_product(encoding, src_alpha, dst_alpha);
        let src_alone = a.blend_product(encoding, src_alpha, without_dst);
        let dst_alone = a.blend_product(encoding, dst_alpha, without_src);
        let terms = if c == 3 {
            [both, src_alone, dst_alone]
        } else {
            let s = a.blend_quotient(encoding, src[c], src_alpha);
            let d = a.blend_quotient(encoding, dst[c], dst_alpha);
            let mixed = mix(a, mode, encoding, s, d);
            [
                a.blend_product(encoding, mixed, both),
                a.blend_product(encoding, s, src_alone),
                a.blend_product(encoding, d, dst_alone),
            ]
        };
        let sum = a.blend_sum(encoding, terms[0], terms[1], false);
        a.blend_sum(encoding, sum, terms[2], false)
    })
}

/// Returns the mode's function f of source and destination, each divided by its alpha.
fn mix<A: Arithmetic>(
    a: &mut A,
    mode: AdvancedBlend,
    e: ChannelEncoding,
    s: A::Real,
    d: A::Real,
) -> A::Real {
    let [zero, one, two] = [0.0, 1.0, 2.0].map(|v| a.constant(v));
    match mode {
        AdvancedBlend::Multiply => a.blend_product(e, s, d),
        AdvancedBlend::Screen => {
            let sum = a.blend_sum(e, s, d, false);
            let product = a.blend_product(e, s, d);
            a.blend_sum(e, sum, product, true)
        }
        AdvancedBlend::Overlay => hard_light(a, e, d, s),
        AdvancedBlend::HardLight => hard_light(a, e, s, d),
        AdvancedBlend::Darken => a.min(s, d),
        AdvancedBlend::Lighten => a.max(s, d),
        AdvancedBlend::ColorDodge => {
            let rest = a.blend_complement(e, s);
            let ratio = a.blend_ratio(e, d, rest);
            let some = a.blend_select(one, s, one, ratio);
            a.blend_select(d, zero, zero, some)
        }
        AdvancedBlend::ColorBurn => {
            let rest = a.blend_complement(e, d);
            let ratio = a.blend_ratio(e, rest, s);
            let burnt = a.blend_complement(e, ratio);
            let some = a.blend_select(s, zero, zero, burnt);
            a.blend_select(one, d, one, some)
        }
        AdvancedBlend::SoftLight => soft_light(a, e, s, d),
        AdvancedBlend::Difference => {
            let up = a.blend_sum(e, s, d, true);
            let down = a.blend_sum(e, d, s, true);
            let distance = a.max(up, down);
            a.max(distance, zero)
        }
        AdvancedBlend::Exclusion => {
            let sum = a.blend_sum(e, s, d, false);
            let product = a.blend_product(e, s, d);
            let twice = a.blend_product(e, product, two);
            a.blend_sum(e, sum, twice, true)
        }
    }
}

/// Returns twice the product if `by` is at most a half, otherwise the inverse of twice the product of the
/// inverses.
fn hard_light<A: Arithmetic>(
    a: &mut A,
    e: ChannelEncoding,
    by: A::Real,
    other: A::Real,
) -> A::Real {
    let two = a.constant(2.0);
    let half = a.constant(0.5);
    let half = a.blend_operand(e, half);
    let product = a.blend_product(e, by, other);
    let multiplied = a.blend_product(e, product, two);
    let rests = (a.blend_complement(e, by), a.blend_complement(e, other));
    let product = a.blend_product(e, rests.0, rests.1);
    let twice = a.blend_product(e, product, two);
    let screened = a.blend_complement(e, twice);
    a.blend_select(by, half, multiplied, screened)
}

fn soft_light<A: Arithmetic>(a: &mut A, e: ChannelEncoding, s: A::Real, d: A::Real) -> A::Real {
    let [one, two, three, twelve, sixteen] = [1.0, 2.0, 3.0, 12.0, 16.0].map(|v| a.constant(v));
    let [quarter, half] = [0.25, 0.5].map(|v| {
        let value = a.constant(v);
        a.blend_operand(e, value)
    });
    let doubled = a.blend_product(e, s, two);
    let darker = {
        let weight = a.blend_sum(e, one, doubled, true);
        let rest = a.blend_complement(e, d);
        let product = a.blend_product(e, weight, d);
        let product = a.blend_product(e, product, rest);
        a.blend_sum(e, d, product, true)
    };
    let weight = a.blend_sum(e, doubled, one, true);
    let dark = {
        let inner = a.blend_product(e, sixteen, d);
        let inner = a.blend_sum(e, inner, twelve, true);
        let inner = a.blend_product(e, inner, d);
        let inner = a.blend_sum(e, inner, three, false);
        let product = a.blend_product(e, weight, d);
        let product = a.blend_product(e, product, inner);
        a.blend_sum(e, d, product, false)
    };
    let light = {
        let root = a.blend_root(e, d);
        let distance = a.blend_sum(e, root, d, true);
        let product = a.blend_product(e, weight, distance);
        a.blend_sum(e, d, product, false)
    };
    let lighter = a.blend_select(d, quarter, dark, light);
    a.blend_select(s, half, darker, lighter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plain::Plain;

    /// Returns the specification's function in 64-bit floats, written independently.
    fn exact(mode: AdvancedBlend, s: f64, d: f64) -> f64 {
        let hard = |by: f64, other: f64| {
            if by <= 0.5 {
                2.0 * by * other
            } else {
                1.0 - 2.0 * (1.0 - by) * (1.0 - other)
            }
        };
        match mode {
            AdvancedBlend::Multiply => s * d,
            AdvancedBlend::Screen => s + d - s * d,
            AdvancedBlend::Overlay => hard(d, s),
            AdvancedBlend::Darken => s.min(d),
            AdvancedBlend::Lighten => s.max(d),
            AdvancedBlend::ColorDodge if d <= 0.0 => 0.0,
            AdvancedBlend::ColorDodge if s < 1.0 => (d / (1.0 - s)).min(1.0),
            AdvancedBlend::ColorDodge => 1.0,
            AdvancedBlend::ColorBurn if d >= 1.0 => 1.0,
            AdvancedBlend::ColorBurn if s > 0.0 => 1.0 - ((1.0 - d) / s).min(1.0),
            AdvancedBlend::ColorBurn => 0.0,
            AdvancedBlend::HardLight => hard(s, d),
            AdvancedBlend::SoftLight if s <= 0.5 => d - (1.0 - 2.0 * s) * d * (1.0 - d),
            AdvancedBlend::SoftLight if d <= 0.25 => {
                d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + 3.0)
            }
            AdvancedBlend::SoftLight => d + (2.0 * s - 1.0) * (d.sqrt() - d),
            AdvancedBlend::Difference => (d - s).abs(),
            AdvancedBlend::Exclusion => s + d - 2.0 * s * d,
        }
    }

    fn run(mode: AdvancedBlend, src: [f32; 4], dst: [f32; 4]) -> [f32; 4] {
        let encodings = [ChannelEncoding::Unorm(8); 4];
        let (src, dst) = (src.map(|v| [v]), dst.map(|v| [v]));
        advanced_blend(&mut Plain::<1>, mode, encodings, src, dst).map(|[v]| v)
    }

    #[test]
    fn every_mode_blends_as_the_specification_says() {
        let values = [0.0, 0.125, 0.25, 0.4, 0.5, 0.75, 0.9, 1.0];
        for mode in AdvancedBlend::ALL.iter().copied() {
            for (s, d) in values.iter().flat_map(|s| values.map(|d| (*s, d))) {
                for (sa, da) in [(1.0, 1.0), (0.5, 1.0), (1.0, 0.25), (0.5, 0.75)] {
                    let [r, _, _, alpha] =
                        run(mode, [s * sa, 0.0, 0.0, sa], [d * da, 0.0, 0.0, da]);
                    let [s, d, sa, da] = [s, d, sa, da].map(f64::from);
                    let coverage = sa * da + sa * (1.0 - da) + da * (1.0 - sa);
                    let color =
                        exact(mode, s, d) * sa * da + s * sa * (1.0 - da) + d * da * (1.0 - sa);
                    assert!((f64::from(alpha) - coverage).abs() < 1e-6);
                    assert!((f64::from(r) - color).abs() < 1e-6, "{mode:?} {s} {d}: {r}");
                }
            }
        }
    }

    #[test]
    fn dodge_and_burn_are_exact_at_their_ends() {
        let red = |mode, s: f32, d: f32| run(mode, [s, s, s, 1.0], [d, d, d, 1.0])[0];
        let (dodge, burn) = (AdvancedBlend::ColorDodge, AdvancedBlend::ColorBurn);
        assert_eq!(red(dodge, 1.0, 0.0), 0.0);
        assert_eq!(red(dodge, 1.0, 0.1), 1.0);
        assert_eq!(red(burn, 0.0, 1.0), 1.0);
        assert_eq!(red(burn, 0.0, 0.9), 0.0);
    }

    #[test]
    fn nothing_blends_with_transparent_black() {
        let color = [0.25, 0.5, 0.125, 0.5];
        for mode in AdvancedBlend::ALL.iter().copied() {
            assert_eq!(run(mode, color, [0.0; 4]), color, "{mode:?}");
            assert_eq!(run(mode, [0.0; 4], color), color, "{mode:?}");
        }
    }
}
