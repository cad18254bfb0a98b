//! Small scenes whose outcome no rounding touches, on a real driver.

use crate::common::{BLACK, GREEN, RED, backend, check, draw, image, scene};
use etalon_backend::Backend;
use etalon_frame::{Aspect, ChannelEncoding, TextureFormat};

#[test]
fn a_rectangle_in_the_top_left_corner_stays_there() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": { "color": { "format": "rgba8unorm", "size": [16, 8], "clear": [0, 0, 0, 0] } },
             "passes": [ { "color": ["color"], "draws": [
                { "mesh": { "kind": "rect", "texels": [0, 0, 5, 3] }, "shader": "uniform_color",
                  "params": { "color": [1, 0, 0, 1] } } ] } ],
             "read": ["color"] }"#,
    );
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |x, y| {
        if x < 5 && y < 3 { RED } else { BLACK }.to_vec()
    });
}

#[test]
fn columns_run_from_left_to_right_and_rows_from_top_to_bottom() {
    let backend = backend(false);
    for (kind, horizontal) in [("columns", true), ("rows", false)] {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "size": [9, 12], "clear": [0, 0, 0, 0] }} }},
                 "passes": [ {{ "color": ["color"], "draws": [
                    {{ "mesh": {{ "kind": "{kind}", "values": [[1,0,0,1], [0,1,0,1], [0,0,0,0]] }},
                      "shader": "flat_color" }} ] }} ],
                 "read": ["color"] }}"#
        ));
        let frame = draw(&backend, &scene);
        check(image(&frame, "color", Aspect::Color), |x, y| {
            let part = if horizontal { x / 3 } else { y / 4 };
            [RED, GREEN, BLACK][part as usize].to_vec()
        });
    }
}

#[test]
fn a_pass_without_draws_leaves_the_clear_values() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": {
                "color": { "format": "rgba8unorm", "clear": [0, 1, 0, 1] },
                "ds": { "format": "depth24plus-stencil8", "clear": { "depth": 1, "stencil": 171 } },
                "idle": { "format": "rgba8unorm", "clear": [1, 0, 0, 1] },
                "stencil": { "format": "stencil8", "clear": 7 } },
             "passes": [ { "color": ["color"], "depth_stencil": "ds", "draws": [] } ],
             "read": ["idle", "ds", "color", "stencil"] }"#,
    );
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |_, _| GREEN.to_vec());
    check(image(&frame, "idle", Aspect::Color), |_, _| RED.to_vec());
    let depth = image(&frame, "ds", Aspect::Depth);
    let one = code_of_one(depth.channels[0]);
    check(depth, |_, _| vec![one]);
    check(image(&frame, "ds", Aspect::Stencil), |_, _| vec![171]);
    check(image(&frame, "stencil", Aspect::Stencil), |_, _| vec![7]);
}

fn code_of_one(encoding: ChannelEncoding) -> u32 {
    match encoding {
        ChannelEncoding::Float32 => 1.0_f32.to_bits(),
        unorm => unorm.max_order() as u32,
    }
}

/// Columns of written depth: 0 and 1 in every format, 1/4 and 1/2 where they are exact.
#[test]
fn written_depth_is_stored_and_compared() {
    let backend = backend(false);
    let formats = [
        TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float,
        TextureFormat::Depth32FloatStencil8,
    ];
    for format in formats {
        assert!(backend.limits().formats.contains_key(&format), "{format}");
        let clear = if format.has_stencil() {
            r#"{ "depth": 1, "stencil": 0 }"#
        } else {
            "1"
        };
        let scene = scene(&format!(
            r#"{{ "attachments": {{
                    "color": {{ "format": "rgba8unorm", "clear": [0, 0, 0, 0] }},
                    "depth": {{ "format": "{format}", "clear": {clear} }} }},
                 "passes": [ {{ "color": ["color"], "depth_stencil": "depth", "draws": [
                    {{ "mesh": {{ "kind": "columns", "values": [0, 1, 0.25, 0.5] }},
                       "shader": "flat_color_depth", "params": {{ "color": [1, 0, 0, 1] }},
                       "depth": {{ "compare": "less", "write": true }} }} ] }} ],
                 "read": ["color", "depth"] }}"#
        ));
        let frame = draw(&backend, &scene);
        // 1 is not less than 1: the second column keeps colour and depth.
        check(image(&frame, "color", Aspect::Color), |x, _| {
            if x / 4 == 1 { BLACK } else { RED }.to_vec()
        });
        let depth = image(&frame, "depth", Aspect::Depth);
        let encoding = depth.channels[0];
        assert_eq!(backend.limits().formats[&format].depth, [encoding]);
        assert_eq!(depth.sample(0, 0, 0), [0], "{format}");
        assert_eq!(depth.sample(4, 0, 0), [code_of_one(encoding)], "{format}");
        if encoding == ChannelEncoding::Float32 {
            assert_eq!(depth.sample(8, 15, 0), [0.25_f32.to_bits()]);
            assert_eq!(depth.sample(12, 15, 0), [0.5_f32.to_bits()]);
        }
    }
}

