//! Resolves of depth and stencil.

use super::CheckEnd;
use crate::frames::Expect;
use crate::scenes::{blue, corners, everywhere, red, test};
use crate::subject::CheckedBackend;
use etalon_frame::Frame;
use serde_json::{Value, json};

/// The depths of the four samples.
const DEPTHS: [u32; 4] = [1, 0, 1, 0];
/// The stencil values of the four samples. The first is neither the least nor the greatest.
const STENCILS: [u32; 4] = [7, 3, 9, 5];

/// Returns draws that give each sample its own depth and stencil value.
fn sample_by_sample(depth: bool, stencil: bool) -> Value {
    let draws = (0..4).map(|sample| {
        let mut draw = json!({ "mesh": everywhere(json!(DEPTHS[sample])), "shader": "flat_color_depth",
            "multisample": { "mask": 1 << sample } });
        if depth {
            draw["depth"] = test("always", true);
        }
        if stencil {
            draw["stencil"] = json!({ "front": { "compare": "always", "pass_op": "replace" },
                                      "reference": STENCILS[sample] });
        }
        draw
    });
    draws.collect()
}

/// Resolves four samples, each with its own depth and stencil value, to the attachment `one`.
fn resolve_samples(subject: &CheckedBackend, format: &str, mut resolve: Value) -> Option<Frame> {
    resolve["to"] = json!("one");
    let [has_depth, has_stencil] = ["depth", "stencil"].map(|aspect| format.contains(aspect));
    let clear = match (has_depth, has_stencil) {
        (true, true) => json!({ "depth": 0.25, "stencil": 100 }),
        (true, false) => json!(0.25),
        _ => json!(100),
    };
    subject.show_if_offered(json!({
        "attachments": {
            "many": { "format": format, "size": [5, 3], "samples": 4, "clear": clear },
            "one": { "format": format, "clear": clear } },
        "passes": [{ "depth_stencil": "many", "depth_stencil_resolve": resolve,
                     "draws": sample_by_sample(has_depth, has_stencil) }],
        "read": ["one"],
    }))
}

/// Resolves depth and stencil to the first, the lowest or the highest sample.
pub(crate) fn depth_and_stencil_are_resolved_by_their_modes(subject: &CheckedBackend) -> CheckEnd {
    let depth_modes = [("sample-zero", 1.0), ("min", 0.0), ("max", 1.0)];
    let stencil_modes = [("sample-zero", 7), ("min", 3), ("max", 9)];
    // `none` keeps the clear value.
    let stencil_modes_beside_depth = || stencil_modes.into_iter().chain([("none", 100)]);
    for (depth_mode, depth) in depth_modes {
        let resolve = json!({ "depth": depth_mode });
        if let Some(frame) = resolve_samples(subject, "depth32float", resolve) {
            frame.depth_is("one", |_, _| depth);
        }
        for (stencil_mode, stencil) in stencil_modes_beside_depth() {
            let resolve = json!({ "depth": depth_mode, "stencil": stencil_mode });
            if let Some(frame) = resolve_samples(subject, "depth32float-stencil8", resolve) {
                frame.depth_is("one", |_, _| depth);
                frame.stencil_is("one", |_, _| stencil);
            }
        }
    }
    for (stencil_mode, stencil) in stencil_modes {
        let resolve = json!({ "stencil": stencil_mode });
        if let Some(frame) = resolve_samples(subject, "stencil8", resolve) {
            frame.stencil_is("one", |_, _| stencil);
        }
    }
    Ok(())
}

/// Averages depths of 0 and 1, and takes the first stencil value.
pub(crate) fn depths_are_averaged(subject: &CheckedBackend) -> CheckEnd {
    let resolve = json!({ "depth": "average" });
    if let Some(frame) = resolve_samples(subject, "depth32float", resolve) {
        frame.depth_is("one", |_, _| 0.5);
    }
    let resolve = json!({ "depth": "average", "stencil": "sample-zero" });
    if let Some(frame) = resolve_samples(subject, "depth32float-stencil8", resolve) {
        frame.depth_is("one", |_, _| 0.5);
        frame.stencil_is("one", |_, _| 7);
    }
    Ok(())
}

/// A pass tests against depths that the previous pass resolved and then discarded.
pub(crate) fn what_was_resolved_is_tested(subject: &CheckedBackend) -> CheckEnd {
    let frame = subject.show(json!({
        "attachments": {
            "color": blue(),
            "many": { "format": "depth32float", "samples": 4, "clear": 1 },
            "one": { "format": "depth32float", "clear": 1 } },
        "passes": [
            { "depth_stencil": "many", "depth_stencil_resolve": { "to": "one", "depth": "sample-zero" },
              "operations": { "depth": { "store": "discard" } },
              "draws": [{ "mesh": corners([0, 0, 9, 16]), "topology": "triangle-strip",
                          "shader": "flat_color_depth", "depth": test("always", true) }] },
            { "color": ["color"], "depth_stencil": "one",
              "draws": [{ "mesh": { "kind": "rows", "values": [0.5, 0.5] }, "shader": "flat_color_depth",
                          "params": red(), "depth": test("less", false) }] }],
        "read": ["color", "one"],
    }))?;
    frame.is_red(|x, _| x >= 9);
    frame.depth_is("one", |x, _| if x < 9 { 0.0 } else { 1.0 });
    Ok(())
}
