//! The texels that a draw covers, and the channels that it writes.

use super::CheckEnd;
use crate::frames::{BLUE, Expect, GREEN, NONE, RED, check_within_one, color};
use crate::scenes::{
    blend, blue, component, full, green, over_blue, painted, rect, red, red_or_green, test,
    uploaded, with,
};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::ReadPath;
use serde_json::{Value, json};

pub(crate) fn a_rectangle_stays_in_its_corner(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": with(blue(), json!({ "size": [16, 8] })) },
        "draws": [{ "mesh": rect([0, 0, 5, 3]), "shader": "uniform_color", "params": red() }],
    }))?;
    assert_eq!(color(&frame, "color").read, ReadPath::Copy);
    frame.is_red(|x, y| x < 5 && y < 3);
    Ok(())
}

pub(crate) fn columns_run_to_the_right_and_rows_down(s: &CheckedBackend) -> CheckEnd {
    let parts = [RED, GREEN, [51, 102, 153, 204], NONE, [255, 0, 255, 0]];
    let values = parts.map(|codes| codes.map(|code| f64::from(code) / 255.0));
    for (kind, across) in [("columns", true), ("rows", false)] {
        let frame = s.show(json!({
            "attachments": { "color": { "format": "rgba8unorm", "size": [20, 10], "clear": [1, 1, 1, 1] } },
            "draws": [{ "mesh": { "kind": kind, "values": values }, "shader": "flat_color" }],
        }))?;
        frame.color_is("color", |x, y| {
            parts[if across { x / 4 } else { y / 2 } as usize]
        });
    }
    Ok(())
}

pub(crate) fn a_pass_without_draws_leaves_the_clear_values(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "clear": [0, 1, 0, 1] },
            "ds": { "format": "depth24plus-stencil8", "clear": { "depth": 1, "stencil": 171 } },
            "idle": { "format": "rgba8unorm", "clear": [1, 0, 0, 1] },
            "stencil": { "format": "stencil8", "clear": 7 } },
        "passes": [{ "color": ["color"], "depth_stencil": "ds", "draws": [] }],
        "read": ["idle", "ds", "color", "stencil"],
    }))?;
    frame.color_is("color", |_, _| GREEN);
    frame.color_is("idle", |_, _| RED);
    frame.depth_is("ds", |_, _| 1.0);
    frame.stencil_is("ds", |_, _| 171);
    frame.stencil_is("stencil", |_, _| 7);
    Ok(())
}

/// Rows whose length in bytes has no useful alignment.
pub(crate) fn sizes_need_not_be_even(s: &CheckedBackend) -> CheckEnd {
    for size in [[1, 1], [7, 3], [65, 2], [200, 130]] {
        let frame = s.show(json!({
            "attachments": {
                "color": with(blue(), json!({ "size": size })),
                "ds": { "format": "depth24plus-stencil8", "clear": { "depth": 1, "stencil": 3 } } },
            "draws": [{
                "mesh": rect([0, 0, 1, 1]), "shader": "flat_color_depth", "params": red(),
                "depth": test("less", true),
                "stencil": { "front": { "compare": "always", "pass_op": "invert" } } }],
        }))?;
        let first = |x, y| x == 0 && y == 0;
        frame.is_red(first);
        frame.stencil_is("ds", |x, y| if first(x, y) { 252 } else { 3 });
        frame.depth_is("ds", |x, y| if first(x, y) { 0.0 } else { 1.0 });
    }
    Ok(())
}

/// With y up, the left column is wound counter-clockwise.
pub(crate) fn faces_are_told_apart_and_culled(s: &CheckedBackend) -> CheckEnd {
    for cull in ["none", "front", "back", "front-and-back"] {
        for front_face in ["ccw", "cw"] {
            let Ok(frame) = s.show(over_blue(json!({
                "mesh": { "kind": "columns", "values": [0, 0], "windings": ["ccw", "cw"] },
                "shader": "front_facing", "params": red_or_green(),
                "cull": cull, "front_face": front_face })))
            else {
                continue;
            };
            frame.color_is("color", |x, _| {
                match (cull, (x < 8) == (front_face == "ccw")) {
                    ("none" | "back", true) => RED,
                    ("none" | "front", false) => GREEN,
                    _ => BLUE,
                }
            });
        }
    }
    Ok(())
}

