//! Advanced blends: plain results are inside judging ones, and so are the results of every computation that
//! the texts permit; results that the texts define exactly are exact.

use crate::arithmetic::wider;
use crate::common::{all_rules, assert_inside, assert_within, config};
use etalon_frame::{Api, ChannelEncoding, CodeInterval};
use etalon_pipeline::{Arithmetic, Plain, advanced_blend};
use etalon_reference::{Judging, Rules};
use etalon_scene::AdvancedBlend;
use proptest::prelude::*;
use proptest::sample::select;

const BYTE: ChannelEncoding = ChannelEncoding::Unorm(8);

/// A premultiplied colour of codes, and its alpha.
fn premultiplied() -> impl Strategy<Value = [u32; 4]> {
    let alpha = prop_oneof![select(vec![0_u32, 1, 127, 128, 254, 255]), 0_u32..=255];
    alpha.prop_flat_map(|alpha| {
        let color = move || prop_oneof![select(vec![0, alpha, alpha / 2, alpha / 4]), 0..=alpha];
        [color(), color(), color()].prop_map(move |[r, g, b]| [r, g, b, alpha])
    })
}

/// A mode, a source and the codes of a destination.
type Blend = (AdvancedBlend, [f32; 4], [u32; 4]);

fn blends() -> impl Strategy<Value = Blend> {
    let value = |code: u32| f32::from(code as u8) / 255.0;
    let mode = select(AdvancedBlend::ALL);
    (mode, premultiplied(), premultiplied()).prop_map(move |(m, s, d)| (m, s.map(value), d))
}

fn plain(encoding: ChannelEncoding, (mode, src, dst): &Blend) -> [i64; 4] {
    let mut a = Plain::<1>;
    let dst = dst.map(|c| a.decode(encoding, [c]));
    let src = src.map(|v| [v]);
    advanced_blend(&mut a, *mode, [encoding; 4], src, dst)
        .map(|v| encoding.order_of_code(a.encode(encoding, v)[0]))
}

fn judged(rules: &Rules, encoding: ChannelEncoding, (mode, src, dst): &Blend) -> [CodeInterval; 4] {
    let mut a = Judging::of_advanced_blends(rules);
    let src = src.map(|v| a.constant(v));
    let exact = |c: u32| CodeInterval::exact(encoding.order_of_code(c));
    let dst = dst.map(|c| a.decode(encoding, exact(c)));
    advanced_blend(&mut a, *mode, [encoding; 4], src, dst).map(|v| a.encode(encoding, v))
}

/// The blend in 64-bit floats, without a division where only source or destination covers; each step is
/// rounded down or up to `1 / scale`, by the bits of `up`.
fn stepwise((mode, src, dst): &Blend, scale: f64, up: u32) -> [f64; 4] {
    let mut bit = 0;
    let mut step = |v: f64| {
        let code = (v * scale * (1.0 + 1e-15)) + 1e-9;
        bit += 1;
        let rounded = match up >> (bit % 32) & 1 {
            0 => code.floor(),
            _ => (code - 2e-9).ceil(),
        };
        rounded / scale
    };
    let src = src.map(|v| step(f64::from(v)));
    let dst = dst.map(|c| f64::from(c) / 255.0);
    let (sa, da) = (src[3], dst[3]);
    let mut divided = |v: f64, alpha: f64| if alpha == 0.0 { 0.0 } else { step(v / alpha) };
    let s: [f64; 3] = std::array::from_fn(|c| divided(src[c], sa));
    let d: [f64; 3] = std::array::from_fn(|c| divided(dst[c], da));
    let both = step(sa * da);
    std::array::from_fn(|c| match c {
        3 => both + step(sa * (1.0 - da)) + step(da * (1.0 - sa)),
        _ => {
            let (s, d) = (s[c], d[c]);
            let mixed = match mode {
                AdvancedBlend::Multiply => step(s * d),
                AdvancedBlend::Screen => s + d - step(s * d),
                AdvancedBlend::Darken => s.min(d),
                AdvancedBlend::Lighten => s.max(d),
                AdvancedBlend::Difference => (s - d).abs(),
                AdvancedBlend::Exclusion => s + d - 2.0 * step(s * d),
                AdvancedBlend::Overlay if d <= 0.5 => 2.0 * step(s * d),
                AdvancedBlend::HardLight if s <= 0.5 => 2.0 * step(s * d),
                AdvancedBlend::Overlay | AdvancedBlend::HardLight => {
                    1.0 - 2.0 * step((1.0 - s) * (1.0 - d))
                }
                AdvancedBlend::ColorDodge if d <= 0.0 => 0.0,
                AdvancedBlend::ColorDodge if s < 1.0 => step(d / (1.0 - s)).min(1.0),
                AdvancedBlend::ColorDodge => 1.0,
                AdvancedBlend::ColorBurn if d >= 1.0 => 1.0,
                AdvancedBlend::ColorBurn if s > 0.0 => 1.0 - step((1.0 - d) / s).min(1.0),
                AdvancedBlend::ColorBurn => 0.0,
                AdvancedBlend::SoftLight if s <= 0.5 => {
                    let product = step((1.0 - 2.0 * s) * d);
                    d - step(product * (1.0 - d))
                }
                AdvancedBlend::SoftLight if d <= 0.25 => {
                    let inner = step((16.0 * d - 12.0) * d) + 3.0;
                    let product = step((2.0 * s - 1.0) * d);
                    d + step(product * inner)
                }
                AdvancedBlend::SoftLight => {
                    let root = step(d.sqrt());
                    d + step((2.0 * s - 1.0) * (root - d))
                }
            };
            // The part covered by one colour alone is its premultiplied colour, minus the part covered by
            // both.
            step(mixed * both) + step(src[c] * (1.0 - da)) + step(dst[c] * (1.0 - sa))
        }
    })
}

