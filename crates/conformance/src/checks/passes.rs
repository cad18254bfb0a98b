//! Load and store operations of passes, and clears between their draws.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED};
use crate::scenes::{blue, corners, everywhere, filled, full, green, rect, red, test, with};
use crate::subject::CheckedBackend;
use etalon_frame::Feature;
use serde_json::{Value, json};

/// Returns a draw of green over a part.
fn green_over(texels: [u32; 4]) -> Value {
    json!({ "mesh": rect(texels), "shader": "uniform_color", "params": green() })
}

/// Returns a draw of red over everything.
fn probe(state: Value) -> Value {
    with(
        json!({ "mesh": full(), "shader": "uniform_color", "params": red() }),
        state,
    )
}

fn stencil_equal(reference: u8) -> Value {
    json!({ "stencil": { "front": { "compare": "equal" }, "reference": reference } })
}

/// A load operation that clears removes the previous pass's drawing.
pub(crate) fn load_operations_clear_everything(s: &CheckedBackend) -> CheckEnd {
    let load = json!({ "color": [{ "load": { "clear": [1, 0, 0, 1] } }] });
    for draws in [json!([]), json!([green_over([3, 2, 7, 11])])] {
        let painted = draws != json!([]);
        let frame = s.show(json!({
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
pub(crate) fn each_attachment_has_its_own_load_operation(s: &CheckedBackend) -> CheckEnd {
    let [clear, keep] = [json!({ "load": { "clear": [0, 1, 0, 1] } }), json!({})];
    for first in [true, false] {
        let both = if first {
            [&clear, &keep]
        } else {
            [&keep, &clear]
        };
        let frame = s.show(json!({
            "attachments": { "a": blue(), "b": blue() },
            "passes": [{ "color": ["a", "b"], "draws": [], "operations": { "color": both } }],
        }))?;
        frame.color_is("a", |_, _| if first { GREEN } else { BLUE });
        frame.color_is("b", |_, _| if first { BLUE } else { GREEN });
    }
    Ok(())
}

/// Depth and stencil of one attachment, each with its own load operation.
pub(crate) fn depth_and_stencil_are_loaded_apart(s: &CheckedBackend) -> CheckEnd {
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        for (depth, stencil) in [(true, true), (true, false), (false, true)] {
            let mut operations = json!({});
            if depth {
                operations["depth"] = json!({ "load": { "clear": 0 } });
            }
            if stencil {
                operations["stencil"] = json!({ "load": { "clear": 5 } });
            }
            let Ok(frame) = s.show(json!({
                "attachments": { "color": blue(),
                    "depth": { "format": format, "clear": { "depth": 1, "stencil": 9 } } },
                "passes": [
                    { "color": ["color"], "depth_stencil": "depth", "draws": [] },
                    { "color": ["color"], "depth_stencil": "depth", "operations": operations,
                      "draws": [
                        probe(with(json!({ "depth": test("less", false) }), stencil_equal(5))),
                        with(green_over([0, 0, 16, 16]), with(
                            json!({ "depth": test("less", false) }), stencil_equal(9)))] }],
            })) else {
                continue;
            };
            let expected = match (depth, stencil) {
                (false, true) => RED,
                _ => BLUE,
            };
            frame.color_is("color", |_, _| expected);
            frame.depth_is("depth", |_, _| if depth { 0.0 } else { 1.0 });
            frame.stencil_is("depth", |_, _| if stencil { 5 } else { 9 });
        }
    }
    Ok(())
}

/// Contents that are discarded and then cleared equal contents that were stored and then cleared.
pub(crate) fn discarded_contents_are_cleared_again(s: &CheckedBackend) -> CheckEnd {
    let discard = json!({ "store": "discard" });
    let frame = s.show(json!({
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
pub(crate) fn samples_are_discarded_after_their_average(s: &CheckedBackend) -> CheckEnd {
    let discard = json!({ "store": "discard" });
    let frame = s.show(json!({
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

/// Clears of rectangles before a draw, between draws and after a draw.
pub(crate) fn clears_reach_their_rectangle(s: &CheckedBackend) -> CheckEnd {
    let clear = |before: u32, value: Value, rect: [u32; 4]| json!({ "before": before, "color": 0, "value": value, "rect": rect });
    let frame = s.show(json!({
        "attachments": { "color": blue() },
        "passes": [{ "color": ["color"], "draws": [
                green_over([4, 0, 8, 16]), green_over([0, 9, 16, 10])],
            "clears": [
                clear(0, json!([1, 0, 0, 1]), [0, 0, 6, 3]),
                clear(1, json!([1, 1, 1, 1]), [5, 2, 7, 9]),
                clear(2, json!([0, 0, 0, 0]), [15, 15, 1, 1])] }],
    }))?;
    frame.color_is("color", |x, y| {
        let white = (5..12).contains(&x) && (2..11).contains(&y);
        match (x, y) {
            (15, 15) => [0; 4],
            (_, 9) => GREEN,
            _ if white => [255; 4],
            (4..8, _) => GREEN,
            (0..6, 0..3) => RED,
            _ => BLUE,
        }
    });
    Ok(())
}

/// The state of the draw before a clear: scissor, masks, discarded primitives and tests.
pub(crate) fn clears_ignore_the_draws_around(s: &CheckedBackend) -> CheckEnd {
    let discards = s.offers(Feature::RasterizerDiscard);
    let narrow = json!({
        "mesh": full(), "shader": "uniform_color", "params": green(), "scissor": [1, 1, 2, 2],
        "write_mask": "g", "depth": test("never", false), "rasterizer_discard": discards,
        "stencil": { "front": { "compare": "never", "fail_op": "invert" }, "write_mask": 1 } });
    let frame = s.show(json!({
        "attachments": { "color": blue(),
            "depth": { "format": "depth24plus-stencil8", "clear": { "depth": 0, "stencil": 0 } } },
        "passes": [{ "color": ["color"], "depth_stencil": "depth",
            "draws": [narrow, with(green_over([8, 0, 16, 16]), json!({ "depth": test("less", true) })), narrow],
            "clears": [
                { "before": 1, "color": 0, "value": [1, 0, 0, 1] },
                { "before": 1, "depth": 1, "rect": [0, 0, 16, 12] },
                { "before": 1, "stencil": 0xf0, "rect": [0, 4, 16, 12] },
                { "before": 3, "depth": 1, "stencil": 0x0f, "rect": [14, 14, 2, 2] }] }],
    }))?;
    let corner = |x: u32, y: u32| x >= 14 && y >= 14;
    frame.color_is("color", |x, y| if x >= 8 && y < 12 { GREEN } else { RED });
    let drawn = |x: u32, y: u32| (1..3).contains(&x) && (1..3).contains(&y) && !discards;
    frame.stencil_is("depth", |x, y| match y {
        _ if corner(x, y) => 0x0f,
        0..4 => u32::from(drawn(x, y)),
        _ => 0xf0,
    });
    Ok(())
}

/// Clearing depth or stencil leaves the other aspect unchanged.
pub(crate) fn clears_leave_the_other_aspect(s: &CheckedBackend) -> CheckEnd {
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        for clear in [
            json!({ "before": 1, "depth": 1 }),
            json!({ "before": 1, "stencil": 200 }),
            json!({ "before": 1, "depth": 1, "stencil": 200 }),
        ] {
            let Ok(frame) = s.show(json!({
                "attachments": { "depth": { "format": format, "clear": { "depth": 0.25, "stencil": 100 } } },
                "passes": [{ "depth_stencil": "depth", "clears": [clear], "draws": [
                    { "mesh": { "kind": "columns", "values": [0, 0] }, "shader": "flat_color_depth",
                      "depth": test("always", true),
                      "stencil": { "front": { "compare": "always", "pass_op": "replace" }, "reference": 3 } }] }],
            })) else {
                continue;
            };
            let has = |name: &str| clear.get(name).is_some();
            frame.depth_is("depth", |_, _| if has("depth") { 1.0 } else { 0.0 });
            frame.stencil_is("depth", |_, _| if has("stencil") { 200 } else { 3 });
        }
    }
    Ok(())
}

/// Clears of integers, of the second of two targets, and of all samples of a texel.
pub(crate) fn clears_know_their_target(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "a": blue(), "b": blue() },
        "passes": [{ "color": ["a", "b"], "draws": [],
            "clears": [{ "before": 0, "color": 1, "value": [1, 0, 0, 1], "rect": [0, 0, 16, 5] }] }],
    }))?;
    frame.color_is("a", |_, _| BLUE);
    frame.color_is("b", |_, y| if y < 5 { RED } else { BLUE });
    let integers = s.show(json!({
        "attachments": { "color": { "format": "rgba8uint", "clear": [1, 2, 3, 4] } },
        "passes": [{ "color": ["color"], "draws": [],
            "operations": { "color": [{ "load": { "clear": [5, 6, 7, 8] } }] },
            "clears": [{ "before": 0, "color": 0, "value": [255, 0, 1, 254], "rect": [1, 0, 15, 16] }] }],
    }));
    if let Ok(frame) = integers {
        frame.color_is("color", |x, _| {
            if x == 0 {
                [5, 6, 7, 8]
            } else {
                [255, 0, 1, 254]
            }
        });
    }
    let many = s.show(json!({
        "attachments": { "color": with(blue(), json!({ "samples": 4 })) },
        "passes": [{ "color": ["color"], "draws": [],
            "clears": [{ "before": 0, "color": 0, "value": [1, 0, 0, 1], "rect": [3, 3, 3, 3] }] }],
    }));
    if let Ok(frame) = many {
        frame.is_red(|x, y| (3..6).contains(&x) && (3..6).contains(&y));
    }
    Ok(())
}

/// Channels and bits outside a mask keep their values.
pub(crate) fn masked_clears_keep_the_rest(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": blue(),
            "depth": { "format": "depth24plus-stencil8", "clear": { "depth": 0, "stencil": 0xaa } } },
        "passes": [{ "color": ["color"], "depth_stencil": "depth", "draws": [],
            "clears": [
                { "before": 0, "color": 0, "value": [1, 1, 0, 0], "write_mask": "ra" },
                { "before": 0, "color": 0, "value": [0, 1, 0, 1], "write_mask": "g", "rect": [2, 2, 2, 2] },
                { "before": 0, "depth": 1, "write_mask": false },
                { "before": 0, "stencil": 0x55, "write_mask": 0x0f },
                { "before": 0, "depth": 1, "stencil": 0xff, "rect": [8, 0, 8, 16],
                  "write_mask": { "depth": true, "stencil": 0x80 } },
                { "before": 0, "depth": 0, "stencil": 0, "rect": [8, 0, 8, 8],
                  "write_mask": { "depth": false, "stencil": 0x80 } }] }],
    }))?;
    let inner = |x: u32, y: u32| (2..4).contains(&x) && (2..4).contains(&y);
    frame.color_is("color", |x, y| {
        [255, if inner(x, y) { 255 } else { 0 }, 255, 0]
    });
    frame.depth_is("depth", |x, _| if x < 8 { 0.0 } else { 1.0 });
    frame.stencil_is("depth", |x, y| if x >= 8 && y < 8 { 0x25 } else { 0xa5 });
    Ok(())
}

/// The depths and stencil values of four samples. The first one is neither the least nor the greatest
/// stencil value.
const DEPTHS: [u32; 4] = [1, 0, 1, 0];
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

/// Resolves depth and stencil to the first, the lowest or the highest sample.
pub(crate) fn depth_and_stencil_are_resolved_by_their_modes(s: &CheckedBackend) -> CheckEnd {
    let depths = [("sample-zero", 1.0), ("min", 0.0), ("max", 1.0)];
    let stencils = [("sample-zero", 7), ("min", 3), ("max", 9), ("none", 100)];
    for format in ["depth32float", "depth32float-stencil8", "stencil8"] {
        for (by, depth) in depths {
            for (stencil_by, stencil) in stencils {
                let format_has = |name: &str| format.contains(name);
                let [has_depth, has_stencil] = [format_has("depth"), format_has("stencil")];
                let mut resolve = json!({ "to": "one" });
                if has_depth {
                    resolve["depth"] = json!(by);
                }
                if has_stencil {
                    resolve["stencil"] = json!(stencil_by);
                }
                if !has_depth && (by != "min" || stencil_by == "none")
                    || !has_stencil && stencil_by != "min"
                {
                    continue;
                }
                let clear = match (has_depth, has_stencil) {
                    (true, true) => json!({ "depth": 0.25, "stencil": 100 }),
                    (true, false) => json!(0.25),
                    _ => json!(100),
                };
                let shown = s.show(json!({
                    "attachments": {
                        "many": { "format": format, "size": [5, 3], "samples": 4, "clear": clear },
                        "one": { "format": format, "clear": clear } },
                    "passes": [{ "depth_stencil": "many", "depth_stencil_resolve": resolve,
                                 "draws": sample_by_sample(has_depth, has_stencil) }],
                    "read": ["one"],
                }));
                let Ok(frame) = shown else { continue };
                if has_depth {
                    frame.depth_is("one", |_, _| depth);
                }
                if has_stencil {
                    frame.stencil_is("one", |_, _| stencil);
                }
            }
        }
    }
    Ok(())
}

/// Averages depths of 0 and 1, and takes the first stencil value.
pub(crate) fn depths_are_averaged(s: &CheckedBackend) -> CheckEnd {
    for (format, clear, stencil) in [
        ("depth32float", json!(0.25), false),
        (
            "depth32float-stencil8",
            json!({ "depth": 0.25, "stencil": 100 }),
            true,
        ),
    ] {
        let mut resolve = json!({ "to": "one", "depth": "average" });
        if stencil {
            resolve["stencil"] = json!("sample-zero");
        }
        let shown = s.show(json!({
            "attachments": {
                "many": { "format": format, "size": [5, 3], "samples": 4, "clear": clear },
                "one": { "format": format, "clear": clear } },
            "passes": [{ "depth_stencil": "many", "depth_stencil_resolve": resolve,
                         "draws": sample_by_sample(true, stencil) }],
            "read": ["one"],
        }));
        let Ok(frame) = shown else { continue };
        frame.depth_is("one", |_, _| 0.5);
        if stencil {
            frame.stencil_is("one", |_, _| 7);
        }
    }
    Ok(())
}

/// A pass tests against depths that the previous pass resolved and then discarded.
pub(crate) fn what_was_resolved_is_tested(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
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
