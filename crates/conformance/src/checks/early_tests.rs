//! Tests before the shader, and promises about the depth that the shader writes.

use super::CheckEnd;
use super::counters::{check_painted, counted};
use crate::frames::{BLUE, Expect, RED};
use crate::scenes::{blue, red, test, uploaded, with};
use crate::subject::CheckedBackend;
use serde_json::{Value, json};

/// Discards the columns from the tenth on; forced early tests have already stored their depth.
fn discards(s: &CheckedBackend, shader: &str, kinds: Value, names: Value) -> CheckEnd {
    for (early, behind) in [("implicit", 0.5), ("forced", 0.25)] {
        let draw = json!({
            "mesh": { "kind": "full", "z": 0.25 }, "shader": shader, "textures": ["half"],
            "params": { "color": 0.5 }, "early_tests": early, "counters": names,
            "depth": test("less", true) });
        let frame = counted(s, kinds.clone(), vec![draw])?;
        check_painted(&frame, |x, _| x < 10);
        frame.depth_is("depth", |x, _| if x < 10 { 0.25 } else { behind });
    }
    Ok(())
}

pub(crate) fn discarded_fragments_leave_early_depths_alone(s: &CheckedBackend) -> CheckEnd {
    discards(s, "texel_discard", json!({}), json!([]))
}

pub(crate) fn discards_that_count_leave_early_depths_alone(s: &CheckedBackend) -> CheckEnd {
    discards(
        s,
        "counted_discard",
        json!({ "n": "shader-runs" }),
        json!(["n"]),
    )
}

/// Depth and stencil in one attachment.
pub(crate) fn discarded_fragments_leave_early_stencils_alone(s: &CheckedBackend) -> CheckEnd {
    let texels = [RED, RED, [255, 0, 0, 0], [255, 0, 0, 0]];
    for (tests, early) in [("implicit", false), ("forced", true)] {
        let frame = s.show(json!({
            "attachments": {
                "color": with(blue(), json!({ "size": [4, 4] })), "source": uploaded("columns", texels),
                "ds": { "format": "depth32float-stencil8", "clear": { "depth": 1, "stencil": 3 } } },
            "draws": [{
                "mesh": { "kind": "full", "z": 0.5 }, "shader": "texel_discard", "textures": ["source"],
                "params": { "color": [0, 0, 0, 0.5] }, "early_tests": tests,
                "depth": test("less", true),
                "stencil": { "front": { "compare": "always", "pass_op": "increment-wrap" } } }],
        }))?;
        frame.color_is("color", |x, _| if x < 2 { RED } else { BLUE });
        let tested = |x: u32| x < 2 || early;
        frame.depth_is("ds", |x, _| if tested(x) { 0.5 } else { 1.0 });
        frame.stencil_is("ds", |x, _| if tested(x) { 4 } else { 3 });
    }
    Ok(())
}

/// Each half writes its own depth, and both are tested against a half.
fn promise(
    s: &CheckedBackend,
    shader: &str,
    (early, z, written): (&str, f64, [f64; 2]),
) -> CheckEnd {
    let counts = shader.starts_with("counted");
    let (kinds, names) = if counts {
        (json!({ "n": "shader-runs" }), json!(["n"]))
    } else {
        (json!({}), json!([]))
    };
    let values = written.map(|depth| [depth, 0.0, 0.0, 1.0]);
    let draw = json!({
        "mesh": { "kind": "columns", "values": values, "z": [z] }, "shader": shader, "params": red(),
        "early_tests": early, "counters": names, "depth": test("less", true) });
    let frame = counted(s, kinds, vec![draw])?;
    let passes = |x: u32| written[x as usize / 8] < 0.5;
    if shader != "frag_coord_depth" {
        check_painted(&frame, |x, _| passes(x));
    }
    frame.depth_is("depth", |x, _| written[x as usize / 8].min(0.5));
    assert_eq!(frame.counters, vec![256; usize::from(counts)], "{early}");
    Ok(())
}

/// The condition, the fragment's own depth, and written depths that keep the promise.
const PROMISES: [(&str, f64, [f64; 2]); 10] = [
    ("implicit", 0.25, [0.25, 0.75]),
    ("greater-equal", 0.25, [0.25, 0.75]),
    ("greater-equal", 0.125, [0.375, 0.625]),
    ("less-equal", 0.75, [0.25, 0.75]),
    ("less-equal", 0.75, [0.375, 0.125]),
    ("less-equal", 0.375, [0.375, 0.375]),
    ("greater-equal", 0.25, [0.5, 0.25]),
    ("less-equal", 0.25, [0.125, 0.125]),
    ("unchanged", 0.25, [0.25, 0.25]),
    ("unchanged", 0.75, [0.75, 0.75]),
];

pub(crate) fn kept_promises_change_nothing(s: &CheckedBackend) -> CheckEnd {
    for case in PROMISES {
        promise(s, "flat_color_depth", case)?;
    }
    promise(s, "frag_coord_depth", PROMISES[8])?;
    promise(s, "frag_coord_depth", PROMISES[9])
}

pub(crate) fn kept_promises_of_shaders_that_count_change_nothing(s: &CheckedBackend) -> CheckEnd {
    for case in PROMISES {
        promise(s, "counted_depth", case)?;
    }
    Ok(())
}

/// There is no depth attachment, or the test passes only against the cleared depth.
pub(crate) fn promises_need_no_depth_attachment(s: &CheckedBackend) -> CheckEnd {
    for early in ["greater-equal", "less-equal", "unchanged"] {
        let frame = s.show(json!({
            "attachments": { "alone": { "format": "rgba8unorm", "size": [4, 4] } },
            "draws": [{ "mesh": { "kind": "full", "z": 0.25, "value": 1 },
                        "shader": "frag_coord_depth", "early_tests": early }],
        }))?;
        frame.color_is("alone", |_, _| [255; 4]);
    }
    Ok(())
}