/// Every second triangle of a strip has the opposite vertex order.
pub(crate) fn strips_keep_their_winding(s: &CheckedBackend) -> CheckEnd {
    for (positions, expected) in [
        ([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]], RED),
        ([[-1, 1, 0], [-1, -1, 0], [1, 1, 0], [1, -1, 0]], RED),
        ([[-1, -1, 0], [-1, 1, 0], [1, -1, 0], [1, 1, 0]], GREEN),
    ] {
        let frame = s.show(over_blue(json!({
            "mesh": { "kind": "vertices", "positions": positions }, "topology": "triangle-strip",
            "shader": "front_facing", "params": red_or_green() })))?;
        frame.color_is("color", |_, _| expected);
    }
    Ok(())
}

/// Draws a colour over another, and returns the result, which must be the same in all texels.
fn drawn_over(
    s: &CheckedBackend,
    clear: [f64; 4],
    source: [f64; 4],
    state: Value,
) -> Result<[u32; 4], Missing> {
    let draw = json!({ "mesh": full(), "shader": "uniform_color", "params": { "color": source } });
    let frame = s.show(json!({
        "attachments": { "color": { "format": "rgba8unorm", "size": [4, 4], "clear": clear } },
        "draws": [with(draw, state)],
    }))?;
    let texel: [u32; 4] = color(&frame, "color").sample(3, 3, 0).try_into().unwrap();
    frame.color_is("color", |_, _| texel);
    Ok(texel)
}

/// Operation and factors for colour, then for alpha, the constant, and the result.
type Blend = ([&'static str; 3], [&'static str; 3], [f64; 4], [u32; 4]);

/// Blue at 0.6 over opaque red.
#[rustfmt::skip]
const BLENDS: [Blend; 8] = [
    (["add", "src-alpha", "one-minus-src-alpha"], ["add", "src-alpha", "one-minus-src-alpha"], [0.0; 4], [102, 0, 153, 194]),
    (["add", "src-alpha", "one-minus-src-alpha"], ["add", "one", "zero"], [0.0; 4], [102, 0, 153, 153]),
    (["add", "src-alpha", "one-minus-src-alpha"], ["add", "one", "one-minus-src-alpha"], [0.0; 4], [102, 0, 153, 255]),
    (["add", "constant-alpha", "constant"], ["add", "constant-alpha", "constant"], [0.2, 0.0, 0.0, 0.4], [51, 0, 102, 163]),
    (["add", "constant", "zero"], ["add", "src-alpha", "one"], [0.2, 0.4, 0.6, 1.0], [0, 0, 153, 255]),
    (["add", "zero", "constant"], ["add", "src-alpha", "zero"], [0.2, 0.4, 0.6, 1.0], [51, 0, 0, 92]),
    (["max", "zero", "zero"], ["max", "zero", "zero"], [0.0; 4], [255, 0, 255, 255]),
    (["reverse-subtract", "one", "one"], ["reverse-subtract", "one", "one"], [0.0; 4], [255, 0, 0, 102]),
];

pub(crate) fn blending_weighs_source_and_destination(s: &CheckedBackend) -> CheckEnd {
    let state = |rgb: [&str; 3], alpha: [&str; 3], constant: [f64; 4]| {
        let [rgb, alpha] = [rgb, alpha].map(|[op, src, dst]| component(op, src, dst));
        json!({ "blend": { "color": rgb, "alpha": alpha }, "blend_constant": constant })
    };
    for (rgb, alpha, constant, expected) in BLENDS {
        let state = state(rgb, alpha, constant);
        if let Ok(texel) = drawn_over(s, [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.6], state) {
            check_within_one(&texel, expected);
        }
    }
    let alpha = ["add", "constant-alpha", "one-minus-constant-alpha"];
    let state = state(["add", "constant", "zero"], alpha, [0.2, 0.4, 0.6, 0.8]);
    let texel = drawn_over(s, [1.0; 4], [1.0, 1.0, 1.0, 0.0], state)?;
    check_within_one(&texel, [51, 102, 153, 51]);
    Ok(())
}

