//! What is drawn, and what must come back.

use crate::harness::{assert_texels, drawn, frame, image, scene, value};
use etalon_backend::{Backend, BackendError};
use etalon_frame::{Api, Aspect, ChannelEncoding, Feature, ReadPath, Requirement, TextureFormat};
use etalon_wgpu::WgpuBackend;

const RED: [u32; 4] = [255, 0, 0, 255];
const GREEN: [u32; 4] = [0, 255, 0, 255];
const BLUE: [u32; 4] = [0, 0, 255, 255];

pub(crate) fn a_rectangle_lands_where_it_belongs(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [16, 8], "clear": [0, 1, 0, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "rect", "texels": [0, 0, 3, 2]}, "shader": "uniform_color",
                  "params": {"color": [1, 0, 0, 1]}}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_eq!(color.read, ReadPath::Copy);
    assert_texels(color, |x, y| if x < 3 && y < 2 { RED } else { GREEN });
}

pub(crate) fn columns_of_flat_colors(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "columns", "values": [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [1, 0, 1, 0]]},
                  "shader": "flat_color"}]} ],
             "read": ["color"] }"#,
    );
    let colors = [RED, GREEN, BLUE, [255, 0, 255, 0]];
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| colors[x as usize / 2]);
}

fn depth_formats(backend: &WgpuBackend) -> Vec<TextureFormat> {
    let formats = backend.limits().formats.keys().copied();
    let formats: Vec<_> = formats.filter(|f| f.has_depth()).collect();
    for due in [
        TextureFormat::Depth16Unorm,
        TextureFormat::Depth24Plus,
        TextureFormat::Depth24PlusStencil8,
        TextureFormat::Depth32Float,
        TextureFormat::Depth32FloatStencil8,
    ] {
        assert!(formats.contains(&due), "{due} is missing");
    }
    formats
}

fn depth_clear(format: TextureFormat, depth: f32) -> String {
    if format.has_stencil() {
        format!(r#"{{"depth": {depth}, "stencil": 93}}"#)
    } else {
        depth.to_string()
    }
}

pub(crate) fn depth_formats_store_what_is_written(backend: &WgpuBackend) {
    for format in depth_formats(backend) {
        let clear = depth_clear(format, 1.0);
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{ "depth": {{"format": "{format}", "size": [8, 4], "clear": {clear}}} }},
                     "passes": [ {{"depth_stencil": "depth", "draws": [
                         {{"mesh": {{"kind": "columns", "values": [0, 1, 0.25, 0.5]}},
                          "shader": "flat_color_depth", "depth": {{"compare": "always", "write": true}}}}]}} ],
                     "read": ["depth"] }}"#
            ),
        );
        let depth = image(&frame, "depth", Aspect::Depth);
        let support = &backend.limits().formats[&format];
        assert_eq!(depth.read, support.read, "{format}");
        match depth.read {
            ReadPath::Copy => assert_eq!(depth.channels, support.depth, "{format}"),
            ReadPath::Shader => assert_eq!(depth.channels, [ChannelEncoding::Float32]),
        }
        for y in 0..4 {
            for x in 0..8 {
                let due = [0.0, 1.0, 0.25, 0.5][x as usize / 2];
                let came = value(depth, x, y);
                let off = (came - due).abs();
                let step = match support.depth[..] {
                    [ChannelEncoding::Float32] => 0.0,
                    _ if due == 0.0 || due == 1.0 => 0.0,
                    [ChannelEncoding::Unorm(16)] => 1.0 / 65535.0,
                    _ => 1.0 / 16_777_215.0,
                };
                assert!(off <= step, "{format}: {came} at {x}, {y} instead of {due}");
            }
        }
        if format.has_stencil() {
            let stencil = image(&frame, "depth", Aspect::Stencil);
            assert_eq!(stencil.read, ReadPath::Copy);
            assert_eq!(stencil.channels, [ChannelEncoding::Uint(8)]);
            assert_texels(stencil, |_, _| [93]);
        }
    }
}

