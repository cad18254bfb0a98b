//! Load and store operations of passes.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED};
use crate::scenes::{blue, corners, filled, full, green_over, rect, red, test, with};
use crate::subject::CheckedBackend;
use serde_json::{Value, json};

/// Returns a draw of red over everything.
fn red_over_everything(state: Value) -> Value {
    with(
        json!({ "mesh": full(), "shader": "uniform_color", "params": red() }),
        state,
    )
}

fn stencil_equal(reference: u8) -> Value {
    json!({ "stencil": { "front": { "compare": "equal" }, "reference": reference } })
}

/// A load operation that clears removes the previous pass's drawing.
pub(crate) fn load_operations_clear_everything(subject: &CheckedBackend) -> CheckEnd {
    let load = json!({ "color": [{ "load": { "clear": [1, 0, 0, 1] } }] });
    for draws in [json!([]), json!([green_over([3, 2, 7, 11])])] {
        let painted = draws != json!([]);
        let frame = subject.show(json!({
            "attachments": { "color": blue() },
            "passes": [
                { "color": ["color"], "draws": [green_over([0, 0, 16, 9])] },
                { "color": ["color"], "draws": draws, "operations": load }],
        }))?;
        frame.color_is("color", |x, y| {
            if painted && (3..7).contains(&x) && (2..11).contains(&y) {
                GREEN
            } else {
                RED
            }
        });
    }
    Ok(())
}

/// The first pass that uses two attachments clears only one of them.
pub(crate) fn each_attachment_has_its_own_load_operation(subject: &CheckedBackend) -> CheckEnd {
    let [clear, keep] = [json!({ "load": { "clear": [0, 1, 0, 1] } }), json!({})];
    for first in [true, false] {
        let operations = if first {
            [&clear, &keep]
        } else {
            [&keep, &clear]
        };
        let frame = subject.show(json!({
            "attachments": { "a": blue(), "b": blue() },
            "passes": [{ "color": ["a", "b"], "draws": [], "operations": { "color": operations } }],
        }))?;
        frame.color_is("a", |_, _| if first { GREEN } else { BLUE });
        frame.color_is("b", |_, _| if first { BLUE } else { GREEN });
    }
    Ok(())
}

/// Depth and stencil of one attachment, each with its own load operation.
pub(crate) fn depth_and_stencil_are_loaded_apart(subject: &CheckedBackend) -> CheckEnd {
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        for (depth, stencil) in [(true, true), (true, false), (false, true)] {
            let mut operations = json!({});
            if depth {
                operations["depth"] = json!({ "load": { "clear": 0 } });
            }
            if stencil {
                operations["stencil"] = json!({ "load": { "clear": 5 } });
            }
            let frame = subject.show_if_offered(json!({
                "attachments": { "color": blue(),
                    "depth": { "format": format, "clear": { "depth": 1, "stencil": 9 } } },
                "passes": [
                    { "color": ["color"], "depth_stencil": "depth", "draws": [] },
                    { "color": ["color"], "depth_stencil": "depth", "operations": operations,
                      "draws": [
                        red_over_everything(with(json!({ "depth": test("less", false) }), stencil_equal(5))),
                        with(green_over([0, 0, 16, 16]), with(
                            json!({ "depth": test("less", false) }), stencil_equal(9)))] }],
            }));
            let Some(frame) = frame else { continue };
            // Both draws are at depth 0, so they pass where the pass keeps a depth of 1. It then clears the
            // stencil to 5, which is the reference of red.
            let red_passes = stencil && !depth;
            frame.color_is("color", |_, _| if red_passes { RED } else { BLUE });
            frame.depth_is("depth", |_, _| if depth { 0.0 } else { 1.0 });
            frame.stencil_is("depth", |_, _| if stencil { 5 } else { 9 });
        }
    }
    Ok(())
}

/// Contents that are discarded and then cleared equal contents that were stored and then cleared.
pub(crate) fn discarded_contents_are_cleared_again(subject: &CheckedBackend) -> CheckEnd {
    let discard = json!({ "store": "discard" });
    let frame = subject.show(json!({
        "attachments": { "color": blue(), "other": blue(), "t": filled(RED), "u": filled(GREEN),
            "depth": { "format": "depth24plus-stencil8", "clear": { "depth": 0, "stencil": 1 } } },
        "passes": [
            { "color": ["color", "other"], "depth_stencil": "depth",
              "draws": [{ "mesh": rect([0, 0, 8, 8]), "shader": "texel_color_all", "textures": ["t"],
                          "depth": test("always", true) }],
              "operations": { "color": [{}, discard], "depth": discard, "stencil": discard } },
            { "color": ["color", "other"], "depth_stencil": "depth",
              "draws": [{ "mesh": rect([4, 4, 12, 12]), "shader": "texel_color_all",
                  "textures": ["u"], "depth": test("less", true),
                  "stencil": { "front": { "compare": "equal", "pass_op": "increment-clamp" },
                               "reference": 7 } }],
              "operations": { "color": [{}, { "load": { "clear": [1, 0, 0, 1] } }],
                              "depth": { "load": { "clear": 1 } },
                              "stencil": { "load": { "clear": 7 } } } }],
        "read": ["color", "other", "depth"],
    }))?;
    let inside = |x: u32, y: u32| (4..12).contains(&x) && (4..12).contains(&y);
    frame.color_is("color", |x, y| match (inside(x, y), x < 8 && y < 8) {
        (true, _) => GREEN,
        (_, true) => RED,
        _ => BLUE,
    });
    frame.color_is("other", |x, y| if inside(x, y) { GREEN } else { RED });
    frame.stencil_is("depth", |x, y| if inside(x, y) { 8 } else { 7 });
    Ok(())
}

/// A discarded attachment whose average is kept, and a depth attachment that is not read.
pub(crate) fn samples_are_discarded_after_their_average(subject: &CheckedBackend) -> CheckEnd {
    let discard = json!({ "store": "discard" });
    let frame = subject.show(json!({
        "attachments": { "many": with(blue(), json!({ "samples": 4 })), "color": blue(),
            "depth": { "format": "depth32float", "samples": 4 } },
        "passes": [{ "color": ["many"], "resolve": ["color"], "depth_stencil": "depth",
            "draws": [{ "mesh": corners([2, 3, 7, 9]), "topology": "triangle-strip",
                        "shader": "uniform_color", "params": red(), "depth": test("less", true) }],
            "operations": { "color": [{ "load": { "clear": [0, 1, 0, 1] }, "store": "discard" }],
                            "depth": discard } }],
        "read": ["color"],
    }))?;
    frame.color_is("color", |x, y| {
        if (2..7).contains(&x) && (3..9).contains(&y) {
            RED
        } else {
            GREEN
        }
    });
    Ok(())
}
