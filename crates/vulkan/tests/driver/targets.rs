//! Colour attachments: logic operations, two sources, several attachments; tests without writing.

use crate::common::{BLACK, GREEN, RED, backend, check, draw, draw_if_there, image, scene_of};
use etalon_frame::{Aspect, TextureFormat};
use etalon_scene::LogicOperation;

/// An attachment's JSON whose rows all hold the same texel.
fn uploaded(name: &str, texel: [u32; 4]) -> String {
    format!(
        r#""{name}": {{ "format": "rgba8unorm", "texels": {{ "kind": "rows", "values": {:?} }} }}"#,
        [texel; 16]
    )
}

/// Source 0x33 and destination 0x55 show the truth table of an operation in each nibble.
#[test]
fn logic_operations_follow_their_truth_tables() {
    let backend = backend(true);
    let table = [
        ("clear", 0x00),
        ("and", 0x11),
        ("and-reverse", 0x22),
        ("copy", 0x33),
        ("and-inverted", 0x44),
        ("noop", 0x55),
        ("xor", 0x66),
        ("or", 0x77),
        ("nor", 0x88),
        ("equivalent", 0x99),
        ("invert", 0xaa),
        ("or-reverse", 0xbb),
        ("copy-inverted", 0xcc),
        ("or-inverted", 0xdd),
        ("nand", 0xee),
        ("set", 0xff),
    ];
    assert_eq!(table.len(), LogicOperation::ALL.len());
    for (name, due) in table {
        let scene = scene_of(
            &[
                uploaded("color", [0x55, 0x55, 0xaa, 0x55]),
                uploaded("source", [0x33, 0x33, 0xcc, 0x33]),
            ]
            .join(","),
            &format!(
                r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }}, "shader": "texel_color",
                    "textures": ["source"], "logic": "{name}", "write_mask": "rba" }} ] }}"#
            ),
            &["color"],
        );
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        // Of 0xcc and 0xaa the table stands the other way round, from the highest bit.
        let turned = u32::from((due as u8).reverse_bits());
        check(image(&frame, "color", Aspect::Color), |_, _| {
            vec![due, 0x55, turned, due]
        });
    }
}

/// The second source, 0 or 1 in each channel, chooses between source and destination.
#[test]
fn the_second_source_is_a_factor() {
    let backend = backend(true);
    for (factor, due) in [
        ("src1", [11, 102, 33, 44]),
        ("src1-alpha", [11, 22, 33, 44]),
        ("one-minus-src1", [101, 22, 103, 104]),
        ("one-minus-src1-alpha", [101, 102, 103, 104]),
    ] {
        let other = match factor.strip_prefix("one-minus-") {
            Some(plain) => plain.to_owned(),
            None => format!("one-minus-{factor}"),
        };
        let both = format!(
            r#"{{ "operation": "add", "src_factor": "{factor}", "dst_factor": "{other}" }}"#
        );
        let scene = scene_of(
            &[
                uploaded("color", [101, 102, 103, 104]),
                uploaded("first", [11, 22, 33, 44]),
                uploaded("second", [255, 0, 255, 255]),
            ]
            .join(","),
            &format!(
                r#"{{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                    "shader": "texel_dual_source", "textures": ["first", "second"],
                    "blend": {{ "color": {both}, "alpha": {both} }} }} ] }}"#
            ),
            &["color"],
        );
        let Some(frame) = draw_if_there(&backend, &scene) else {
            return;
        };
        check(image(&frame, "color", Aspect::Color), |_, _| due.to_vec());
    }
}

#[test]
fn attachments_blend_and_mask_on_their_own() {
    let backend = backend(true);
    let add = r#"{ "operation": "add", "src_factor": "one", "dst_factor": "one" }"#;
    let keep = r#"{ "operation": "reverse-subtract", "src_factor": "zero", "dst_factor": "one" }"#;
    let scene = scene_of(
        &[
            uploaded("a", [100, 1, 2, 3]),
            uploaded("b", [100, 1, 2, 3]),
            uploaded("c", [100, 1, 2, 3]),
            uploaded("d", [100, 1, 2, 3]),
            uploaded("source", [50, 60, 70, 80]),
        ]
        .join(","),
        &format!(
            r#"{{ "color": ["a", "b", "c", "d"], "draws": [ {{ "mesh": {{ "kind": "full" }},
                "shader": "texel_color_all", "textures": ["source"], "targets": [
                    {{}}, {{ "blend": {{ "color": {add}, "alpha": {keep} }} }},
                    {{ "write_mask": "ga" }}, {{ "blend": {{ "color": {keep}, "alpha": {add} }}, "write_mask": "ra" }} ] }} ] }}"#
        ),
        &["a", "b", "c", "d"],
    );
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    for (name, due) in [
        ("a", [50, 60, 70, 80]),
        ("b", [150, 61, 72, 3]),
        ("c", [100, 60, 2, 80]),
        ("d", [100, 1, 2, 83]),
    ] {
        check(image(&frame, name, Aspect::Color), |_, _| due.to_vec());
    }
}

