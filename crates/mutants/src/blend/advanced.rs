//! Bugs of advanced blending: one mode for another, a step of a mode's function, the weights of coverage,
//! and the division by alpha.

use crate::hooks::{advanced_blending, faithful_advanced};
use crate::list::{CONFUSION, List, Row, SMALL};
use crate::plant::{Plant, draws};
use etalon_frame::ChannelEncoding;
use etalon_scene::AdvancedBlend;

/// Source and destination.
type Colors = [[f32; 4]; 2];
type Encodings = [ChannelEncoding; 4];
/// A whole blend.
type Whole = fn(AdvancedBlend, Encodings, Colors) -> [f32; 4];
/// A mode's function, `None` where it is right.
type Mix = fn(AdvancedBlend, f32, f32) -> Option<f32>;
/// The weights of both, of the source alone and of the destination alone, of two alphas.
type Weights = fn(f32, f32) -> [f32; 3];

pub(crate) fn add(list: &mut List) {
    list.class("blend", "blend");
    neighbours(list);
    list.rows(CONFUSION, mixes, FUNCTIONS);
    list.rows(CONFUSION, weighed, WEIGHTS);
    list.rows(CONFUSION, colors, COLORS);
    list.add(
        "advanced-never",
        CONFUSION,
        "Advanced blending is off.",
        draws(|draw| draw.targets.iter_mut().for_each(|t| t.advanced = None)),
    );
    list.add(
        "advanced-tenth-lighter",
        SMALL,
        "Advanced blends are a tenth too light.",
        advanced_blending(|mode, encodings, colors: Colors| {
            faithful_advanced(mode, encodings, colors).map(|v| v * 1.1)
        }),
    );
}

fn neighbours(list: &mut List) {
    let all = AdvancedBlend::ALL;
    for (right, wrong) in all.iter().zip(all.iter().cycle().skip(1)) {
        let (right, wrong) = (*right, *wrong);
        list.add(
            &format!("advanced-{}-as-{}", right.name(), wrong.name()),
            CONFUSION,
            format!("The mode {} acts as {}.", right.name(), wrong.name()),
            draws(move |draw| {
                for target in &mut draw.targets {
                    if target.advanced == Some(right) {
                        target.advanced = Some(wrong);
                    }
                }
            }),
        );
    }
}

/// The function of a mode, by what it makes of opaque colours.
fn mix(mode: AdvancedBlend, s: f32, d: f32) -> f32 {
    let floats = [ChannelEncoding::Float32; 4];
    faithful_advanced(mode, floats, [[s, s, s, 1.0], [d, d, d, 1.0]])[0]
}

fn over_alpha(color: f32, alpha: f32) -> f32 {
    if alpha == 0.0 { 0.0 } else { color / alpha }
}

fn composed([src, dst]: Colors, f: impl Fn(f32, f32) -> f32, weights: Weights) -> [f32; 4] {
    let [both, source, destination] = weights(src[3], dst[3]);
    std::array::from_fn(|c| match c {
        3 => both + source + destination,
        _ => {
            let (s, d) = (over_alpha(src[c], src[3]), over_alpha(dst[c], dst[3]));
            f(s, d) * both + s * source + d * destination
        }
    })
}

fn parts(s: f32, d: f32) -> [f32; 3] {
    [s * d, s * (1.0 - d), d * (1.0 - s)]
}

/// A mode's function is another one.
fn mixes(wrong: Mix) -> Plant {
    advanced_blending(move |mode, encodings, colors: Colors| {
        if wrong(mode, 0.5, 0.5).is_none() {
            return faithful_advanced(mode, encodings, colors);
        }
        let f = |s, d| wrong(mode, s, d).unwrap_or_else(|| mix(mode, s, d));
        composed(colors, f, parts)
    })
}

/// Coverage is weighed in another way.
fn weighed(weights: Weights) -> Plant {
    advanced_blending(move |mode, _, colors: Colors| {
        composed(colors, |s, d| mix(mode, s, d), weights)
    })
}

/// Source and destination are taken in another way.
fn colors(wrong: Whole) -> Plant {
    advanced_blending(wrong)
}

/// What a mode's function is instead, if the mode is this one.
fn of(mode: AdvancedBlend, this: AdvancedBlend, value: f32) -> Option<f32> {
    (mode == this).then_some(value)
}