pub(crate) fn depth_test_passes_and_fails(backend: &WgpuBackend) {
    for format in depth_formats(backend) {
        let clear = depth_clear(format, 1.0);
        for (compare, write) in [("less", true), ("greater-equal", false)] {
            let frame = frame(
                backend,
                &format!(
                    r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 4], "clear": [0, 1, 0, 1]}},
                                            "depth": {{"format": "{format}", "clear": {clear}}} }},
                         "passes": [ {{"color": ["color"], "depth_stencil": "depth", "draws": [
                             {{"mesh": {{"kind": "columns", "values": [0, 1]}}, "shader": "flat_color_depth",
                              "params": {{"color": [1, 0, 0, 1]}},
                              "depth": {{"compare": "{compare}", "write": {write}}}}}]}} ],
                         "read": ["depth", "color"] }}"#
                ),
            );
            assert_eq!(
                frame.images[0].aspect,
                Aspect::Depth,
                "in the order of `read`"
            );
            let color = image(&frame, "color", Aspect::Color);
            let passes = |x: u32| (x < 4) == write;
            assert_texels(color, |x, _| if passes(x) { RED } else { GREEN });
            let depth = image(&frame, "depth", Aspect::Depth);
            for x in 0..8 {
                let due = if write && x < 4 { 0.0 } else { 1.0 };
                assert_eq!(value(depth, x, 1), due, "{format} {compare} at {x}");
            }
        }
    }
}

pub(crate) fn depth_starts_from_its_clear(backend: &WgpuBackend) {
    for format in depth_formats(backend) {
        for clear in [0.0, 1.0] {
            let value_of = depth_clear(format, clear);
            let frame = frame(
                backend,
                &format!(
                    r#"{{ "attachments": {{ "depth": {{"format": "{format}", "size": [3, 5], "clear": {value_of}}} }},
                         "passes": [], "read": ["depth"] }}"#
                ),
            );
            let depth = image(&frame, "depth", Aspect::Depth);
            for y in 0..5 {
                assert_eq!(value(depth, 2, y), f64::from(clear), "{format}");
            }
        }
    }
}

pub(crate) fn stencil_differs_between_faces(backend: &WgpuBackend) {
    // Left, front faces: 7 is less than 200, so 200 + 1. Right, back faces: 7 greater than 200
    // fails, so the bits are inverted. Only the low nibble and the top bit may change.
    for format in ["depth24plus-stencil8", "depth32float-stencil8"] {
        for (front_face, swapped) in [("ccw", false), ("cw", true)] {
            let frame = frame(
                backend,
                &format!(
                    r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 8], "clear": [0, 1, 0, 1]}},
                                            "ds": {{"format": "{format}", "clear": {{"depth": 1, "stencil": 200}}}} }},
                         "passes": [ {{"color": ["color"], "depth_stencil": "ds", "draws": [
                             {{"mesh": {{"kind": "columns", "values": [0, 0], "windings": ["ccw", "cw"]}},
                              "shader": "uniform_color", "params": {{"color": [1, 0, 0, 1]}},
                              "front_face": "{front_face}",
                              "stencil": {{"reference": 7, "write_mask": 143,
                                          "front": {{"compare": "less", "pass_op": "increment-wrap"}},
                                          "back": {{"compare": "greater", "fail_op": "invert"}}}}}}]}} ],
                         "read": ["color", "ds"] }}"#
                ),
            );
            assert_eq!(frame.images.len(), 3, "colour, depth, stencil");
            assert_eq!(frame.images[1].aspect, Aspect::Depth);
            let color = image(&frame, "color", Aspect::Color);
            let front = |x: u32| (x < 4) != swapped;
            assert_texels(color, |x, _| if front(x) { RED } else { GREEN });
            let inverted = (200 & !143) | (!200 & 143);
            let stencil = image(&frame, "ds", Aspect::Stencil);
            assert_texels(stencil, |x, _| [if front(x) { 201 } else { inverted }]);
        }
    }
}

pub(crate) fn stencil_without_depth(backend: &WgpuBackend) {
    // Every value from 0 to 255 by eight replacements of one bit each.
    let mut draws = Vec::new();
    for bit in 0..8 {
        for start in (0..256).filter(|v| v % (2 << bit) == 1 << bit) {
            let (x, y, width) = (start % 16, start / 16, 1 << bit);
            let texels = if width < 16 {
                [x, y, x + width, y + 1]
            } else {
                [0, y, 16, y + width / 16]
            };
            draws.push(format!(
                r#"{{"mesh": {{"kind": "rect", "texels": {texels:?}}}, "shader": "uniform_color",
                    "stencil": {{"reference": 255, "write_mask": {},
                                "front": {{"compare": "always", "pass_op": "replace"}}}}}}"#,
                1 << bit
            ));
        }
    }
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "stencil": {{"format": "stencil8", "size": [16, 16], "clear": 0}} }},
                 "passes": [ {{"depth_stencil": "stencil", "draws": [{}]}} ],
                 "read": ["stencil"] }}"#,
            draws.join(",")
        ),
    );
    let stencil = image(&frame, "stencil", Aspect::Stencil);
    assert_texels(stencil, |x, y| [16 * y + x]);
}