#[test]
fn attachments_of_different_formats_take_one_draw() {
    let backend = backend(true);
    let formats = [
        TextureFormat::Rgba16Float,
        TextureFormat::R8Unorm,
        TextureFormat::Rgba32Float,
        TextureFormat::Rgb10a2Unorm,
    ];
    let names = ["z", "a", "y", "b"];
    let mut attachments = vec![uploaded("source", [255, 0, 255, 255])];
    for (name, format) in names.iter().zip(formats) {
        attachments.push(format!(r#""{name}": {{ "format": "{format}" }}"#));
    }
    let scene = scene_of(
        &attachments.join(","),
        &format!(
            r#"{{ "color": {names:?}, "draws": [ {{ "mesh": {{ "kind": "full" }},
                "shader": "texel_color_all", "textures": ["source"] }} ] }}"#
        ),
        &names,
    );
    let Some(frame) = draw_if_there(&backend, &scene) else {
        return;
    };
    for (name, format) in names.iter().zip(formats) {
        let channels = format.color_channels().iter().zip([1.0, 0.0, 1.0, 1.0]);
        let due: Vec<u32> = channels.map(|(e, v)| e.nearest_code(v)).collect();
        check(image(&frame, name, Aspect::Color), |_, _| due.clone());
    }
}

/// Written, tested without a right to write, and written again.
#[test]
fn a_pass_may_promise_to_write_neither_depth_nor_stencil() {
    let backend = backend(true);
    for format in [
        "depth32float-stencil8",
        "depth24plus-stencil8",
        "depth16unorm",
        "stencil8",
    ] {
        let has_stencil = format.ends_with("stencil8");
        let has_depth = format.starts_with("depth");
        let depth = |json: &str| if has_depth { json } else { "" }.to_owned();
        let stencil = |json: &str| if has_stencil { json } else { "" }.to_owned();
        let write = depth(r#", "depth": { "compare": "always", "write": true }"#)
            + &stencil(
                r#", "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } }"#,
            );
        let test = depth(r#", "depth": { "compare": "equal", "write": false }"#)
            + &stencil(
                r#", "stencil": { "front": { "compare": "equal", "pass_op": "zero" }, "reference": 1, "write_mask": 0 }"#,
            );
        let columns =
            r#""mesh": { "kind": "columns", "values": [0, 1] }, "shader": "flat_color_depth""#;
        let scene = scene_of(
            &format!(r#""color": {{ "format": "rgba8unorm" }}, "ds": {{ "format": "{format}" }}"#),
            &format!(
                r#"{{ "depth_stencil": "ds", "draws": [ {{ {columns} {write} }} ] }},
                   {{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
                        {{ "mesh": {{ "kind": "full", "value": 1 }}, "shader": "flat_color_depth",
                           "params": {{ "color": [1, 0, 0, 1] }} {test} }} ] }},
                   {{ "depth_stencil": "ds", "draws": [
                        {{ "mesh": {{ "kind": "rect", "texels": [0, 0, 16, 8] }}, "shader": "flat_color_depth" {write} }} ] }},
                   {{ "color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
                        {{ "mesh": {{ "kind": "rect", "texels": [0, 8, 4, 16] }}, "shader": "uniform_color",
                           "params": {{ "color": [0, 1, 0, 1] }} }} ] }}"#
            ),
            &["color", "ds"],
        );
        let frame = draw(&backend, &scene);
        check(image(&frame, "color", Aspect::Color), |x, y| {
            match (x, y) {
                (0..4, 8..) => GREEN,
                (8.., _) => RED,
                _ if !has_depth => RED,
                _ => BLACK,
            }
            .to_vec()
        });
        if has_stencil {
            check(image(&frame, "ds", Aspect::Stencil), |_, y| {
                vec![if y < 8 { 2 } else { 1 }]
            });
        }
        if has_depth {
            let depth = image(&frame, "ds", Aspect::Depth);
            let one = depth.channels[0].nearest_code(1.0);
            check(depth, |x, y| vec![if x >= 8 && y >= 8 { one } else { 0 }]);
        }
    }
}