const FUNCTIONS: &[Row<Mix>] = &[
    (
        "advanced-dodge-onto-black",
        "Colour dodge makes black white where the source is white.",
        |mode, s, d| {
            let value = if s >= 1.0 { 1.0 } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::ColorDodge, value)
        },
    ),
    (
        "advanced-dodge-by-white",
        "Colour dodge by white leaves the destination.",
        |mode, s, d| {
            let value = if s >= 1.0 { d } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::ColorDodge, value)
        },
    ),
    (
        "advanced-dodge-beyond-one",
        "Colour dodge is not held to 1.",
        |mode, s, d| {
            let value = if s < 1.0 {
                d / (1.0 - s)
            } else {
                mix(mode, s, d)
            };
            of(mode, AdvancedBlend::ColorDodge, value)
        },
    ),
    (
        "advanced-burn-onto-white",
        "Colour burn makes white black where the source is black.",
        |mode, s, d| {
            let value = if s <= 0.0 { 0.0 } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::ColorBurn, value)
        },
    ),
    (
        "advanced-burn-by-black",
        "Colour burn by black leaves the destination.",
        |mode, s, d| {
            let value = if s <= 0.0 { d } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::ColorBurn, value)
        },
    ),
    (
        "advanced-burn-below-zero",
        "Colour burn is not held to 0.",
        |mode, s, d| {
            let value = if s > 0.0 {
                1.0 - (1.0 - d) / s
            } else {
                mix(mode, s, d)
            };
            of(mode, AdvancedBlend::ColorBurn, value)
        },
    ),
    (
        "advanced-overlay-never-screens",
        "Overlay multiplies whatever the destination.",
        |mode, s, d| of(mode, AdvancedBlend::Overlay, 2.0 * s * d),
    ),
    (
        "advanced-overlay-never-multiplies",
        "Overlay screens whatever the destination.",
        |mode, s, d| {
            of(
                mode,
                AdvancedBlend::Overlay,
                1.0 - 2.0 * (1.0 - s) * (1.0 - d),
            )
        },
    ),
    (
        "advanced-hard-light-never-screens",
        "Hard light multiplies whatever the source.",
        |mode, s, d| of(mode, AdvancedBlend::HardLight, 2.0 * s * d),
    ),
    (
        "advanced-hard-light-never-multiplies",
        "Hard light screens whatever the source.",
        |mode, s, d| {
            of(
                mode,
                AdvancedBlend::HardLight,
                1.0 - 2.0 * (1.0 - s) * (1.0 - d),
            )
        },
    ),
    (
        "advanced-hard-light-once",
        "Hard light multiplies and screens once instead of twice.",
        |mode, s, d| {
            let value = if s <= 0.5 {
                s * d
            } else {
                1.0 - (1.0 - s) * (1.0 - d)
            };
            of(mode, AdvancedBlend::HardLight, value)
        },
    ),
    (
        "advanced-soft-light-never-darkens",
        "Soft light lightens whatever the source.",
        |mode, s, d| {
            let root = d.sqrt() - d;
            of(mode, AdvancedBlend::SoftLight, d + (2.0 * s - 1.0) * root)
        },
    ),
    (
        "advanced-soft-light-root-of-the-dark",
        "Soft light takes the root of dark destinations too.",
        |mode, s, d| {
            let light = d + (2.0 * s - 1.0) * (d.sqrt() - d);
            let value = if s > 0.5 { light } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::SoftLight, value)
        },
    ),
    (
        "advanced-soft-light-polynomial-of-the-light",
        "Soft light takes the polynomial of light destinations too.",
        |mode, s, d| {
            let dark = d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + 3.0);
            let value = if s > 0.5 { dark } else { mix(mode, s, d) };
            of(mode, AdvancedBlend::SoftLight, value)
        },
    ),
    (
        "advanced-soft-light-plus-four",
        "Soft light has the constant 4 of another form of its polynomial.",
        |mode, s, d| {
            let dark = d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + 4.0);
            let value = if s > 0.5 && d <= 0.25 {
                dark
            } else {
                mix(mode, s, d)
            };
            of(mode, AdvancedBlend::SoftLight, value)
        },
    ),
    (
        "advanced-soft-light-continuous",
        "Soft light is the older formula without thresholds.",
        |mode, s, d| {
            let value = (1.0 - 2.0 * s) * d * d + 2.0 * s * d;
            of(mode, AdvancedBlend::SoftLight, value)
        },
    ),
    (
        "advanced-difference-signed",
        "The difference is negative where the source is lighter.",
        |mode, s, d| of(mode, AdvancedBlend::Difference, d - s),
    ),
    (
        "advanced-exclusion-once",
        "Exclusion takes the product away once.",
        |mode, s, d| of(mode, AdvancedBlend::Exclusion, s + d - s * d),
    ),
    (
        "advanced-screen-adds",
        "Screen takes no product away.",
        |mode, s, d| of(mode, AdvancedBlend::Screen, s + d),
    ),
];