pub(crate) fn faces_and_culling(backend: &WgpuBackend) {
    for front_face in ["ccw", "cw"] {
        for cull in ["none", "front", "back"] {
            let frame = frame(
                backend,
                &format!(
                    r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]}} }},
                         "passes": [ {{"color": ["color"], "draws": [
                             {{"mesh": {{"kind": "columns", "values": [0, 0], "windings": ["ccw", "cw"]}},
                              "shader": "front_facing", "cull": "{cull}", "front_face": "{front_face}",
                              "params": {{"color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1]}}}}]}} ],
                         "read": ["color"] }}"#
                ),
            );
            let color = image(&frame, "color", Aspect::Color);
            assert_texels(color, |x, _| {
                let front = (x < 4) == (front_face == "ccw");
                match (front, cull) {
                    (true, "front") | (false, "back") => BLUE,
                    (true, _) => RED,
                    (false, _) => GREEN,
                }
            });
        }
    }
}

pub(crate) fn uploads_keep_their_orientation(backend: &WgpuBackend) {
    for kind in ["columns", "rows"] {
        for (format, codes) in [("rgba8unorm", [10, 20, 30]), ("rgba32float", [0, 1, 1])] {
            let [a, b, c] = codes;
            let frame = frame(
                backend,
                &format!(
                    r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [3, 3]}},
                                            "source": {{"format": "{format}", "texels": {{"kind": "{kind}", "values":
                                                [[{a}, 0, 0, 0], [0, {b}, 0, 0], [0, 0, {c}, 0]]}}}} }},
                         "passes": [ {{"color": ["color"], "draws": [
                             {{"mesh": {{"kind": "full"}}, "shader": "texel_color", "textures": ["source"]}}]}} ],
                         "read": ["color", "source"] }}"#
                ),
            );
            let unit = if format == "rgba8unorm" { 1 } else { 255 };
            let texel = |i: u32| {
                let mut texel = [0; 4];
                texel[i as usize] = codes[i as usize] * unit;
                texel
            };
            let along = |x: u32, y: u32| if kind == "columns" { x } else { y };
            let color = image(&frame, "color", Aspect::Color);
            assert_texels(color, |x, y| texel(along(x, y)));
            let source = image(&frame, "source", Aspect::Color);
            if format == "rgba8unorm" {
                assert_texels(source, |x, y| texel(along(x, y)));
            } else {
                let one = 1_f32.to_bits();
                assert_texels(source, |x, y| texel(along(x, y)).map(|c| one * (c / 255)));
            }
        }
    }
}

/// Draws over a colour and gives the texel that comes of it.
fn blended(backend: &WgpuBackend, clear: &str, color: &str, state: &str) -> [u32; 4] {
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [4, 4], "clear": {clear}}} }},
                 "passes": [ {{"color": ["color"], "draws": [
                     {{"mesh": {{"kind": "full"}}, "shader": "uniform_color", "params": {{"color": {color}}}, {state}}}]}} ],
                 "read": ["color"] }}"#
        ),
    );
    let color = image(&frame, "color", Aspect::Color);
    let texel: [u32; 4] = color.sample(3, 3, 0).try_into().expect("four channels");
    assert_texels(color, |_, _| texel);
    texel
}

#[track_caller]
fn assert_near(came: [u32; 4], due: [u32; 4]) {
    let near = came.iter().zip(due).all(|(c, d)| c.abs_diff(d) <= 1);
    assert!(near, "{came:?} instead of {due:?}");
}

pub(crate) fn blending_from_the_textbook(backend: &WgpuBackend) {
    let over = r#""blend": {
        "color": {"operation": "add", "src_factor": "src-alpha", "dst_factor": "one-minus-src-alpha"},
        "alpha": {"operation": "add", "src_factor": "one", "dst_factor": "zero"}}"#;
    let came = blended(backend, "[1, 0, 0, 1]", "[0, 0, 1, 0.6]", over);
    assert_near(came, [102, 0, 153, 153]);
    let over = over.replace(
        "\"dst_factor\": \"zero\"",
        "\"dst_factor\": \"one-minus-src-alpha\"",
    );
    let came = blended(backend, "[1, 0, 0, 1]", "[0, 0, 1, 0.6]", &over);
    assert_near(came, [102, 0, 153, 255]);
    let over = over.replace("\"src_factor\": \"one\"", "\"src_factor\": \"src-alpha\"");
    let came = blended(backend, "[1, 0, 0, 1]", "[0, 0, 1, 0.6]", &over);
    assert_near(came, [102, 0, 153, 194]);
}