#[test]
fn a_draw_without_a_depth_test_neither_tests_nor_writes() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": { "color": { "format": "rgba8unorm" }, "depth": { "format": "depth32float", "clear": 0 } },
             "passes": [ { "color": ["color"], "depth_stencil": "depth", "draws": [
                { "mesh": { "kind": "full", "value": 1 }, "shader": "flat_color_depth",
                  "params": { "color": [1, 0, 0, 1] } } ] } ],
             "read": ["color", "depth"] }"#,
    );
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |_, _| RED.to_vec());
    check(image(&frame, "depth", Aspect::Depth), |_, _| vec![0]);
}

/// The left half is front faces, the right half back faces; each face has its own everything.
#[test]
fn front_and_back_faces_have_their_own_stencil_state() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": {
                "color": { "format": "rgba8unorm", "clear": [0, 0, 0, 0] },
                "ds": { "format": "depth24plus-stencil8", "clear": { "depth": 0, "stencil": 240 } } },
             "passes": [ { "color": ["color"], "depth_stencil": "ds", "draws": [
                { "mesh": { "kind": "columns", "values": [0, 0], "windings": ["ccw", "cw"] },
                  "shader": "uniform_color", "params": { "color": [1, 0, 0, 1] },
                  "stencil": {
                    "front": { "compare": "equal", "pass_op": "replace", "fail_op": "zero",
                               "read_mask": 15, "write_mask": 63, "reference": 32 },
                    "back": { "compare": "equal", "pass_op": "zero", "fail_op": "increment-wrap",
                              "read_mask": 255, "write_mask": 3, "reference": 1 } } } ] } ],
             "read": ["color", "ds"] }"#,
    );
    let frame = draw(&backend, &scene);
    // Front: 32 & 15 equals 240 & 15, so 32 is written through 63: 240 & !63 | 32 & 63 = 224.
    // Back: 1 is not 240, so 241 is written through 3: 240 | 1 = 241.
    let left = |x| x < 8;
    check(image(&frame, "ds", Aspect::Stencil), |x, _| {
        vec![if left(x) { 224 } else { 241 }]
    });
    check(image(&frame, "color", Aspect::Color), |x, _| {
        if left(x) { RED } else { BLACK }.to_vec()
    });
}

#[test]
fn stencil_operations_follow_the_depth_test() {
    let backend = backend(false);
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "ds": {{ "format": "{format}", "clear": {{ "depth": 0, "stencil": 5 }} }} }},
                 "passes": [ {{ "depth_stencil": "ds", "draws": [
                    {{ "mesh": {{ "kind": "columns", "values": [0, 1] }}, "shader": "flat_color_depth",
                       "depth": {{ "compare": "less-equal", "write": false }},
                       "stencil": {{ "front": {{ "compare": "always", "pass_op": "invert",
                                                "depth_fail_op": "decrement-clamp" }} }} }} ] }} ],
                 "read": ["ds"] }}"#
        ));
        let frame = draw(&backend, &scene);
        check(image(&frame, "ds", Aspect::Stencil), |x, _| {
            vec![if x < 8 { 250 } else { 4 }]
        });
        check(image(&frame, "ds", Aspect::Depth), |_, _| vec![0]);
    }
}

