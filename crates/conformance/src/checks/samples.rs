//! Attachments with several samples: positions, masks, coverage, shading and averages.

use super::CheckEnd;
use crate::frames::{
    BLUE, Expect, NONE, RED, check_samples, check_within_one, codes, color, depth, image, stencil,
    texels,
};
use crate::scenes::{everywhere, filled, painted, rect, red, red_or_green, test, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::{Aspect, Frame, Image, ReadPath, TextureFormat};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Returns an `rgba8unorm` attachment of four samples, cleared to 0.
fn four() -> Value {
    json!({ "format": "rgba8unorm", "samples": 4 })
}

/// Draws over four blue samples, and resolves them to their average.
fn averaged(s: &CheckedBackend, draw: Value) -> Result<Frame, Missing> {
    s.show(json!({
        "attachments": {
            "m": { "format": "rgba8unorm", "size": [8, 8], "samples": 4, "clear": [0, 0, 1, 1] },
            "r": { "format": "rgba8unorm", "clear": [0, 1, 0, 0] } },
        "passes": [{ "color": ["m"], "resolve": ["r"], "draws": [draw] }],
    }))
}

/// Returns a draw of a colour over every sample.
fn covered(color: [f64; 4], multisample: Value) -> Value {
    json!({ "mesh": everywhere(json!(color)), "shader": "flat_color", "multisample": multisample })
}

/// Asserts that the given samples of an image are red, and the others blue.
#[track_caller]
fn check_red(image: &Image, red: impl Fn(u32, u32, u32) -> bool) {
    check_samples(image, |x, y, s| if red(x, y, s) { RED } else { BLUE });
}

/// A rectangle whose edges cut through texels covers the samples inside it.
pub(crate) fn positions_are_those_of_the_limits(s: &CheckedBackend) -> CheckEnd {
    for (dx, dy) in [(64, 0), (192, 0), (0, 64), (0, 192), (128, 0), (0, 128)] {
        // From this corner to beyond the bottom right corner, in a single triangle.
        let (x, y) = (f64::from(dx) / 256.0, f64::from(dy) / 256.0);
        let mesh = json!({
            "kind": "vertices", "units": "texels", "values": [[1, 0, 0, 1]],
            "positions": [[x, y, 0], [x, 64, 0], [64, y, 0]] });
        let frame = averaged(s, json!({ "mesh": mesh, "shader": "flat_color" }))?;
        let positions = &s.limits().sample_positions[&4];
        assert_eq!(positions.len(), 4);
        check_red(color(&frame, "m"), |px, py, sample| {
            let [sx, sy] = positions[sample as usize];
            px * 256 + u32::from(sx) > dx && py * 256 + u32::from(sy) > dy
        });
    }
    Ok(())
}

pub(crate) fn masks_let_their_samples_through(s: &CheckedBackend) -> CheckEnd {
    for mask in [0, 0b0101, 0b1010, 0b1000, 0b1111, u32::MAX] {
        let draw = covered([1.0, 0.0, 0.0, 1.0], json!({ "mask": mask }));
        let frame = averaged(s, with(draw, painted()))?;
        let image = color(&frame, "m");
        assert_eq!((image.samples, image.read), (4, ReadPath::Copy));
        check_red(image, |_, _, sample| mask >> sample & 1 == 1);
        let red = (mask & 15).count_ones() * 255 / 4;
        for (x, y) in texels([8, 8]) {
            let came = color(&frame, "r").sample(x, y, 0);
            check_within_one(came, [red, 0, 255 - red, 255]);
        }
    }
    Ok(())
}

/// The average is taken in all texels, whatever the draws' scissor.
pub(crate) fn averages_ignore_the_scissor(s: &CheckedBackend) -> CheckEnd {
    let scissored = json!({ "mesh": everywhere(json!(1)), "scissor": [0, 0, 4, 8] });
    let frame = averaged(s, with(scissored, painted()))?;
    for image in &frame.images {
        check_red(image, |x, _, _| x < 4);
    }
    Ok(())
}

/// Draws to half of the samples of two attachments and averages only one, over a clear.
pub(crate) fn single_attachments_of_a_pass_are_averaged(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "color": four(), "other": four(), "red": filled(RED),
            "mean": { "format": "rgba8unorm", "clear": [0, 1, 0, 1] } },
        "passes": [{ "color": ["other", "color"], "resolve": [null, "mean"], "draws": [{
            "mesh": rect([0, 0, 8, 16]), "shader": "texel_color_all", "textures": ["red"],
            "multisample": { "mask": 5 } }] }],
        "read": ["color", "mean", "other"],
    }))?;
    for x in (1..7).chain(9..15) {
        let texel = color(&frame, "mean").sample(x, x, 0);
        let range = if x < 8 { 127..=128 } else { 0..=0 };
        let is_mean = range.contains(&texel[0]) && range.contains(&texel[3]);
        assert!(is_mean && texel[1..3] == [0, 0], "{texel:?}");
    }
    for name in ["color", "other"] {
        assert_eq!(color(&frame, name).sample(3, 3, 2), RED);
        assert_eq!(color(&frame, name).sample(3, 3, 3), NONE);
    }
    Ok(())
}