pub(crate) fn write_masks_keep_the_other_channels(s: &CheckedBackend) -> CheckEnd {
    for bits in 0..16_usize {
        let on = |i: usize| bits >> i & 1 == 1;
        let mask: String = (0..4)
            .filter(|i| on(*i))
            .map(|i| ["r", "g", "b", "a"][i])
            .collect();
        for (clear, source) in [
            ([0.0; 4], [1.0; 4]),
            ([1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 1.0]),
        ] {
            let texel = drawn_over(s, clear, source, json!({ "write_mask": mask }))?;
            let expected =
                [0, 1, 2, 3].map(|i| if on(i) { source[i] } else { clear[i] } as u32 * 255);
            assert_eq!(texel, expected, "{mask}");
        }
    }
    Ok(())
}

/// The first pass writes depths. The second one tests against them but must not write any.
pub(crate) fn a_pass_tests_what_an_earlier_one_wrote(s: &CheckedBackend) -> CheckEnd {
    let frame = s.show(json!({
        "attachments": { "color": blue(), "d": { "format": "depth16unorm", "clear": 1 } },
        "passes": [
            { "depth_stencil": "d", "draws": [
                { "mesh": rect([0, 0, 16, 4]), "shader": "flat_color_depth", "depth": test("always", true) }] },
            { "color": ["color"], "depth_stencil": "d", "depth_stencil_read_only": true, "draws": [
                { "mesh": { "kind": "full", "value": 0.5 }, "shader": "flat_color_depth",
                  "params": red(), "depth": test("less", false) }] }],
    }))?;
    frame.is_red(|_, y| y >= 4);
    frame.depth_is("d", |_, y| if y < 4 { 0.0 } else { 1.0 });
    Ok(())
}

/// Draws to two attachments alternately, the first with depth and stencil.
pub(crate) fn passes_keep_contents(s: &CheckedBackend) -> CheckEnd {
    let columns = [1, 2, 3, 4, 5, 6].map(|x| [x, 2, 3, 4]);
    let frame = s.show(json!({
        "attachments": {
            "color": with(blue(), json!({ "size": [6, 4] })),
            "ds": { "format": "depth24plus-stencil8", "clear": { "depth": 1, "stencil": 5 } },
            "drawn": uploaded("columns", columns) },
        "passes": [
            { "color": ["color"], "depth_stencil": "ds", "draws": [{
                "mesh": rect([0, 0, 3, 4]), "shader": "flat_color_depth", "params": red(),
                "depth": test("less", true), "stencil": {
                    "reference": 9, "front": { "compare": "always", "pass_op": "replace" } } }] },
            { "color": ["drawn"], "draws": [
                { "mesh": rect([1, 0, 2, 4]), "shader": "uniform_color", "params": green() }] },
            { "color": ["color"], "depth_stencil": "ds", "draws": [{
                "mesh": full(), "shader": "uniform_color", "params": green(),
                "stencil": { "reference": 5, "front": { "compare": "equal" } } }] }],
    }))?;
    frame.color_is("color", |x, _| if x < 3 { RED } else { GREEN });
    frame.color_is(
        "drawn",
        |x, _| if x == 1 { GREEN } else { columns[x as usize] },
    );
    frame.stencil_is("ds", |x, _| if x < 3 { 9 } else { 5 });
    frame.depth_is("ds", |x, _| if x < 3 { 0.0 } else { 1.0 });
    Ok(())
}

/// Indices count from the draw's own first vertex, although draws share buffers.
pub(crate) fn draws_of_a_pass_have_their_own_vertices(s: &CheckedBackend) -> CheckEnd {
    let points = json!({
        "kind": "vertices", "units": "texels", "indices": [0, 2],
        "positions": [[1.5, 2.5, 0], [9.5, 4.5, 0], [15.5, 15.5, 0]] });
    let square = json!({
        "kind": "vertices", "units": "texels", "indices": [0, 1, 2, 2, 1, 3],
        "positions": [[8, 8, 0], [8, 12, 0], [12, 8, 0], [12, 12, 0]] });
    let frame = s.show(json!({
        "attachments": { "color": blue() },
        "draws": [
            { "mesh": points, "topology": "point-list", "shader": "flat_color" },
            with(painted(), json!({ "mesh": rect([0, 0, 4, 4]), "blend": blend("add", "one", "one") })),
            with(painted(), json!({ "mesh": square }))],
    }))?;
    frame.color_is("color", |x, y| match (x, y) {
        (15, 15) => NONE,
        (1, 2) => RED,
        (0..4, 0..4) => [255, 0, 255, 255],
        (8..12, 8..12) => RED,
        _ => BLUE,
    });
    Ok(())
}