const WEIGHTS: &[Row<Weights>] = &[
    (
        "advanced-both-dropped",
        "Where source and destination lie together, nothing is left.",
        |s, d| [0.0, s * (1.0 - d), d * (1.0 - s)],
    ),
    (
        "advanced-source-alone-dropped",
        "Where the source lies alone, nothing is left.",
        |s, d| [s * d, 0.0, d * (1.0 - s)],
    ),
    (
        "advanced-destination-alone-dropped",
        "Where the destination lies alone, nothing is left.",
        |s, d| [s * d, s * (1.0 - d), 0.0],
    ),
    (
        "advanced-alone-exchanged",
        "Source and destination have each other's weights.",
        |s, d| [s * d, d * (1.0 - s), s * (1.0 - d)],
    ),
    (
        "advanced-conjoint",
        "Source and destination cover the same part, as far as they can.",
        |s, d| [s.min(d), (s - d).max(0.0), (d - s).max(0.0)],
    ),
    (
        "advanced-disjoint",
        "Source and destination cover different parts, as far as they can.",
        |s, d| [(s + d - 1.0).max(0.0), s.min(1.0 - d), d.min(1.0 - s)],
    ),
    (
        "advanced-opaque-destination",
        "The destination counts as opaque.",
        |s, _| [s, 0.0, 1.0 - s],
    ),
];

const COLORS: &[Row<Whole>] = &[
    (
        "advanced-source-not-divided",
        "The source is not divided by its alpha.",
        |mode, _, [src, dst]| {
            let [both, source, destination] = parts(src[3], dst[3]);
            let mut result = [both + source + destination; 4];
            for c in 0..3 {
                let d = over_alpha(dst[c], dst[3]);
                result[c] = mix(mode, src[c], d) * both + src[c] * source + d * destination;
            }
            result
        },
    ),
    (
        "advanced-destination-not-divided",
        "The destination is not divided by its alpha.",
        |mode, _, [src, dst]| {
            let [both, source, destination] = parts(src[3], dst[3]);
            let mut result = [both + source + destination; 4];
            for c in 0..3 {
                let s = over_alpha(src[c], src[3]);
                result[c] = mix(mode, s, dst[c]) * both + s * source + dst[c] * destination;
            }
            result
        },
    ),
    (
        "advanced-result-divided",
        "The result is divided by its alpha.",
        |mode, encodings, colors| {
            let mut result = faithful_advanced(mode, encodings, colors);
            for c in 0..3 {
                result[c] = over_alpha(result[c], result[3]);
            }
            result
        },
    ),
    (
        "advanced-nothing-from-nothing",
        "A colour divided by an alpha of 0 is no number, and so is the result.",
        |mode, encodings, colors| {
            let mut result = faithful_advanced(mode, encodings, colors);
            if colors.iter().any(|color| color[3] == 0.0) {
                result[..3].fill(f32::NAN);
            }
            result
        },
    ),
    (
        "advanced-alpha-of-the-mode",
        "Alpha is mixed by the mode's function.",
        |mode, encodings, colors| {
            let mut result = faithful_advanced(mode, encodings, colors);
            result[3] = mix(mode, colors[0][3], colors[1][3]);
            result
        },
    ),
    (
        "advanced-alpha-of-the-source",
        "Alpha is the source's.",
        |mode, encodings, colors| {
            let mut result = faithful_advanced(mode, encodings, colors);
            result[3] = colors[0][3];
            result
        },
    ),
    (
        "advanced-sides-exchanged",
        "Source and destination are exchanged.",
        |mode, encodings, [src, dst]| faithful_advanced(mode, encodings, [dst, src]),
    ),
];
