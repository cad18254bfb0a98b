//! Bugs of advanced blending: a mode is replaced by another, or a mode's function, the weights of coverage
//! or the division by alpha is wrong.

use crate::fields::FieldPlaces;
use crate::hooks::{advanced_blending, faithful_advanced};
use crate::list::{SMALL, bugs};
use crate::plant::{Plant, draws};
use etalon_frame::ChannelEncoding;
use etalon_scene::AdvancedBlend;

/// The colours of source and destination.
type Colors = [[f32; 4]; 2];
/// Returns the weights of the overlap, of the source alone and of the destination alone, for two alphas.
type OverlapWeights = fn(f32, f32) -> [f32; 3];

/// Returns the result of a mode's function for opaque colours.
fn mix(mode: AdvancedBlend, s: f32, d: f32) -> f32 {
    let floats = [ChannelEncoding::Float32; 4];
    faithful_advanced(mode, floats, [[s, s, s, 1.0], [d, d, d, 1.0]])[0]
}

fn over_alpha(color: f32, alpha: f32) -> f32 {
    if alpha == 0.0 { 0.0 } else { color / alpha }
}

/// Blends with a function and weights. `divided` says which of the colours are divided by their alphas.
fn composed(
    [src, dst]: Colors,
    f: impl Fn(f32, f32) -> f32,
    weights: OverlapWeights,
    divided: [bool; 2],
) -> [f32; 4] {
    let [both, source, destination] = weights(src[3], dst[3]);
    let side = |color: [f32; 4], divided: bool, c: usize| {
        over_alpha(color[c], if divided { color[3] } else { 1.0 })
    };
    std::array::from_fn(|c| match c {
        3 => both + source + destination,
        _ => {
            let (s, d) = (side(src, divided[0], c), side(dst, divided[1], c));
            f(s, d) * both + s * source + d * destination
        }
    })
}

fn parts(s: f32, d: f32) -> [f32; 3] {
    [s * d, s * (1.0 - d), d * (1.0 - s)]
}

/// Replaces the function of a mode, given its correct result.
fn mixes(wrong: AdvancedBlend, function: fn(f32, f32, f32) -> f32) -> Plant {
    advanced_blending(move |mode, encodings, colors: Colors| {
        if mode != wrong {
            return faithful_advanced(mode, encodings, colors);
        }
        composed(
            colors,
            |s, d| function(mix(mode, s, d), s, d),
            parts,
            [true; 2],
        )
    })
}

/// Replaces the weights of coverage.
fn weighed(weights: OverlapWeights) -> Plant {
    advanced_blending(move |mode, _, colors: Colors| {
        composed(colors, |s, d| mix(mode, s, d), weights, [true; 2])
    })
}

/// Blends without dividing source or destination by its alpha.
fn undivided(divided: [bool; 2]) -> Plant {
    advanced_blending(move |mode, _, colors: Colors| {
        composed(colors, |s, d| mix(mode, s, d), parts, divided)
    })
}

/// Changes the result, given the mode and the colours.
fn results(bug: fn(AdvancedBlend, Colors, &mut [f32; 4])) -> Plant {
    advanced_blending(move |mode, encodings, colors| {
        let mut result = faithful_advanced(mode, encodings, colors);
        bug(mode, colors, &mut result);
        result
    })
}