pub(crate) fn blend_constant_and_its_alpha(backend: &WgpuBackend) {
    let state = r#""blend_constant": [0.2, 0.4, 0.6, 0.8], "blend": {
        "color": {"operation": "add", "src_factor": "constant", "dst_factor": "zero"},
        "alpha": {"operation": "add", "src_factor": "constant-alpha", "dst_factor": "one-minus-constant-alpha"}}"#;
    let came = blended(backend, "[1, 1, 1, 1]", "[1, 1, 1, 0]", state);
    assert_near(came, [51, 102, 153, 51]);
}

pub(crate) fn write_masks(backend: &WgpuBackend) {
    for mask in ["", "r", "gb", "a", "rgba"] {
        let state = format!(r#""write_mask": "{mask}""#);
        let came = blended(backend, "[0, 0, 0, 0]", "[1, 1, 1, 1]", &state);
        let due = ['r', 'g', 'b', 'a'].map(|c| if mask.contains(c) { 255 } else { 0 });
        assert_eq!(came, due, "{mask}");
    }
}

pub(crate) fn passes_keep_contents(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [6, 4], "clear": [0, 0, 1, 1]},
                              "ds": {"format": "depth24plus-stencil8", "clear": {"depth": 1, "stencil": 5}},
                              "drawn": {"format": "rgba8unorm", "texels": {"kind": "columns", "values":
                                  [[1, 2, 3, 4], [2, 2, 3, 4], [3, 2, 3, 4], [4, 2, 3, 4], [5, 2, 3, 4], [6, 2, 3, 4]]}} },
             "passes": [
                 {"color": ["color"], "depth_stencil": "ds", "draws": [
                     {"mesh": {"kind": "rect", "texels": [0, 0, 3, 4]}, "shader": "flat_color_depth",
                      "params": {"color": [1, 0, 0, 1]}, "depth": {"compare": "less", "write": true},
                      "stencil": {"reference": 9, "front": {"compare": "always", "pass_op": "replace"}}}]},
                 {"color": ["drawn"], "draws": [
                     {"mesh": {"kind": "rect", "texels": [1, 0, 2, 4]}, "shader": "uniform_color",
                      "params": {"color": [0, 1, 0, 1]}}]},
                 {"color": ["color"], "depth_stencil": "ds", "draws": [
                     {"mesh": {"kind": "full"}, "shader": "uniform_color", "params": {"color": [0, 1, 0, 1]},
                      "stencil": {"reference": 5, "front": {"compare": "equal"}}}]} ],
             "read": ["color", "drawn", "ds"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| if x < 3 { RED } else { GREEN });
    let drawn = image(&frame, "drawn", Aspect::Color);
    assert_texels(drawn, |x, _| if x == 1 { GREEN } else { [x + 1, 2, 3, 4] });
    let stencil = image(&frame, "ds", Aspect::Stencil);
    assert_texels(stencil, |x, _| [if x < 3 { 9 } else { 5 }]);
    let depth = image(&frame, "ds", Aspect::Depth);
    assert_eq!([value(depth, 2, 0), value(depth, 3, 3)], [0.0, 1.0]);
}

pub(crate) fn written_depth_without_a_depth_attachment(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "full", "value": 0.5}, "shader": "flat_color_depth",
                  "params": {"color": [1, 0, 0, 1]}}]} ],
             "read": ["color"] }"#,
    );
    assert_texels(image(&frame, "color", Aspect::Color), |_, _| RED);
}

pub(crate) fn written_depth_is_exact_in_floats(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "depth": {"format": "depth32float", "size": [4, 4], "clear": 1} },
             "passes": [ {"depth_stencil": "depth", "draws": [
                 {"mesh": {"kind": "columns", "values": [0.1, 0.3333333, 1e-7, 0.9999999]},
                  "shader": "flat_color_depth", "depth": {"compare": "always", "write": true}}]} ],
             "read": ["depth"] }"#,
    );
    let depths = [0.1_f32, 0.333_333_3, 1e-7, 0.999_999_9];
    let depth = image(&frame, "depth", Aspect::Depth);
    assert_texels(depth, |x, _| [depths[x as usize].to_bits()]);
}

