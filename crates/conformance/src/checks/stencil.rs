//! Stencil tests, operations and masks, face by face.

use super::CheckEnd;
use crate::frames::{Expect, stencil};
use crate::scenes::{blue, painted, rect, red, red_or_green, test, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::{ChannelEncoding, Frame, ReadPath};
use serde_json::{Value, json};

/// Draws two columns, front faces on the left, over blue and a stencil value.
fn faces(s: &CheckedBackend, format: &str, value: u32, state: Value) -> Result<Frame, Missing> {
    let clear = match format {
        "stencil8" => json!(value),
        _ => json!({ "depth": 0, "stencil": value }),
    };
    let mesh = json!({ "kind": "columns", "values": [1, 1], "windings": ["ccw", "cw"] });
    s.show(json!({
        "attachments": { "color": blue(), "s": { "format": format, "clear": clear } },
        "draws": [with(json!({ "mesh": mesh }), state)],
    }))
}

const FORMATS: [&str; 3] = ["depth24plus-stencil8", "depth32float-stencil8", "stencil8"];

/// Front: 247 equals 5 under mask 13, so its low half replaces. Back: 9 never equals 5, so the high
/// half is inverted.
pub(crate) fn faces_have_masks_and_references_of_their_own(s: &CheckedBackend) -> CheckEnd {
    for format in FORMATS {
        let state = json!({ "shader": "front_facing", "params": red_or_green(), "stencil": {
            "front": { "compare": "equal", "fail_op": "zero", "pass_op": "replace",
                       "read_mask": 13, "write_mask": 15, "reference": 247 },
            "back": { "compare": "equal", "fail_op": "invert", "pass_op": "zero",
                      "read_mask": 255, "write_mask": 240, "reference": 9 } } });
        let frame = faces(s, format, 5, state)?;
        frame.is_red(|x, _| x < 8);
        let image = stencil(&frame, "s");
        assert_eq!(image.channels, [ChannelEncoding::Uint(8)]);
        assert_eq!(image.read, ReadPath::Copy);
        frame.stencil_is("s", |x, _| if x < 8 { 7 } else { 0xF5 });
    }
    // Front: 32 & 15 equals 240 & 15, so 32 is written through 63: 240 & !63 | 32 & 63 = 224.
    // Back: 1 is not 240, so 241 is written through 3: 240 | 1 = 241.
    let state = with(
        painted(),
        json!({ "stencil": {
        "front": { "compare": "equal", "pass_op": "replace", "fail_op": "zero",
                   "read_mask": 15, "write_mask": 63, "reference": 32 },
        "back": { "compare": "equal", "pass_op": "zero", "fail_op": "increment-wrap",
                  "read_mask": 255, "write_mask": 3, "reference": 1 } } }),
    );
    let frame = faces(s, "depth24plus-stencil8", 240, state)?;
    frame.stencil_is("s", |x, _| if x < 8 { 224 } else { 241 });
    frame.is_red(|x, _| x < 8);
    Ok(())
}

/// Front faces: 7 is less than 200, so 200 + 1. Back faces: 7 is not greater than 200, so the bits are
/// inverted. Only the low nibble and the top bit may change.
pub(crate) fn faces_have_operations_of_their_own(s: &CheckedBackend) -> CheckEnd {
    for format in FORMATS {
        for (front_face, turned) in [("ccw", false), ("cw", true)] {
            let state = json!({ "front_face": front_face, "stencil": { "reference": 7, "write_mask": 143,
                "front": { "compare": "less", "pass_op": "increment-wrap" },
                "back": { "compare": "greater", "fail_op": "invert" } } });
            let frame = faces(s, format, 200, with(painted(), state))?;
            let front = |x: u32| (x < 8) != turned;
            frame.is_red(|x, _| front(x));
            let inverted = (200 & !143) | (!200 & 143);
            frame.stencil_is("s", |x, _| if front(x) { 201 } else { inverted });
        }
    }
    Ok(())
}

/// The depth of 1 is not less than the cleared 0. One face keeps its value at 255, the other wraps to 0.
pub(crate) fn a_failed_depth_test_has_its_own_operation(s: &CheckedBackend) -> CheckEnd {
    let state = json!({ "shader": "flat_color_depth", "depth": test("less", true), "stencil": {
        "front": { "compare": "always", "depth_fail_op": "increment-clamp", "pass_op": "zero" },
        "back": { "compare": "always", "depth_fail_op": "increment-wrap", "pass_op": "zero" } } });
    let frame = faces(s, "depth24plus-stencil8", 255, state)?;
    frame.stencil_is("s", |x, _| if x < 8 { 255 } else { 0 });
    Ok(())
}

pub(crate) fn operations_follow_the_depth_test(s: &CheckedBackend) -> CheckEnd {
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        let frame = s.show(json!({
            "attachments": { "ds": { "format": format, "clear": { "depth": 0, "stencil": 5 } } },
            "draws": [{
                "mesh": { "kind": "columns", "values": [0, 1] }, "shader": "flat_color_depth",
                "depth": test("less-equal", false), "stencil": { "front": {
                    "compare": "always", "pass_op": "invert", "depth_fail_op": "decrement-clamp" } } }],
        }))?;
        frame.stencil_is("ds", |x, _| if x < 8 { 250 } else { 4 });
        frame.depth_is("ds", |_, _| 0.0);
    }
    Ok(())
}

/// Writes every value from 0 to 255 by eight replacements of one bit each, without a depth aspect.
pub(crate) fn every_bit_is_masked_by_itself(s: &CheckedBackend) -> CheckEnd {
    let mut draws = Vec::new();
    for bit in 0..8 {
        for start in (0..256).filter(|v| v % (2 << bit) == 1 << bit) {
            let (x, y, width) = (start % 16, start / 16, 1 << bit);
            let texels = if width < 16 {
                [x, y, x + width, y + 1]
            } else {
                [0, y, 16, y + width / 16]
            };
            draws.push(
                json!({ "mesh": rect(texels), "shader": "uniform_color", "params": red(),
                "stencil": { "reference": 255, "write_mask": 1 << bit,
                             "front": { "compare": "always", "pass_op": "replace" } } }),
            );
        }
    }
    let frame = s.show(json!({
        "attachments": { "stencil": { "format": "stencil8", "size": [16, 16], "clear": 0 } },
        "draws": draws,
    }))?;
    frame.stencil_is("stencil", |x, y| 16 * y + x);
    Ok(())
}