/// Which of a ccw left half and a cw right half are seen, and as which face.
#[test]
fn faces_and_culling_are_as_seen_with_y_up() {
    let backend = backend(false);
    let front = RED.to_vec();
    let back = GREEN.to_vec();
    let none = BLACK.to_vec();
    for (face, cull, left, right) in [
        ("ccw", "none", &front, &back),
        ("cw", "none", &back, &front),
        ("ccw", "back", &front, &none),
        ("ccw", "front", &none, &back),
        ("cw", "back", &none, &front),
        ("cw", "front", &back, &none),
        ("ccw", "front-and-back", &none, &none),
    ] {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "clear": [0, 0, 0, 0] }} }},
                 "passes": [ {{ "color": ["color"], "draws": [
                    {{ "mesh": {{ "kind": "columns", "values": [0, 0], "windings": ["ccw", "cw"] }},
                       "shader": "front_facing", "cull": "{cull}", "front_face": "{face}",
                       "params": {{ "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] }} }} ] }} ],
                 "read": ["color"] }}"#
        ));
        let frame = draw(&backend, &scene);
        check(image(&frame, "color", Aspect::Color), |x, _| {
            if x < 8 { left } else { right }.clone()
        });
    }
}

#[test]
fn strips_keep_their_winding() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": { "color": { "format": "rgba8unorm", "clear": [0, 0, 0, 0] } },
             "passes": [ { "color": ["color"], "draws": [
                { "mesh": { "kind": "vertices", "positions": [[-1, 1, 0], [-1, -1, 0], [1, 1, 0], [1, -1, 0]] },
                  "topology": "triangle-strip", "shader": "front_facing",
                  "params": { "color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1] } } ] } ],
             "read": ["color"] }"#,
    );
    let frame = draw(&backend, &scene);
    check(image(&frame, "color", Aspect::Color), |_, _| RED.to_vec());
}

#[test]
fn uploads_are_fetched_texel_by_texel() {
    let backend = backend(false);
    let scene = scene(
        r#"{ "attachments": {
                "color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 0, 0] },
                "float": { "format": "rgba32float", "texels": { "kind": "rows",
                    "values": [[0, 0, 1, 1], [1, 0, 0, 1], [0, 1, 0, 1], [7, -3, 0, 0]] } },
                "unorm": { "format": "rgba8unorm", "texels": { "kind": "columns",
                    "values": [[1, 2, 3, 4], [5, 6, 7, 8], [250, 251, 252, 253], [0, 255, 0, 255]] } } },
             "passes": [ { "color": ["color"], "draws": [
                { "mesh": { "kind": "full" }, "shader": "texel_color", "textures": ["unorm"] },
                { "mesh": { "kind": "rect", "texels": [0, 1, 2, 4] }, "shader": "texel_color", "textures": ["float"] } ] } ],
             "read": ["color", "float", "unorm"] }"#,
    );
    let frame = draw(&backend, &scene);
    let unorm = [
        [1, 2, 3, 4],
        [5, 6, 7, 8],
        [250, 251, 252, 253],
        [0, 255, 0, 255],
    ];
    let float = [
        [0.0, 0.0, 1.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [7.0_f32, -3.0, 0.0, 0.0],
    ];
    check(image(&frame, "color", Aspect::Color), |x, y| {
        if x < 2 && y > 0 {
            let clamp = |v: f32| if v >= 1.0 { 255 } else { 0 };
            float[y as usize].map(clamp).to_vec()
        } else {
            unorm[x as usize].to_vec()
        }
    });
    check(image(&frame, "unorm", Aspect::Color), |x, _| {
        unorm[x as usize].to_vec()
    });
    check(image(&frame, "float", Aspect::Color), |_, y| {
        float[y as usize].map(f32::to_bits).to_vec()
    });
}

#[test]
fn blending_weighs_source_and_destination() {
    let backend = backend(false);
    let factor = |src: &str, dst: &str| {
        format!(r#"{{ "operation": "add", "src_factor": "{src}", "dst_factor": "{dst}" }}"#)
    };
    for (src, dst, alpha_dst, due) in [
        // Blue at 0.6 over opaque red.
        (
            "src-alpha",
            "one-minus-src-alpha",
            "one-minus-src-alpha",
            [102, 0, 153, 194],
        ),
        // The constant 0.2, 0.4, 0.6, 1.
        ("constant", "zero", "one", [0, 0, 153, 255]),
        ("zero", "constant", "zero", [51, 0, 0, 92]),
    ] {
        let color = factor(src, dst);
        let alpha = factor("src-alpha", alpha_dst);
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "clear": [1, 0, 0, 1] }} }},
                 "passes": [ {{ "color": ["color"], "draws": [
                    {{ "mesh": {{ "kind": "full" }}, "shader": "uniform_color",
                       "params": {{ "color": [0, 0, 1, 0.6] }}, "blend_constant": [0.2, 0.4, 0.6, 1],
                       "blend": {{ "color": {color}, "alpha": {alpha} }} }} ] }} ],
                 "read": ["color"] }}"#
        ));
        let frame = draw(&backend, &scene);
        let image = image(&frame, "color", Aspect::Color);
        let first = image.sample(0, 0, 0);
        for (code, due) in first.iter().zip(due) {
            assert!(code.abs_diff(due) <= 1, "{src}, {dst}: {first:?}");
        }
        check(image, |_, _| first.to_vec());
    }
}