proptest! {
    #![proptest_config(config(4000))]

    #[test]
    fn a_plain_advanced_blend_into_8_bits_is_inside_every_judged_interval(blend in blends()) {
        let codes = plain(BYTE, &blend);
        for rules in all_rules() {
            let intervals = judged(&rules, BYTE, &blend);
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn a_plain_advanced_blend_into_floats_is_inside_every_judged_interval(
        (mode, src, dst) in blends()
    ) {
        let dst = dst.map(|c| (f32::from(c as u8) / 255.0).to_bits());
        let blend = (mode, src, dst);
        let encoding = ChannelEncoding::Float32;
        let codes = plain(encoding, &blend);
        for rules in all_rules() {
            let intervals = judged(&rules, encoding, &blend);
            assert_inside(rules.name, codes, intervals)?;
        }
    }

    #[test]
    fn steps_rounded_to_destination_codes_are_legal(blend in blends(), up in any::<u32>()) {
        let value = stepwise(&blend, 255.0, up);
        for rules in all_rules().into_iter().filter(|r| r.name != "yardstick") {
            let intervals = judged(&rules, BYTE, &blend);
            for c in 0..4 {
                let code = (value[c].clamp(0.0, 1.0) * 255.0).round() as i64;
                prop_assert!(
                    intervals[c].contains(code),
                    "{}, channel {c}: {code} is not in {:?}", rules.name, intervals[c]
                );
            }
        }
    }

    #[test]
    fn wider_rules_give_wider_advanced_blends(blend in blends()) {
        for (tight, wide) in wider() {
            let (inner, outer) = (judged(&tight, BYTE, &blend), judged(&wide, BYTE, &blend));
            assert_within(inner, outer, &wide)?;
        }
    }
}

/// The codes of one channel of opaque colours, by OpenGL ES.
fn opaque(mode: AdvancedBlend, s: f32, d: u32) -> CodeInterval {
    let rules = Rules::of(&crate::common::limits(Api::OpenGlEs));
    judged(&rules, BYTE, &(mode, [s, s, s, 1.0], [d, d, d, 255]))[0]
}

#[test]
fn dodge_and_burn_are_judged_exactly_at_their_ends() {
    let (dodge, burn) = (AdvancedBlend::ColorDodge, AdvancedBlend::ColorBurn);
    let (white, black) = (CodeInterval::exact(255), CodeInterval::exact(0));
    assert_eq!(opaque(dodge, 1.0, 0), black);
    assert_eq!(opaque(dodge, 1.0, 1), white);
    assert_eq!(opaque(dodge, 0.0, 0), black);
    assert_eq!(opaque(burn, 0.0, 255), white);
    assert_eq!(opaque(burn, 0.0, 254), black);
    assert_eq!(opaque(burn, 1.0, 255), white);
    // The others add terms that are not 0, and a sum is as exact as a float.
    for mode in [
        AdvancedBlend::Multiply,
        AdvancedBlend::Overlay,
        AdvancedBlend::Darken,
        AdvancedBlend::Lighten,
        AdvancedBlend::ColorDodge,
        AdvancedBlend::ColorBurn,
        AdvancedBlend::HardLight,
    ] {
        for (s, d) in [(0.0, 0), (0.0, 255), (1.0, 0), (1.0, 255)] {
            assert_eq!(opaque(mode, s, d).count(), 1, "{mode:?} {s} {d}");
        }
    }
}

#[test]
fn a_colour_without_alpha_leaves_the_component_undefined() {
    let rules = Rules::of(&crate::common::limits(Api::OpenGlEs));
    for mode in AdvancedBlend::ALL {
        let ill = (*mode, [0.5, 0.0, 0.0, 0.0], [51, 102, 0, 255]);
        let [red, green, blue, alpha] = judged(&rules, BYTE, &ill);
        assert_eq!(red, CodeInterval::new(0, 255), "{mode:?}");
        assert!(
            green.contains(102) && green.count() < 8,
            "{mode:?} {green:?}"
        );
        assert_eq!(blue, CodeInterval::exact(0), "{mode:?}");
        assert_eq!(alpha, CodeInterval::exact(255), "{mode:?}");
    }
}