bugs! {
    class "blend", "blend";
    let modes = AdvancedBlend::ALL.iter().copied();
    let next = modes.clone().cycle().skip(1);
    let mode: FieldPlaces<AdvancedBlend> = |d| d.targets.iter_mut().filter_map(|t| t.advanced.as_mut()).collect();
    swaps "advanced-", "The mode ", mode, modes.zip(next);
    "advanced-dodge-onto-black: Colour dodge by white makes black white." =>
        mixes(AdvancedBlend::ColorDodge, |right, s, _d| if s >= 1.0 { 1.0 } else { right });
    "advanced-dodge-by-white: Colour dodge by white leaves the destination." =>
        mixes(AdvancedBlend::ColorDodge, |right, s, d| if s >= 1.0 { d } else { right });
    "advanced-dodge-beyond-one: Colour dodge is not held to 1." =>
        mixes(AdvancedBlend::ColorDodge, |right, s, d| if s < 1.0 { d / (1.0 - s) } else { right });
    "advanced-burn-onto-white: Colour burn makes white black where the source is black." =>
        mixes(AdvancedBlend::ColorBurn, |right, s, _d| if s <= 0.0 { 0.0 } else { right });
    "advanced-burn-by-black: Colour burn by black leaves the destination." =>
        mixes(AdvancedBlend::ColorBurn, |right, s, d| if s <= 0.0 { d } else { right });
    "advanced-burn-below-zero: Colour burn is not held to 0." =>
        mixes(AdvancedBlend::ColorBurn, |right, s, d| if s > 0.0 { 1.0 - (1.0 - d) / s } else { right });
    "advanced-overlay-never-screens: Overlay multiplies whatever the destination." =>
        mixes(AdvancedBlend::Overlay, |_, s, d| 2.0 * s * d);
    "advanced-overlay-never-multiplies: Overlay screens whatever the destination." =>
        mixes(AdvancedBlend::Overlay, |_, s, d| 1.0 - 2.0 * (1.0 - s) * (1.0 - d));
    "advanced-hard-light-never-screens: Hard light multiplies whatever the source." =>
        mixes(AdvancedBlend::HardLight, |_, s, d| 2.0 * s * d);
    "advanced-hard-light-never-multiplies: Hard light screens whatever the source." =>
        mixes(AdvancedBlend::HardLight, |_, s, d| 1.0 - 2.0 * (1.0 - s) * (1.0 - d));
    "advanced-hard-light-once: Hard light multiplies and screens once instead of twice." =>
        mixes(AdvancedBlend::HardLight, |_, s, d| if s <= 0.5 { s * d } else { 1.0 - (1.0 - s) * (1.0 - d) });
    "advanced-soft-light-never-darkens: Soft light lightens whatever the source." =>
        mixes(AdvancedBlend::SoftLight, |_, s, d| { let root = d.sqrt() - d; d + (2.0 * s - 1.0) * root });
    "advanced-soft-light-root-of-the-dark: Soft light takes the root of dark destinations too." =>
        mixes(AdvancedBlend::SoftLight, |right, s, d| {
            let light = d + (2.0 * s - 1.0) * (d.sqrt() - d);
            if s > 0.5 { light } else { right }
        });
    "advanced-soft-light-polynomial-of-the-light: Light destinations take the polynomial." =>
        mixes(AdvancedBlend::SoftLight, |right, s, d| {
            let dark = d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + 3.0);
            if s > 0.5 { dark } else { right }
        });
    "advanced-soft-light-plus-four: Soft light has the constant 4 of another polynomial." =>
        mixes(AdvancedBlend::SoftLight, |right, s, d| {
            let dark = d + (2.0 * s - 1.0) * d * ((16.0 * d - 12.0) * d + 4.0);
            if s > 0.5 && d <= 0.25 { dark } else { right }
        });
    "advanced-soft-light-continuous: Soft light is the older formula without thresholds." =>
        mixes(AdvancedBlend::SoftLight, |_, s, d| (1.0 - 2.0 * s) * d * d + 2.0 * s * d);
    "advanced-difference-signed: The difference is negative where the source is lighter." =>
        mixes(AdvancedBlend::Difference, |_, s, d| d - s);
    "advanced-exclusion-once: Exclusion takes the product away once." =>
        mixes(AdvancedBlend::Exclusion, |_, s, d| s + d - s * d);
    "advanced-screen-adds: Screen takes no product away." => mixes(AdvancedBlend::Screen, |_, s, d| s + d);
    "advanced-both-dropped: Where source and destination lie together, nothing is left." =>
        weighed(|s, d| [0.0, s * (1.0 - d), d * (1.0 - s)]);
    "advanced-source-alone-dropped: Where the source lies alone, nothing is left." =>
        weighed(|s, d| [s * d, 0.0, d * (1.0 - s)]);
    "advanced-destination-alone-dropped: Where the destination lies alone, nothing is left." =>
        weighed(|s, d| [s * d, s * (1.0 - d), 0.0]);
    "advanced-alone-exchanged: Source and destination have each other's weights." =>
        weighed(|s, d| [s * d, d * (1.0 - s), s * (1.0 - d)]);
    "advanced-conjoint: Source and destination cover the same part, as far as they can." =>
        weighed(|s, d| [s.min(d), (s - d).max(0.0), (d - s).max(0.0)]);
    "advanced-disjoint: Source and destination cover different parts, if they can." =>
        weighed(|s, d| [(s + d - 1.0).max(0.0), s.min(1.0 - d), d.min(1.0 - s)]);
    "advanced-opaque-destination: The destination counts as opaque." => weighed(|s, _| [s, 0.0, 1.0 - s]);
    "advanced-source-not-divided: The source is not divided by its alpha." => undivided([false, true]);
    "advanced-destination-not-divided: The destination is not divided by its alpha." => undivided([true, false]);
    "advanced-result-divided: The result is divided by its alpha." =>
        results(|_, _, result| (0..3).for_each(|c| result[c] = over_alpha(result[c], result[3])));
    "advanced-nothing-from-nothing: What is divided by an alpha of 0 is no number." =>
        results(|_, colors, result| if colors.iter().any(|color| color[3] == 0.0) { result[..3].fill(f32::NAN) });
    "advanced-alpha-of-the-mode: Alpha is mixed by the mode's function." =>
        results(|mode, colors, result| result[3] = mix(mode, colors[0][3], colors[1][3]));
    "advanced-alpha-of-the-source: Alpha is the source's." => results(|_, colors, result| result[3] = colors[0][3]);
    "advanced-sides-exchanged: Source and destination are exchanged." =>
        advanced_blending(|mode, encodings, [src, dst]| faithful_advanced(mode, encodings, [dst, src]));
    "advanced-never: Advanced blending is off." =>
        draws(|draw| draw.targets.iter_mut().for_each(|t| t.advanced = None));
    "advanced-tenth-lighter: Advanced blends are a tenth too light." =>
        results(|_, _, result| *result = result.map(|v| v * 1.1)), source SMALL;
}