pub(crate) fn floats_are_exact_or_refused(backend: &WgpuBackend) {
    let values = [0.1_f32, -2.5, 1e30, 1.0 / 3.0];
    let scene = scene(&format!(
        r#"{{ "attachments": {{ "color": {{"format": "rgba32float", "size": [4, 4]}},
                                "cleared": {{"format": "rgba32float", "clear": {values:?}}} }},
             "passes": [ {{"color": ["color"], "draws": [
                 {{"mesh": {{"kind": "full"}}, "params": {{"color": {values:?}}}, "shader": "uniform_color"}}]}} ],
             "read": ["cleared", "color"] }}"#
    ));
    if backend.adapter().name == "wgpu:gl:llvmpipe" {
        // wgpu takes floats for drawable in OpenGL only where an extension says so that core contexts
        // have no need of.
        let error = backend.prepare(&scene).err();
        let due = Requirement::Drawing(TextureFormat::Rgba32Float);
        assert_eq!(error, Some(BackendError::NotSupported(due)));
        return;
    }
    let frame = drawn(backend, &scene);
    let bits = values.map(f32::to_bits);
    assert_texels(image(&frame, "color", Aspect::Color), |_, _| bits);
    assert_texels(image(&frame, "cleared", Aspect::Color), |_, _| bits);
}

pub(crate) fn sizes_that_are_no_multiples(backend: &WgpuBackend) {
    for [width, height] in [[1, 1], [7, 3], [65, 2], [200, 130]] {
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [{width}, {height}], "clear": [0, 1, 0, 1]}},
                                        "ds": {{"format": "depth24plus-stencil8", "clear": {{"depth": 1, "stencil": 3}}}} }},
                     "passes": [ {{"color": ["color"], "depth_stencil": "ds", "draws": [
                         {{"mesh": {{"kind": "rect", "texels": [0, 0, 1, 1]}}, "shader": "flat_color_depth",
                          "params": {{"color": [1, 0, 0, 1]}}, "depth": {{"compare": "less", "write": true}},
                          "stencil": {{"front": {{"compare": "always", "pass_op": "invert"}}}}}}]}} ],
                     "read": ["color", "ds"] }}"#
            ),
        );
        let first = |x, y| x == 0 && y == 0;
        let color = image(&frame, "color", Aspect::Color);
        assert_texels(color, |x, y| if first(x, y) { RED } else { GREEN });
        let stencil = image(&frame, "ds", Aspect::Stencil);
        assert_texels(stencil, |x, y| [if first(x, y) { 252 } else { 3 }]);
        let depth = image(&frame, "ds", Aspect::Depth);
        let one = 1_f32.to_bits();
        assert_texels(depth, |x, y| [if first(x, y) { 0 } else { one }]);
    }
}

pub(crate) fn several_scenes_live_at_once(backend: &WgpuBackend) {
    let colored = |color: &str| {
        scene(&format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [4, 4]}} }},
                 "passes": [ {{"color": ["color"], "draws": [
                     {{"mesh": {{"kind": "full"}}, "shader": "uniform_color", "params": {{"color": {color}}}}}]}} ],
                 "read": ["color"] }}"#
        ))
    };
    let mut red = backend.prepare(&colored("[1, 0, 0, 1]")).expect("prepared");
    let mut green = backend.prepare(&colored("[0, 1, 0, 1]")).expect("prepared");
    assert!(red.read_back().is_err(), "nothing was submitted");
    red.submit().expect("drawn");
    green.submit().expect("drawn");
    for (prepared, due) in [(&mut red, RED), (&mut green, GREEN)] {
        let frame = prepared.read_back().expect("read");
        assert_texels(image(&frame, "color", Aspect::Color), |_, _| due);
    }
}

pub(crate) fn what_is_denied_is_not_supported(backend: &WgpuBackend) {
    let limits = backend.limits();
    assert_eq!(limits.api, Api::WebGpu);
    assert!(!limits.features.contains(&Feature::LogicOperations));
    assert!(!limits.formats.contains_key(&TextureFormat::B5g6r5Unorm));
    let denied = |target: &str, draw: &str, due: Requirement| {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm" {target}}},
                                    "ds": {{"format": "stencil8" {target}}} }},
                 "passes": [ {{"color": ["color"], "depth_stencil": "ds", "draws": [
                     {{"mesh": {{"kind": "full"}}, "shader": "uniform_color" {draw}}}]}} ],
                 "read": ["color"] }}"#
        ));
        let error = backend.prepare(&scene).err();
        assert_eq!(error, Some(BackendError::NotSupported(due)));
    };
    denied(
        "",
        r#", "cull": "front-and-back""#,
        Requirement::Feature(Feature::FrontAndBackCulling),
    );
    denied(
        "",
        r#", "stencil": {"front": {"compare": "always"}, "back": {"compare": "always", "reference": 1}}"#,
        Requirement::Feature(Feature::SeparateStencilMasks),
    );
    denied(
        r#", "samples": 8"#,
        "",
        Requirement::Samples(TextureFormat::Rgba8Unorm, 8),
    );
}
