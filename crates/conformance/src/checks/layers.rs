//! Layers taken apart and put together: depth peeling from one end and from both, weighted sums,
//! samples discarded by thresholds.

use super::Checked;
use crate::frames::{GREEN, NONE, RED, check, check_near, color, values};
use crate::scenes::scene_of;
use crate::subject::Subject;

/// Three layers in the wrong order, each covering less than the one behind it.
const LAYERS: [(&str, [u32; 4], f32); 3] = [
    ("[0, 0, 1, 0.25]", [0, 0, 8, 4], 0.75),
    ("[1, 0, 0, 0.5]", [0, 0, 4, 4], 0.25),
    ("[0, 1, 0, 1]", [0, 0, 8, 2], 0.5),
];

/// All layers in one pass.
fn layers(shader: &str, more: &str) -> String {
    let draw = |(value, texels, z): &(&str, [u32; 4], f32)| {
        format!(
            r#"{{ "mesh": {{ "kind": "rect", "texels": {texels:?}, "z": {z}, "value": {value} }},
                "shader": "{shader}" {more} }}"#
        )
    };
    LAYERS.iter().map(draw).collect::<Vec<_>>().join(",")
}

/// The last pass has no use for the depth that the shader gives.
pub(crate) fn layers_are_peeled_one_by_one(s: &Subject) -> Checked {
    let float = |name: &str, clear: u32| {
        format!(
            r#""{name}": {{ "format": "rgba32float", "size": [8, 4], "clear": [{clear}, 0, 0, 1] }}"#
        )
    };
    let rest = ["first", "second", "third"].map(|name| {
        format!(
            r#""{name}": {{ "format": "rgba8unorm", "size": [8, 4] }},
               "z-{name}": {{ "format": "depth32float", "size": [8, 4], "clear": 1 }}"#
        )
    });
    let pass = |name: &str, depth: &str, before: &str| {
        let more = format!(
            r#", "textures": ["{before}"], "depth": {{ "compare": "less", "write": true }}"#
        );
        format!(
            r#"{{ "color": ["{name}" {depth}], "depth_stencil": "z-{name}", "draws": [ {} ] }}"#,
            layers("peel", &more)
        )
    };
    let scene = scene_of(
        &[
            float("none", 0),
            float("after-first", 1),
            float("after-second", 1),
            rest.join(","),
        ]
        .join(","),
        &[
            pass("first", r#", "after-first""#, "none"),
            pass("second", r#", "after-second""#, "after-first"),
            pass("third", "", "after-second"),
        ]
        .join(","),
        &["after-second", "first", "second", "third"],
    );
    let frame = s.draw(&scene)?;
    let [red, green, blue] = [[255, 0, 0, 128], GREEN, [0, 0, 255, 64]];
    for (at, name) in ["first", "second", "third"].into_iter().enumerate() {
        check(color(&frame, name), |x, y| {
            let peeled: &[[u32; 4]] = match (x, y) {
                (0..4, 0..2) => &[red, green, blue],
                (0..4, _) => &[red, blue],
                (_, 0..2) => &[green, blue],
                _ => &[blue],
            };
            *peeled.get(at).unwrap_or(&NONE)
        });
    }
    check_near(
        &values(color(&frame, "after-second"), 0, 0),
        &[0.5, 0.0, 0.0, 1.0],
        1e-6,
    );
    check_near(
        &values(color(&frame, "after-second"), 7, 1),
        &[0.75, 0.0, 0.0, 1.0],
        1e-6,
    );
    check_near(
        &values(color(&frame, "after-second"), 7, 3),
        &[1.0, 0.0, 0.0, 1.0],
        0.0,
    );
    Ok(())
}

/// The nearest and the farthest layer go in the same pass, by maxima of 32-bit floats.
pub(crate) fn layers_are_peeled_from_both_ends(s: &Subject) -> Checked {
    let max = r#"{ "operation": "max", "src_factor": "one", "dst_factor": "one" }"#;
    let blend = format!(r#", "blend": {{ "color": {max}, "alpha": {max} }}"#);
    let float = |name: &str, format: &str, clear: &str| {
        format!(r#""{name}": {{ "format": "{format}", "size": [8, 4], "clear": {clear} }}"#)
    };
    let scene = scene_of(
        &[
            float("range", "rgba32float", "[-1, 0, 0, 0]"),
            float("next", "rgba32float", "[-1, -1, 0, 0]"),
            float("none", "rgba16float", "[0, 0, 0, 0]"),
            float("front", "rgba16float", "[0, 0, 0, 0]"),
            float("back", "rgba16float", "[0, 0, 0, 0]"),
        ]
        .join(","),
        &format!(
            r#"{{ "color": ["range"], "draws": [ {} ] }},
               {{ "color": ["next", "front", "back"], "draws": [ {} ] }}"#,
            layers("depth_range", &blend),
            layers(
                "dual_peel",
                &format!(r#"{blend}, "textures": ["range", "none"]"#)
            ),
        ),
        &["back", "front", "next", "range"],
    );
    let frame = s.draw(&scene)?;
    let check =
        |name: &str, due: [f64; 4]| check_near(&values(color(&frame, name), 1, 1), &due, 1e-6);
    check("range", [-0.25, 0.75, 0.0, 1.0]);
    check("next", [-0.5, 0.5, 0.0, 1.0]);
    check("front", [0.5, 0.0, 0.0, 0.5]);
    check("back", [0.0, 0.0, 1.0, 0.25]);
    // Where there is but one layer, it is the nearest.
    check_near(
        &values(color(&frame, "front"), 7, 3),
        &[0.0, 0.0, 0.25, 0.25],
        1e-6,
    );
    check_near(&values(color(&frame, "back"), 7, 3), &[0.0; 4], 0.0);
    Ok(())
}

/// Sums and products beside each other, and what both make of the background.
pub(crate) fn weighted_layers_are_summed_and_shown(s: &Subject) -> Checked {
    let component = |src: &str, dst: &str| {
        format!(r#"{{ "operation": "add", "src_factor": "{src}", "dst_factor": "{dst}" }}"#)
    };
    let blend = |src: &str, dst: &str| {
        let both = component(src, dst);
        format!(r#""blend": {{ "color": {both}, "alpha": {both} }}"#)
    };
    let (sum, left) = (blend("one", "one"), blend("zero", "one-minus-src"));
    let layer = |texels: [u32; 4], color: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "rect", "texels": {texels:?}, "z": 0.5, "value": {color} }},
                "shader": "weighted_accumulate", "targets": [ {{ {sum} }}, {{ {left} }} ] }}"#
        )
    };
    let scene = scene_of(
        r#""sum": { "format": "rgba16float", "size": [4, 4], "clear": [0, 0, 0, 0] },
           "left": { "format": "r8unorm", "size": [4, 4], "clear": [1, 0, 0, 0] },
           "shown": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1] }"#,
        &format!(
            r#"{{ "color": ["sum", "left"], "draws": [ {}, {} ] }},
               {{ "color": ["shown"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                  "shader": "weighted_resolve", "textures": ["sum", "left"], {} }} ] }}"#,
            layer([0, 0, 4, 4], "[1, 0, 0, 0.5]"),
            layer([0, 0, 2, 3], "[0, 1, 0, 0.5]"),
            blend("one-minus-src-alpha", "src-alpha"),
        ),
        &["left", "shown", "sum"],
    );
    let frame = s.draw(&scene)?;
    for (x, y) in (0..4).flat_map(|y| (0..4).map(move |x| (x, y))) {
        let both = x < 2 && y < 3;
        let green = if both { 93.75 } else { 0.0 };
        check_near(
            &values(color(&frame, "sum"), x, y),
            &[93.75, green, 0.0, 93.75 + green],
            0.2,
        );
        let left = if both { 0.25 } else { 0.5 };
        check_near(&values(color(&frame, "left"), x, y), &[left], 1.01 / 255.0);
        let shown = if both {
            [0.375, 0.375, 0.25]
        } else {
            [0.5, 0.0, 0.5]
        };
        check_near(
            &values(color(&frame, "shown"), x, y)[..3],
            &shown,
            3.0 / 255.0,
        );
    }
    Ok(())
}

/// A threshold for each of four samples, in a texture that an earlier pass drew.
pub(crate) fn samples_are_discarded_by_thresholds(s: &Subject) -> Checked {
    let scene = scene_of(
        r#""color": { "format": "rgba8unorm", "size": [4, 4], "samples": 4, "clear": [0, 0, 0, 0] },
           "thresholds": { "format": "rgba8unorm", "size": [4, 4] }"#,
        r#"{ "color": ["thresholds"], "draws": [ { "mesh": { "kind": "full" }, "shader": "uniform_color",
             "params": { "color": [0.875, 0.25, 0.625, 0.125] } } ] },
           { "color": ["color"], "draws": [ { "mesh": { "kind": "cover", "value": [1, 0, 0, 0.5] },
             "shader": "stochastic", "textures": ["thresholds"] } ] }"#,
        &["color"],
    );
    let frame = s.draw(&scene)?;
    let color = color(&frame, "color");
    for texel in color.codes.chunks(16) {
        assert_eq!(texel, [NONE, RED, NONE, RED].concat());
    }
    Ok(())
}