/// A draw over an average remains, and a later pass averages again.
pub(crate) fn averages_are_drawn_over_and_taken_again(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "color": four(), "first": { "format": "rgba8unorm" }, "second": { "format": "rgba8unorm" } },
        "passes": [
            { "color": ["color"], "resolve": ["first"], "draws": [
                with(json!({ "mesh": everywhere(json!(1)) }), painted())] },
            { "color": ["first"], "draws": [
                { "mesh": rect([0, 0, 4, 4]), "shader": "uniform_color", "params": { "color": 0 } }] },
            { "color": ["color"], "resolve": ["second"], "draws": [] }],
        "read": ["first", "second"],
    }))?;
    frame.color_is("first", |x, y| if x < 4 && y < 4 { NONE } else { RED });
    frame.color_is("second", |_, _| RED);
    Ok(())
}

pub(crate) fn alpha_takes_all_samples_or_none_away(s: &CheckedBackend) -> CheckEnd {
    for (alpha, mask, expected) in [(0.0, 15, 0), (1.0, 15, 15), (1.0, 6, 6)] {
        let multisample = json!({ "mask": mask, "alpha_to_coverage": true });
        let frame = averaged(s, covered([1.0, 0.0, 0.0, alpha], multisample))?;
        check_red(color(&frame, "m"), |_, _, sample| {
            expected >> sample & 1 == 1
        });
    }
    Ok(())
}

pub(crate) fn alpha_counts_as_one_where_asked(s: &CheckedBackend) -> CheckEnd {
    for (alpha, to_one, expected) in [
        (0.0, false, 0),
        (0.0, true, 255),
        (0.25, false, 64),
        (0.25, true, 255),
    ] {
        let draw = covered([1.0, 0.0, 0.0, alpha], json!({ "alpha_to_one": to_one }));
        averaged(s, draw)?.color_is("m", |_, _| [255, 0, 0, expected]);
    }
    Ok(())
}

pub(crate) fn shaders_run_for_each_sample(s: &CheckedBackend) -> CheckEnd {
    for format in ["rgba8unorm", "bgra8unorm"] {
        let Ok(frame) = s.show(json!({
            "attachments": { "m": { "format": format, "size": [4, 4], "samples": 4 } },
            "draws": [{ "mesh": everywhere(json!(1)), "shader": "sample_index" }],
        })) else {
            continue;
        };
        check_samples(color(&frame, "m"), |_, _, sample| {
            [sample & 1, sample >> 1 & 1, sample >> 2 & 1, 1].map(|bit| bit * 255)
        });
    }
    Ok(())
}

/// Against a clear above all depths, and a clear that the last two samples do not pass.
pub(crate) fn shaders_write_the_depth_of_each_sample(s: &CheckedBackend) -> CheckEnd {
    for clear in [1.0_f32, 2.5 / 32.0] {
        let frame = s.show(json!({
            "attachments": {
                "color": { "format": "rgba8unorm", "size": [8, 8], "samples": 4, "clear": [0, 0, 1, 1] },
                "depth": { "format": "depth32float", "samples": 4, "clear": clear } },
            "draws": [{ "mesh": everywhere(json!(1)), "shader": "sample_depth", "params": red(),
                        "depth": test("less", true) }],
        }))?;
        let written = |sample: u32| (sample as f32 + 1.0) / 32.0;
        check_red(color(&frame, "color"), |_, _, sample| {
            written(sample) < clear
        });
        check_samples(depth(&frame, "depth"), |_, _, sample| {
            [written(sample).min(clear).to_bits()]
        });
    }
    Ok(())
}

