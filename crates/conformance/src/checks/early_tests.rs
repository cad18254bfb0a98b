//! Tests before the shader, and promises about the depth that it writes.

use super::Checked;
use super::counters::{PARAMS, check_painted, counted};
use crate::frames::{BLUE, RED, check, color, depth, stencil};
use crate::scenes::scene_of;
use crate::subject::Subject;

/// Columns from the tenth on are discarded; tests before the shader have by then stored their depth.
fn discards(s: &Subject, shader: &str, kinds: &str, names: &str) -> Checked {
    for (early, behind) in [("implicit", 0.5_f32), ("forced", 0.25)] {
        let draws = [format!(
            r#"{{ "mesh": {{ "kind": "full", "z": 0.25 }}, "shader": "{shader}", "textures": ["half"],
                "params": {{ "color": 0.5 }}, "early_tests": "{early}", "counters": [{names}],
                "depth": {{ "compare": "less", "write": true }} }}"#
        )];
        let frame = counted(s, kinds, &draws)?;
        check_painted(color(&frame, "color"), |x, _| x < 10);
        check(depth(&frame, "depth"), |x, _| {
            [if x < 10 { 0.25 } else { behind }.to_bits()]
        });
    }
    Ok(())
}

pub(crate) fn discarded_fragments_leave_early_depths_alone(s: &Subject) -> Checked {
    discards(s, "texel_discard", "", "")
}

pub(crate) fn discards_that_count_leave_early_depths_alone(s: &Subject) -> Checked {
    discards(s, "counted_discard", r#""n": "shader-runs""#, r#""n""#)
}

/// Both aspects in one attachment.
pub(crate) fn discarded_fragments_leave_early_stencils_alone(s: &Subject) -> Checked {
    for (tests, early) in [("implicit", false), ("forced", true)] {
        let frame = s.draw(&scene_of(
            r#""color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] },
               "ds": { "format": "depth32float-stencil8", "clear": { "depth": 1, "stencil": 3 } },
               "source": { "format": "rgba8unorm", "texels": { "kind": "columns", "values":
                 [[255, 0, 0, 255], [255, 0, 0, 255], [255, 0, 0, 0], [255, 0, 0, 0]] } }"#,
            &format!(
                r#"{{ "color": ["color"], "depth_stencil": "ds", "draws": [
                    {{ "mesh": {{ "kind": "full", "z": 0.5 }}, "shader": "texel_discard", "textures": ["source"],
                      "params": {{ "color": [0, 0, 0, 0.5] }}, "early_tests": "{tests}",
                      "depth": {{ "compare": "less", "write": true }},
                      "stencil": {{ "front": {{ "compare": "always", "pass_op": "increment-wrap" }} }} }} ] }}"#
            ),
            &["color", "ds"],
        ))?;
        check(
            color(&frame, "color"),
            |x, _| if x < 2 { RED } else { BLUE },
        );
        let tested = |x: u32| x < 2 || early;
        check(depth(&frame, "ds"), |x, _| {
            [if tested(x) { 0.5_f32 } else { 1.0 }.to_bits()]
        });
        check(stencil(&frame, "ds"), |x, _| {
            [if tested(x) { 4 } else { 3 }]
        });
    }
    Ok(())
}

/// Each half writes a depth of its own, against a half.
fn promise(s: &Subject, shader: &str, (early, z, written): (&str, f32, [f32; 2])) -> Checked {
    let (kinds, names) = match shader.starts_with("counted") {
        true => (r#""n": "shader-runs""#, r#""n""#),
        false => ("", ""),
    };
    let values = written.map(|depth| [depth, 0.0, 0.0, 1.0]);
    let draws = [format!(
        r#"{{ "mesh": {{ "kind": "columns", "values": {values:?}, "z": [{z}] }}, "shader": "{shader}", {PARAMS},
            "early_tests": "{early}", "counters": [{names}], "depth": {{ "compare": "less", "write": true }} }}"#
    )];
    let frame = counted(s, kinds, &draws)?;
    let passes = |x: u32| written[x as usize / 8] < 0.5;
    if shader != "frag_coord_depth" {
        check_painted(color(&frame, "color"), |x, _| passes(x));
    }
    check(depth(&frame, "depth"), |x, _| {
        let depth = written[x as usize / 8];
        [if passes(x) { depth } else { 0.5 }.to_bits()]
    });
    assert_eq!(
        frame.counters,
        vec![256; usize::from(!names.is_empty())],
        "{early}"
    );
    Ok(())
}

/// Depths below and above the fragment's own, and the same.
const PROMISES: [(&str, f32, [f32; 2]); 10] = [
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

pub(crate) fn kept_promises_change_nothing(s: &Subject) -> Checked {
    for case in PROMISES {
        promise(s, "flat_color_depth", case)?;
    }
    for case in [PROMISES[8], PROMISES[9]] {
        promise(s, "frag_coord_depth", case)?;
    }
    Ok(())
}

pub(crate) fn kept_promises_of_shaders_that_count_change_nothing(s: &Subject) -> Checked {
    for case in PROMISES {
        promise(s, "counted_depth", case)?;
    }
    Ok(())
}

/// There is no depth to make a promise about, or none that the test lets through but the clear's.
pub(crate) fn promises_need_no_depth_attachment(s: &Subject) -> Checked {
    for early in ["greater-equal", "less-equal", "unchanged"] {
        let frame = s.draw(&scene_of(
            r#""alone": { "format": "rgba8unorm", "size": [4, 4] }"#,
            &format!(
                r#"{{ "color": ["alone"], "draws": [ {{ "mesh": {{ "kind": "full", "z": 0.25, "value": 1 }},
                    "shader": "frag_coord_depth", "early_tests": "{early}" }} ] }}"#
            ),
            &["alone"],
        ))?;
        check(color(&frame, "alone"), |_, _| [255; 4]);
    }
    Ok(())
}
