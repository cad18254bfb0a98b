//! Separating and combining layers: depth peeling from one end or from both, weighted sums, and samples
//! discarded by thresholds.

use super::CheckEnd;
use crate::frames::{Expect, GREEN, NONE, RED, check_near, color, texels, values};
use crate::scenes::{blend, blue, full, test, with};
use crate::subject::CheckedBackend;
use etalon_frame::Frame;
use serde_json::{Value, json};

/// Draws three layers in the wrong order, each smaller than the one behind it.
fn layers(state: Value) -> Vec<Value> {
    let layers = [
        ([0.0, 0.0, 1.0, 0.25], [0, 0, 8, 4], 0.75),
        ([1.0, 0.0, 0.0, 0.5], [0, 0, 4, 4], 0.25),
        ([0.0, 1.0, 0.0, 1.0], [0, 0, 8, 2], 0.5),
    ];
    let draws = layers.iter().map(|(value, texels, z)| {
        let mesh = json!({ "kind": "rect", "texels": texels, "z": z, "value": value });
        with(json!({ "mesh": mesh }), state.clone())
    });
    draws.collect()
}

/// Returns a float attachment of 8 by 4 texels.
fn float(format: &str, clear: [i32; 4]) -> Value {
    json!({ "format": format, "size": [8, 4], "clear": clear })
}

/// Asserts that a texel of floats is near these values.
#[track_caller]
fn near(frame: &Frame, name: &str, (x, y): (u32, u32), expected: [f64; 4], off: f64) {
    check_near(&values(color(frame, name), x, y), &expected, off);
}

/// The last pass ignores the depth that the shader writes.
pub(crate) fn layers_are_peeled_one_by_one(s: &CheckedBackend) -> CheckEnd {
    let names = ["first", "second", "third"];
    let mut attachments = json!({
        "none": float("rgba32float", [0, 0, 0, 1]),
        "after-first": float("rgba32float", [1, 0, 0, 1]),
        "after-second": float("rgba32float", [1, 0, 0, 1]) });
    for name in names {
        attachments[name] = json!({ "format": "rgba8unorm" });
        attachments[format!("z-{name}")] = json!({ "format": "depth32float", "clear": 1 });
    }
    let pass = |name: &str, color: &[&str], before: &str| {
        let state = json!({ "shader": "peel", "textures": [before], "depth": test("less", true) });
        json!({ "color": color, "depth_stencil": format!("z-{name}"), "draws": layers(state) })
    };
    let frame = s.show(json!({
        "attachments": attachments,
        "passes": [pass("first", &["first", "after-first"], "none"),
                   pass("second", &["second", "after-second"], "after-first"),
                   pass("third", &["third"], "after-second")],
        "read": ["after-second", "first", "second", "third"],
    }))?;
    let [red, green, blue] = [[255, 0, 0, 128], GREEN, [0, 0, 255, 64]];
    for (index, name) in names.into_iter().enumerate() {
        frame.color_is(name, |x, y| {
            let peeled: &[[u32; 4]] = match (x, y) {
                (0..4, 0..2) => &[red, green, blue],
                (0..4, _) => &[red, blue],
                (_, 0..2) => &[green, blue],
                _ => &[blue],
            };
            *peeled.get(index).unwrap_or(&NONE)
        });
    }
    near(&frame, "after-second", (0, 0), [0.5, 0.0, 0.0, 1.0], 1e-6);
    near(&frame, "after-second", (7, 1), [0.75, 0.0, 0.0, 1.0], 1e-6);
    near(&frame, "after-second", (7, 3), [1.0, 0.0, 0.0, 1.0], 0.0);
    Ok(())
}

/// The nearest and the farthest layer are peeled in the same pass, by maxima of 32-bit floats.
pub(crate) fn layers_are_peeled_from_both_ends(s: &CheckedBackend) -> CheckEnd {
    let max = blend("max", "one", "one");
    let range = json!({ "shader": "depth_range", "blend": max });
    let peel = json!({ "shader": "dual_peel", "blend": max, "textures": ["range", "none"] });
    let frame = s.show(json!({
        "attachments": {
            "range": float("rgba32float", [-1, 0, 0, 0]),
            "next": float("rgba32float", [-1, -1, 0, 0]),
            "none": float("rgba16float", [0; 4]),
            "front": float("rgba16float", [0; 4]),
            "back": float("rgba16float", [0; 4]) },
        "passes": [{ "color": ["range"], "draws": layers(range) },
                   { "color": ["next", "front", "back"], "draws": layers(peel) }],
        "read": ["back", "front", "next", "range"],
    }))?;
    near(&frame, "range", (1, 1), [-0.25, 0.75, 0.0, 1.0], 1e-6);
    near(&frame, "next", (1, 1), [-0.5, 0.5, 0.0, 1.0], 1e-6);
    near(&frame, "front", (1, 1), [0.5, 0.0, 0.0, 0.5], 1e-6);
    near(&frame, "back", (1, 1), [0.0, 0.0, 1.0, 0.25], 1e-6);
    // A single layer counts as the nearest layer.
    near(&frame, "front", (7, 3), [0.0, 0.0, 0.25, 0.25], 1e-6);
    near(&frame, "back", (7, 3), [0.0; 4], 0.0);
    Ok(())
}