/// An edge covers only the leftmost samples of the third column, if there are several.
pub(crate) fn attributes_at_centres_are_as_in_their_texel(s: &CheckedBackend) -> CheckEnd {
    let mesh = json!({
        "kind": "vertices", "units": "texels", "values": [1],
        "positions": [[-2, -2, 0], [-2, 6, 0], [2.25, -2, 0], [2.25, 6, 0]],
        "uv": [[4.25, 0], [4.25, 0], [0, 0], [0, 0]] });
    for samples in [1, 4] {
        let Ok(frame) = s.show(json!({
            "attachments": { "color": {
                "format": "rgba8unorm", "size": [4, 4], "samples": samples, "clear": [0, 0, 1, 1] } },
            "draws": [{ "mesh": mesh, "topology": "triangle-strip", "shader": "centroid",
                        "params": red_or_green() }],
        })) else {
            continue;
        };
        let positions = &s.limits().sample_positions[&samples];
        check_red(color(&frame, "color"), |x, _, sample| {
            x * 256 + u32::from(positions[sample as usize][0]) < 2 * 256 + 64
        });
    }
    Ok(())
}

/// The coordinate is 0 on the slanted edge and grows inside.
pub(crate) fn attributes_stay_inside_slanted_edges(s: &CheckedBackend) -> CheckEnd {
    let mesh = json!({
        "kind": "vertices", "units": "texels", "positions": [[3, 0, 0], [9, 16, 0], [16, 8, 0]],
        "uv": [[0, 0], [0, 0], [1, 0]] });
    let frame = s.show(json!({
        "attachments": { "color": four() },
        "draws": [{ "mesh": mesh, "shader": "centroid", "params": red_or_green() }],
    }))?;
    let mut partly = 0;
    for texel in color(&frame, "color").codes.chunks(16) {
        let count = |color: [u32; 4]| texel.chunks(4).filter(|s| **s == color).count();
        let (covered, empty) = (count(RED), count(NONE));
        assert_eq!(covered + empty, 4, "{texel:?}");
        partly += usize::from(covered > 0 && empty > 0);
    }
    assert!(partly > 8, "{partly}");
    Ok(())
}

