//! Fragments that one pass leaves in storage and a later one reads: lists, and the nearest layers.

use super::CheckEnd;
use crate::frames::{check_near, color, texels, values};
use crate::scenes::{blend, full, scene, test};
use crate::subject::CheckedBackend;
use etalon_frame::Frame;
use serde_json::{Value, json};

/// Returns a scene that adds layers (texels, depth and colour) to lists if they are in front of a depth of
/// 0.7, and composes the lists over opaque blue.
fn listed(layers: &[([u32; 4], f64, [f64; 4])], nodes: u32) -> Value {
    let params = json!({ "color": [4, 4, 0, 0] });
    let append: Vec<Value> = layers
        .iter()
        .map(|(texels, z, value)| {
            json!({ "mesh": { "kind": "rect", "texels": texels, "z": z, "value": value },
                    "shader": "list_append", "params": params, "early_tests": "forced",
                    "depth": test("less", false), "write_mask": "" })
        })
        .collect();
    let under = json!({ "color": blend("add", "one", "src-alpha")["color"],
                        "alpha": blend("add", "zero", "one")["alpha"] });
    json!({
        "attachments": {
            "shown": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
            "depth": { "format": "depth32float", "size": [4, 4], "clear": 0.7 } },
        "passes": [
            { "color": ["shown"], "depth_stencil": "depth", "draws": append },
            { "color": ["shown"], "draws": [{
                "mesh": full(), "shader": "list_compose", "params": params, "blend": under }] }],
        "read": ["shown"],
        "pool": { "size": [4, 4], "nodes": nodes },
    })
}

fn shown(frame: &Frame, (x, y): (u32, u32)) -> [f64; 4] {
    let channels = values(color(frame, "shown"), x, y);
    std::array::from_fn(|c| channels[c])
}

const ALL: [u32; 4] = [0, 0, 4, 4];
const RED: [f64; 4] = [1.0, 0.0, 0.0, 0.5];
const GREEN: [f64; 4] = [0.0, 1.0, 0.0, 0.5];

/// The farther layer is drawn first, one layer is behind the stored depth, and one covers half of the
/// texels.
pub(crate) fn fragments_are_listed_and_composed(s: &CheckedBackend) -> CheckEnd {
    let layers = [
        (ALL, 0.6, RED),
        (ALL, 0.9, [1.0, 1.0, 1.0, 0.9]),
        ([0, 0, 2, 4], 0.2, GREEN),
    ];
    let frame = s.show(listed(&layers, 48))?;
    for (x, y) in texels([4, 4]) {
        let expected = if x < 2 {
            [0.25, 0.5, 0.25, 1.0]
        } else {
            [0.5, 0.0, 0.5, 1.0]
        };
        check_near(&shown(&frame, (x, y)), &expected, 1.01 / 255.0);
    }
    Ok(())
}

/// Whichever fragments fit, the lists have as many as the pool has nodes, in every submission.
pub(crate) fn a_full_pool_drops_the_rest(s: &CheckedBackend) -> CheckEnd {
    let scene = scene(listed(&[(ALL, 0.3, RED), (ALL, 0.4, RED)], 20));
    let mut prepared = s.prepare(&scene)?;
    for _ in 0..3 {
        s.submit(prepared.as_mut())?;
        let frame = prepared.read_back().expect("the frame is read back");
        let mut nodes = 0;
        for texel in texels([4, 4]) {
            let [red, green, blue, _] = shown(&frame, texel);
            // Each node halves the background.
            let count = (-blue.log2()).round();
            check_near(
                &[red, green, blue],
                &[1.0 - 0.5_f64.powf(count), 0.0, 0.5_f64.powf(count)],
                1.01 / 255.0,
            );
            nodes += count as u32;
        }
        assert_eq!(nodes, 20);
    }
    drop(prepared);
    s.check_silence("a full pool");
    Ok(())
}

/// The two nearest of four layers are composed in the order of their depths; the others, drawn between them,
/// are a tail with the mean of their colours. Two layers at one depth are both kept.
pub(crate) fn the_nearest_layers_are_kept_over_a_tail(s: &CheckedBackend) -> CheckEnd {
    let params = json!({ "color": [4, 4, 2, 0] });
    let blue = [0.0, 0.0, 1.0, 0.5];
    let draws = |shader: &str, state: &Value, layers: &[(f64, [f64; 4])]| -> Vec<Value> {
        let draw = |(z, value): &(f64, [f64; 4])| {
            let mut draw = json!({ "mesh": { "kind": "rect", "texels": ALL, "z": z, "value": value },
                "shader": shader, "params": params, "early_tests": "forced", "depth": test("less", false) });
            for (key, value) in state.as_object().expect("an object") {
                draw[key] = value.clone();
            }
            draw
        };
        layers.iter().map(draw).collect()
    };
    let targets = json!({ "targets": [
        { "blend": blend("add", "one", "one") },
        { "blend": blend("add", "zero", "one-minus-src") }] });
    let scene = |layers: &[(f64, [f64; 4])]| {
        json!({
            "attachments": {
                "shown": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 0, 1] },
                "sum": { "format": "rgba16float", "size": [4, 4], "clear": [0, 0, 0, 0] },
                "left": { "format": "r8unorm", "size": [4, 4], "clear": [1, 0, 0, 0] },
                "depth": { "format": "depth32float", "size": [4, 4], "clear": 0.8 } },
            "passes": [
                { "color": ["shown"], "depth_stencil": "depth",
                  "draws": draws("nearest_depths", &json!({ "write_mask": "" }), layers) },
                { "color": ["sum", "left"], "depth_stencil": "depth",
                  "draws": draws("nearest_colors", &targets, layers) },
                { "color": ["shown"], "draws": [{ "mesh": full(), "shader": "nearest_compose",
                  "textures": ["sum", "left"], "params": params,
                  "blend": { "color": blend("add", "one", "src-alpha")["color"],
                             "alpha": blend("add", "zero", "one")["alpha"] } }] }],
            "read": ["shown"],
            "pool": { "size": [4, 4], "nodes": 32, "layers": 2 },
        })
    };
    let far = [(0.6, RED), (0.7, blue)];
    let hidden = (0.9, [1.0, 1.0, 1.0, 0.9]);
    let apart = [far[0], (0.3, RED), hidden, far[1], (0.2, GREEN)];
    let level = [far[0], (0.2, GREEN), hidden, far[1], (0.2, GREEN)];
    // The tail covers three quarters of the quarter that the layers leave, half red and half blue.
    for (layers, [red, green]) in [(apart, [0.25, 0.5]), (level, [0.0, 0.75])] {
        let frame = s.show(scene(&layers))?;
        for texel in texels([4, 4]) {
            let expected = [red + 0.09375, green, 0.09375, 1.0];
            check_near(&shown(&frame, texel), &expected, 2.01 / 255.0);
        }
    }
    Ok(())
}