/// Sums and products in one pass, and how both combine with the background.
pub(crate) fn weighted_layers_are_summed_and_shown(s: &CheckedBackend) -> CheckEnd {
    let layer = |texels: [u32; 4], color: [f64; 4]| {
        json!({ "mesh": { "kind": "rect", "texels": texels, "z": 0.5, "value": color },
                "shader": "weighted_accumulate", "targets": [
                    { "blend": blend("add", "one", "one") },
                    { "blend": blend("add", "zero", "one-minus-src") }] })
    };
    let frame = s.show(json!({
        "attachments": {
            "sum": { "format": "rgba16float", "size": [4, 4] },
            "left": { "format": "r8unorm", "clear": [1, 0, 0, 0] },
            "shown": blue() },
        "passes": [
            { "color": ["sum", "left"], "draws": [
                layer([0, 0, 4, 4], [1.0, 0.0, 0.0, 0.5]), layer([0, 0, 2, 3], [0.0, 1.0, 0.0, 0.5])] },
            { "color": ["shown"], "draws": [{
                "mesh": full(), "shader": "weighted_resolve", "textures": ["sum", "left"],
                "blend": blend("add", "one-minus-src-alpha", "src-alpha") }] }],
    }))?;
    // The weight is 0.5 * 3000 * 0.5^3 = 187.5, by alpha and depth. Each layer adds its colour times its alpha of 0.5,
    // times the weight.
    let weighted = 0.5 * 187.5;
    for (x, y) in texels([4, 4]) {
        let (green, left, shown) = if x < 2 && y < 3 {
            (weighted, 0.25, [0.375, 0.375, 0.25])
        } else {
            (0.0, 0.5, [0.5, 0.0, 0.5])
        };
        near(
            &frame,
            "sum",
            (x, y),
            [weighted, green, 0.0, weighted + green],
            0.2,
        );
        check_near(&values(color(&frame, "left"), x, y), &[left], 1.01 / 255.0);
        check_near(
            &values(color(&frame, "shown"), x, y)[..3],
            &shown,
            3.0 / 255.0,
        );
    }
    Ok(())
}

/// Two layers at different depths, the farther one first. The moments give the light that reaches each of
/// them.
pub(crate) fn moments_give_the_light_that_reaches_each_layer(s: &CheckedBackend) -> CheckEnd {
    let attachment = || json!({ "format": "rgba32float", "size": [4, 4] });
    let two_layers = |shader: &str, textures: &[&str]| {
        let layer = |texels: [u32; 4], z: f64, color: [f64; 4]| {
            json!({ "mesh": { "kind": "rect", "texels": texels, "z": z, "value": color }, "shader": shader,
                    "textures": textures, "blend": blend("add", "one", "one") })
        };
        let far = layer([0, 0, 4, 4], 0.75, [1.0, 0.0, 0.0, 0.5]);
        [far, layer([0, 0, 2, 3], 0.25, [0.0, 1.0, 0.0, 0.5])]
    };
    let frame = s.show(json!({
        "attachments": { "absorbance": attachment(), "moments": attachment(), "sum": attachment(), "shown": blue() },
        "passes": [
            { "color": ["absorbance", "moments"], "draws": two_layers("moment_absorbance", &[]) },
            { "color": ["sum"], "draws": two_layers("moment_transmittance", &["absorbance", "moments"]) },
            { "color": ["shown"], "draws": [{
                "mesh": full(), "shader": "moment_resolve", "textures": ["sum", "absorbance"],
                "blend": blend("add", "one-minus-src-alpha", "src-alpha") }] }],
        "read": ["absorbance", "moments", "shown", "sum"],
    }))?;
    // A quarter of a layer's own absorbance counts as in front of it.
    let transmittance = 0.5_f64.powf(0.25) * 0.5;
    for (x, y) in texels([4, 4]) {
        let (absorbance, moments, green, red, shown) = if x < 2 && y < 3 {
            (
                2.0,
                [0.0, 0.5, 0.0, 0.125],
                transmittance,
                transmittance * 0.5,
                [0.25, 0.5, 0.25],
            )
        } else {
            (
                1.0,
                [0.5, 0.25, 0.125, 0.0625],
                0.0,
                transmittance,
                [0.5, 0.0, 0.5],
            )
        };
        near(&frame, "absorbance", (x, y), [absorbance; 4], 1e-4);
        near(&frame, "moments", (x, y), moments, 1e-4);
        near(&frame, "sum", (x, y), [red, green, 0.0, red + green], 1e-3);
        check_near(
            &values(color(&frame, "shown"), x, y)[..3],
            &shown,
            3.0 / 255.0,
        );
    }
    Ok(())
}

/// Each of four samples has its own threshold, in a texture that an earlier pass drew.
pub(crate) fn samples_are_discarded_by_thresholds(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": [4, 4], "samples": 4 },
            "thresholds": { "format": "rgba8unorm" } },
        "passes": [
            { "color": ["thresholds"], "draws": [{ "mesh": full(), "shader": "uniform_color",
                "params": { "color": [0.875, 0.25, 0.625, 0.125] } }] },
            { "color": ["color"], "draws": [{ "mesh": { "kind": "cover", "value": [1, 0, 0, 0.5] },
                "shader": "stochastic", "textures": ["thresholds"] }] }],
        "read": ["color"],
    }))?;
    for texel in color(&frame, "color").codes.chunks(16) {
        assert_eq!(texel, [NONE, RED, NONE, RED].concat());
    }
    Ok(())
}