/// A slanted edge through the middle, from (8, 0) to (9, 16) in texels; the right side is drawn.
pub(crate) fn samples_are_drawn_one_by_one(s: &CheckedBackend) -> CheckEnd {
    let slanted = json!({
        "kind": "vertices", "values": [0.25], "positions": [[-0.125, 3, 0], [0.25, -3, 0], [6.5, 0, 0]] });
    // Four samples are requested even if they are not supported.
    let positions = s.limits().sample_positions.keys();
    let counts: BTreeSet<_> = positions
        .copied()
        .filter(|count| *count > 1)
        .chain([4])
        .collect();
    for count in counts {
        let Ok(frame) = s.show(json!({
            "attachments": {
                "color": { "format": "rgba8unorm", "samples": count },
                "ds": { "format": "depth32float-stencil8", "samples": count,
                        "clear": { "depth": 1, "stencil": 3 } } },
            "draws": [{
                "mesh": slanted, "shader": "flat_color_depth", "params": red(),
                "depth": test("less", true),
                "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } } }],
        })) else {
            continue;
        };
        let image = color(&frame, "color");
        assert_eq!(image.samples, count);
        let mut partly = 0;
        for (x, y) in texels(image.size) {
            let mut covered = 0;
            for (sample, position) in (0..).zip(&s.limits().sample_positions[&count]) {
                let coordinate = |p: u16, origin: u32| f64::from(origin) + f64::from(p) / 256.0;
                let (sx, sy) = (coordinate(position[0], x), coordinate(position[1], y));
                let distance = sx - (8.0 + sy / 16.0);
                let inside = image.sample(x, y, sample) == RED;
                covered += u32::from(inside);
                // Samples closer to the edge can be on either side, because vertices are snapped.
                if distance.abs() > 0.1 {
                    assert_eq!(inside, distance > 0.0, "({x}, {y}) sample {sample}");
                }
                let expected = if inside { (0.25_f32, 4) } else { (1.0, 3) };
                let came = depth(&frame, "ds").sample(x, y, sample);
                assert_eq!(came, [expected.0.to_bits()]);
                assert_eq!(stencil(&frame, "ds").sample(x, y, sample), [expected.1]);
            }
            partly += u32::from(covered > 0 && covered < count);
        }
        assert!(
            partly > 0,
            "no texel is partly covered with {count} samples"
        );
    }
    Ok(())
}

/// Samples 1 and 2 of every format take 1, or depth 0 and stencil 9; the others keep their clear value.
pub(crate) fn every_format_keeps_its_samples(s: &CheckedBackend) -> CheckEnd {
    for format in TextureFormat::ALL.iter().copied() {
        let clear = match (format.has_depth(), format.has_stencil()) {
            (false, false) => json!([0, 0, 1, 1]),
            (true, false) => json!(1),
            (false, true) => json!(90),
            (true, true) => json!({ "depth": 1, "stencil": 90 }),
        };
        let mut draw = drawn_to(format);
        if format.has_depth() {
            draw["depth"] = test("less", true);
        }
        if format.has_stencil() {
            draw["stencil"] =
                json!({ "reference": 9, "front": { "compare": "always", "pass_op": "replace" } });
        }
        let Ok(frame) = s.show(json!({
            "attachments": { "a": { "format": format, "size": [5, 3], "samples": 4, "clear": clear } },
            "draws": [draw],
        })) else {
            continue;
        };
        for aspect in format.aspects() {
            let image = image(&frame, "a", *aspect);
            let as_told = image.read == s.limits().formats[&format].read;
            assert!(as_told || *aspect == Aspect::Stencil, "{format}");
            check_samples(image, |_, _, sample| {
                match (aspect, [1, 2].contains(&sample)) {
                    (Aspect::Stencil, drawn) => vec![if drawn { 9 } else { 90 }],
                    (Aspect::Color, true) => codes(&image.channels, DRAWN),
                    (Aspect::Color, false) => codes(&image.channels, [0.0, 0.0, 1.0, 1.0]),
                    (_, drawn) => codes(&image.channels, [f64::from(u8::from(!drawn)); 4]),
                }
            });
        }
    }
    Ok(())
}

const DRAWN: [f64; 4] = [1.0, 1.0, 0.0, 0.0];

/// Returns a draw to samples 1 and 2.
fn drawn_to(format: TextureFormat) -> Value {
    let shader = if format.is_integer() {
        "uint_color"
    } else {
        "uniform_color"
    };
    json!({ "mesh": everywhere(json!(1)), "shader": shader, "params": { "color": DRAWN },
            "multisample": { "mask": 6 } })
}

/// Draws to half of the samples in the left half. Integers are not averaged; the resolve takes one sample.
pub(crate) fn every_format_is_averaged(s: &CheckedBackend) -> CheckEnd {
    for format in s.limits().formats.keys().filter(|f| f.is_color()) {
        let draw = with(drawn_to(*format), json!({ "scissor": [0, 0, 4, 8] }));
        let Ok(frame) = s.show(json!({
            "attachments": {
                "m": { "format": format, "size": [8, 8], "samples": 4, "clear": [0, 0, 1, 1] },
                "r": { "format": format } },
            "passes": [{ "color": ["m"], "resolve": ["r"], "draws": [draw] }],
        })) else {
            continue;
        };
        let code = |values| codes(format.color_channels(), values);
        let (drawn, kept) = (code(DRAWN), code([0.0, 0.0, 1.0, 1.0]));
        check_samples(color(&frame, "m"), |x, _, sample| {
            if x < 4 && [1, 2].contains(&sample) {
                &drawn
            } else {
                &kept
            }
        });
        for (x, y) in texels([8, 8]) {
            let came = color(&frame, "r").sample(x, y, 0);
            let taken = !format.is_integer() || came == drawn || came == kept;
            assert!(taken && (x < 4 || came == kept), "{format}: {came:?}");
        }
    }
    Ok(())
}
