//! Clears between the draws of a pass.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, RED};
use crate::scenes::{blue, full, green, green_over, test, with};
use crate::subject::CheckedBackend;
use etalon_frame::Feature;
use serde_json::{Value, json};

/// Clears of rectangles before a draw, between draws and after a draw.
pub(crate) fn clears_reach_their_rectangle(subject: &CheckedBackend) -> CheckEnd {
    let clear = |before: u32, value: Value, rect: [u32; 4]| json!({ "before": before, "color": 0, "value": value, "rect": rect });
    let frame = subject.show(json!({
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
pub(crate) fn clears_ignore_the_draws_around(subject: &CheckedBackend) -> CheckEnd {
    let discards = subject.offers(Feature::RasterizerDiscard);
    let narrow = json!({
        "mesh": full(), "shader": "uniform_color", "params": green(), "scissor": [1, 1, 2, 2],
        "write_mask": "g", "depth": test("never", false), "rasterizer_discard": discards,
        "stencil": { "front": { "compare": "never", "fail_op": "invert" }, "write_mask": 1 } });
    let frame = subject.show(json!({
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
    let inverted = |x: u32, y: u32| (1..3).contains(&x) && (1..3).contains(&y) && !discards;
    frame.stencil_is("depth", |x, y| match y {
        _ if corner(x, y) => 0x0f,
        0..4 => u32::from(inverted(x, y)),
        _ => 0xf0,
    });
    Ok(())
}

/// Clearing depth or stencil leaves the other aspect unchanged.
pub(crate) fn clears_leave_the_other_aspect(subject: &CheckedBackend) -> CheckEnd {
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        for clear in [
            json!({ "before": 1, "depth": 1 }),
            json!({ "before": 1, "stencil": 200 }),
            json!({ "before": 1, "depth": 1, "stencil": 200 }),
        ] {
            let frame = subject.show_if_offered(json!({
                "attachments": { "depth": { "format": format, "clear": { "depth": 0.25, "stencil": 100 } } },
                "passes": [{ "depth_stencil": "depth", "clears": [clear], "draws": [
                    { "mesh": { "kind": "columns", "values": [0, 0] }, "shader": "flat_color_depth",
                      "depth": test("always", true),
                      "stencil": { "front": { "compare": "always", "pass_op": "replace" }, "reference": 3 } }] }],
            }));
            let Some(frame) = frame else { continue };
            let has = |name: &str| clear.get(name).is_some();
            frame.depth_is("depth", |_, _| if has("depth") { 1.0 } else { 0.0 });
            frame.stencil_is("depth", |_, _| if has("stencil") { 200 } else { 3 });
        }
    }
    Ok(())
}

/// Clears of integers, of the second of two targets, and of all samples of a texel.
pub(crate) fn clears_know_their_target(subject: &CheckedBackend) -> CheckEnd {
    let frame = subject.show(json!({
        "attachments": { "a": blue(), "b": blue() },
        "passes": [{ "color": ["a", "b"], "draws": [],
            "clears": [{ "before": 0, "color": 1, "value": [1, 0, 0, 1], "rect": [0, 0, 16, 5] }] }],
    }))?;
    frame.color_is("a", |_, _| BLUE);
    frame.color_is("b", |_, y| if y < 5 { RED } else { BLUE });
    let integers = subject.show_if_offered(json!({
        "attachments": { "color": { "format": "rgba8uint", "clear": [1, 2, 3, 4] } },
        "passes": [{ "color": ["color"], "draws": [],
            "operations": { "color": [{ "load": { "clear": [5, 6, 7, 8] } }] },
            "clears": [{ "before": 0, "color": 0, "value": [255, 0, 1, 254], "rect": [1, 0, 15, 16] }] }],
    }));
    if let Some(frame) = integers {
        frame.color_is("color", |x, _| {
            if x == 0 {
                [5, 6, 7, 8]
            } else {
                [255, 0, 1, 254]
            }
        });
    }
    let many = subject.show_if_offered(json!({
        "attachments": { "color": with(blue(), json!({ "samples": 4 })) },
        "passes": [{ "color": ["color"], "draws": [],
            "clears": [{ "before": 0, "color": 0, "value": [1, 0, 0, 1], "rect": [3, 3, 3, 3] }] }],
    }));
    if let Some(frame) = many {
        frame.is_red(|x, y| (3..6).contains(&x) && (3..6).contains(&y));
    }
    Ok(())
}

/// Channels and bits outside a mask keep their values.
pub(crate) fn masked_clears_keep_the_rest(subject: &CheckedBackend) -> CheckEnd {
    let frame = subject.show(json!({
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