#[test]
fn write_masks_keep_the_other_channels() {
    let backend = backend(false);
    for (mask, due) in [
        ("", [255, 0, 255, 0]),
        ("r", [0, 0, 255, 0]),
        ("ga", [255, 255, 255, 255]),
        ("rgba", [0, 255, 0, 255]),
    ] {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "clear": [1, 0, 1, 0] }} }},
                 "passes": [ {{ "color": ["color"], "draws": [
                    {{ "mesh": {{ "kind": "full" }}, "shader": "uniform_color", "write_mask": "{mask}",
                       "params": {{ "color": [0, 1, 0, 1] }} }} ] }} ],
                 "read": ["color"] }}"#
        ));
        let frame = draw(&backend, &scene);
        check(image(&frame, "color", Aspect::Color), |_, _| due.to_vec());
    }
}

/// Every sample of a multisampled attachment comes back, and each is drawn by itself.
#[test]
fn samples_are_drawn_and_read_one_by_one() {
    let backend = backend(true);
    let limits = backend.limits();
    let both = |count: &&u32| {
        [
            TextureFormat::Rgba8Unorm,
            TextureFormat::Depth32FloatStencil8,
        ]
        .iter()
        .all(|f| limits.formats[f].samples.contains(count))
    };
    let counts: Vec<u32> = limits.sample_positions.keys().copied().collect();
    for count in counts.iter().filter(both).filter(|c| **c > 1) {
        // A slanted edge through the middle, from (8, 0) to (9, 16) in texels: the right side is drawn.
        let scene = scene(&format!(
            r#"{{ "attachments": {{
                    "color": {{ "format": "rgba8unorm", "samples": {count}, "clear": [0, 0, 0, 0] }},
                    "ds": {{ "format": "depth32float-stencil8", "samples": {count}, "clear": {{ "depth": 1, "stencil": 3 }} }} }},
                 "passes": [ {{ "color": ["color"], "depth_stencil": "ds", "draws": [
                    {{ "mesh": {{ "kind": "vertices", "values": [0.25],
                                  "positions": [[-0.125, 3, 0], [0.25, -3, 0], [6.5, 0, 0]] }},
                       "shader": "flat_color_depth", "params": {{ "color": [1, 0, 0, 1] }},
                       "depth": {{ "compare": "less", "write": true }},
                       "stencil": {{ "front": {{ "compare": "always", "pass_op": "increment-clamp" }} }} }} ] }} ],
                 "read": ["color", "ds"] }}"#
        ));
        let frame = draw(&backend, &scene);
        let color = image(&frame, "color", Aspect::Color);
        assert_eq!(color.samples, *count);
        let mut partly = 0;
        for y in 0..16 {
            for x in 0..16 {
                let mut inside_texel = 0;
                for (sample, position) in (0..).zip(&limits.sample_positions[count]) {
                    let at = |p: u16, origin: u32| f64::from(origin) + f64::from(p) / 256.0;
                    let (sx, sy) = (at(position[0], x), at(position[1], y));
                    let distance = sx - (8.0 + sy / 16.0);
                    let inside = color.sample(x, y, sample) == RED;
                    inside_texel += u32::from(inside);
                    // Nearer samples may fall to either side: vertices are snapped.
                    if distance.abs() > 0.1 {
                        assert_eq!(inside, distance > 0.0, "({x}, {y}) sample {sample}");
                    }
                    let due = if inside { (0.25_f32, 4) } else { (1.0, 3) };
                    let depth = image(&frame, "ds", Aspect::Depth).sample(x, y, sample);
                    assert_eq!(depth, [due.0.to_bits()]);
                    let stencil = image(&frame, "ds", Aspect::Stencil).sample(x, y, sample);
                    assert_eq!(stencil, [due.1]);
                }
                partly += u32::from(inside_texel > 0 && inside_texel < *count);
            }
        }
        assert!(
            partly > 0,
            "no texel is partly covered with {count} samples"
        );
    }
    assert_eq!(backend.messages(), Vec::<String>::new());
}
