//! What not every adapter can do, one scene each, drawn where the limits offer it.

use crate::harness::{assert_texels, frame, has, image, value};
use etalon_backend::Backend;
use etalon_frame::{Aspect, ChannelEncoding, Feature, Image, ReadPath, TextureFormat};
use etalon_wgpu::WgpuBackend;

const RED: [u32; 4] = [255, 0, 0, 255];
const GREEN: [u32; 4] = [0, 255, 0, 255];
const BLUE: [u32; 4] = [0, 0, 255, 255];

pub(crate) fn all(backend: &WgpuBackend) {
    targets_blend_apart(backend);
    formats_keep_their_codes(backend);
    a_viewport_in_a_corner(backend);
    a_viewport_that_reaches_outside(backend);
    a_scissor_of_one_texel(backend);
    depth_bias_and_its_clamp(backend);
    depth_is_clamped(backend);
    strips_begin_again(backend);
    lists_leave_out_what_is_not_whole(backend);
    points_and_lines(backend);
    edges_of_a_triangle(backend);
    depth_that_is_only_read(backend);
}

/// What the drivers are known to have; a test that is skipped where it should run would be green.
pub(crate) fn what_is_offered(backend: &WgpuBackend) {
    let limits = backend.limits();
    let mut due = vec![
        Feature::CentroidInterpolation,
        Feature::ConservativeDepth,
        Feature::DepthClamp,
        Feature::DualSourceBlending,
        Feature::ForcedEarlyTests,
        Feature::PolygonModeLine,
        Feature::ViewportOutside,
    ];
    let name = backend.adapter().name.as_str();
    if name != "wgpu:gl:softpipe" {
        due.extend([
            Feature::IndependentBlend,
            Feature::SampleShading,
            // Of softpipe's GLSL 330 wgpu says so too, and then does not translate it.
            Feature::StorageCounters,
        ]);
    }
    if name == "wgpu:vulkan:lavapipe" {
        due.extend([Feature::DepthBiasClamp, Feature::FragmentInvocations]);
    }
    assert_eq!(limits.features, due.into_iter().collect());
    assert!(limits.max_color_attachments >= 4);
    for format in TextureFormat::ALL {
        let support = limits.formats.get(&format);
        let packed = matches!(
            format,
            TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm
        );
        assert_eq!(support.is_none(), packed, "{format}");
        let Some(support) = support else { continue };
        let vulkan = name == "wgpu:vulkan:lavapipe";
        match format {
            // wgpu's OpenGL asks for extensions that core contexts have no need of.
            TextureFormat::Rgba8Snorm
            | TextureFormat::Rg11b10Ufloat
            | TextureFormat::Rgba16Float
            | TextureFormat::Rgba32Float
                if !vulkan => {}
            _ => assert!(support.samples.contains(&1), "{format}"),
        }
        if vulkan && format.is_color() {
            let due = format != TextureFormat::Rgba8Snorm && !format.is_integer();
            assert_eq!(support.blendable, due, "{format}");
        }
    }
}

pub(crate) fn two_sources(backend: &WgpuBackend) {
    // Over softpipe the second source comes as the first, which is for the suite to find.
    let wrong = backend.adapter().name == "wgpu:gl:softpipe";
    if wrong || !has(backend, Feature::DualSourceBlending) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": {
               "color": {"format": "rgba8unorm", "size": [2, 2], "clear": [0, 0, 1, 1]},
               "first": {"format": "rgba8unorm", "texels": {"kind": "columns",
                   "values": [[255, 0, 0, 255], [255, 0, 0, 255]]}},
               "second": {"format": "rgba8unorm", "texels": {"kind": "columns",
                   "values": [[255, 0, 0, 255], [0, 0, 255, 0]]}} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "full"}, "shader": "texel_dual_source", "textures": ["first", "second"],
                  "blend": {"color": {"operation": "add", "src_factor": "src1", "dst_factor": "one-minus-src1"},
                            "alpha": {"operation": "add", "src_factor": "src1-alpha", "dst_factor": "one-minus-src1-alpha"}}}]} ],
             "read": ["color"] }"#,
    );
    let due = [[255, 0, 255, 255], [0, 0, 0, 255]];
    assert_texels(image(&frame, "color", Aspect::Color), |x, _| {
        due[x as usize]
    });
}

pub(crate) fn targets_blend_apart(backend: &WgpuBackend) {
    if !has(backend, Feature::IndependentBlend) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": {
               "a": {"format": "rgba8unorm", "size": [2, 2], "clear": [0, 1, 0, 1]},
               "b": {"format": "rgba8unorm", "clear": [0, 0, 1, 0]},
               "c": {"format": "bgra8unorm", "clear": [0, 0, 1, 0]},
               "source": {"format": "rgba8unorm", "texels": {"kind": "columns",
                   "values": [[255, 0, 0, 255], [255, 0, 0, 255]]}} },
             "passes": [ {"color": ["a", "b", "c"], "draws": [
                 {"mesh": {"kind": "full"}, "shader": "texel_color_all", "textures": ["source"],
                  "targets": [ {"write_mask": "r"},
                    {"blend": {"color": {"operation": "add", "src_factor": "one", "dst_factor": "one"},
                               "alpha": {"operation": "add", "src_factor": "zero", "dst_factor": "one"}}},
                    {} ]}]} ],
             "read": ["a", "b", "c"] }"#,
    );
    let color = |name| image(&frame, name, Aspect::Color);
    assert_texels(color("a"), |_, _| [255, 255, 0, 255]);
    assert_texels(color("b"), |_, _| [255, 0, 255, 0]);
    assert_texels(color("c"), |_, _| RED);
}

/// Uploads, clears of 0 and 1, and draws of 0 and 1, in every colour format.
pub(crate) fn formats_keep_their_codes(backend: &WgpuBackend) {
    for (format, support) in &backend.limits().formats {
        if !format.is_color() {
            continue;
        }
        let channels = format.color_channels();
        // Column by column an exact value, as a case file has it, and its code.
        let upload = |x: i64, c: usize| match channels.get(c) {
            None => (0.0, 0),
            Some(e) if e.is_float() => {
                let value = [0.25, 1.0, 2.0, 0.5][(x as usize + c) % 4];
                (value, e.nearest_code(value))
            }
            Some(e) => {
                let order = (e.max_order() - 7 * x - c as i64).max(e.min_order());
                (order as f64, e.code_of_order(order))
            }
        };
        let texels: Vec<_> = (0..4)
            .map(|x| [0, 1, 2, 3].map(|c| upload(x, c).0))
            .collect();
        let mut passes = String::new();
        if support.samples.contains(&1) {
            let draw = if format.is_integer() {
                r#"{"mesh": {"kind": "rect", "texels": [0, 0, 2, 3]}, "shader": "uint_color"}"#
            } else {
                r#"{"mesh": {"kind": "columns", "values": [0, 1]}, "shader": "flat_color"}"#
            };
            passes = format!(r#"{{"color": ["drawn"], "draws": [{draw}]}}"#);
        }
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{
                       "cleared": {{"format": "{format}", "size": [4, 3], "clear": [1, 0, 1, 0]}},
                       "drawn": {{"format": "{format}", "clear": [1, 1, 1, 1]}},
                       "texels": {{"format": "{format}", "texels": {{"kind": "columns", "values": {texels:?}}}}} }},
                     "passes": [{passes}], "read": ["cleared", "drawn", "texels"] }}"#
            ),
        );
        let codes = |values: [f64; 4]| -> Vec<u32> {
            let both = channels.iter().zip(values);
            both.map(|(e, value)| e.nearest_code(value)).collect()
        };
        let check = |name: &str, due: &dyn Fn(u32) -> Vec<u32>| {
            let image: &Image = image(&frame, name, Aspect::Color);
            assert_eq!(
                (image.read, image.channels.as_slice()),
                (ReadPath::Copy, channels)
            );
            for (x, y) in (0..4).flat_map(|x| (0..3).map(move |y| (x, y))) {
                assert_eq!(
                    image.sample(x, y, 0),
                    due(x),
                    "{format} {name} column {x}, row {y}"
                );
            }
        };
        check("cleared", &|_| codes([1.0, 0.0, 1.0, 0.0]));
        check("texels", &|x| {
            let all = 0..channels.len();
            all.map(|c| upload(x.into(), c).1).collect()
        });
        let drawn = support.samples.contains(&1);
        if format.is_integer() && backend.adapter().name == "wgpu:gl:softpipe" {
            // It loses the clear, see `integers_are_stored`.
            continue;
        }
        check("drawn", &|x| {
            codes([if drawn && x < 2 { 0.0 } else { 1.0 }; 4])
        });
    }
}

#[track_caller]
fn assert_near(image: &Image, x: u32, y: u32, due: f64, distance: f64) {
    let came = value(image, x, y);
    assert!(
        (came - due).abs() <= distance,
        "{came} at {x}, {y} where {due} is due"
    );
}

pub(crate) fn a_viewport_in_a_corner(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "depth": {"format": "depth32float", "size": [8, 8], "clear": 1} },
             "passes": [ {"depth_stencil": "depth", "draws": [
                 {"mesh": {"kind": "columns", "values": [0, 0], "z": [0, 1]}, "shader": "flat_color",
                  "viewport": {"rect": [4, 0, 4, 4], "depth": [0.25, 0.75]},
                  "depth": {"compare": "always", "write": true}}]} ],
             "read": ["depth"] }"#,
    );
    let depth = image(&frame, "depth", Aspect::Depth);
    for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (x, y))) {
        let due = match (x, y) {
            (4 | 5, 0..4) => 0.25,
            (6 | 7, 0..4) => 0.75,
            _ => 1.0,
        };
        assert_near(depth, x, y, due, 1e-5);
    }
}

pub(crate) fn a_viewport_that_reaches_outside(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "columns", "values": [[1, 0, 0, 1], [0, 1, 0, 1]]}, "shader": "flat_color",
                  "viewport": {"rect": [-4, -2, 8, 8], "depth": [0, 1]}}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, y| if x < 4 && y < 6 { GREEN } else { BLUE });
}

pub(crate) fn a_scissor_of_one_texel(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "full"}, "shader": "uniform_color", "params": {"color": [1, 0, 0, 1]},
                  "scissor": [5, 1, 1, 1]},
                 {"mesh": {"kind": "rect", "texels": [0, 0, 1, 1]}, "shader": "uniform_color",
                  "params": {"color": [0, 1, 0, 1]}}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, y| match (x, y) {
        (5, 1) => RED,
        (0, 0) => GREEN,
        _ => BLUE,
    });
}

/// A least step at 0.5 is 2^-24: 1024 of them are 2^-14.
pub(crate) fn depth_bias_and_its_clamp(backend: &WgpuBackend) {
    let drawn = |bias: &str| {
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{ "depth": {{"format": "depth32float", "size": [4, 4], "clear": 1}} }},
                     "passes": [ {{"depth_stencil": "depth", "draws": [
                         {{"mesh": {{"kind": "full", "z": 0.5}}, "shader": "flat_color", "depth_bias": {bias},
                          "depth": {{"compare": "always", "write": true}}}}]}} ],
                     "read": ["depth"] }}"#
            ),
        );
        value(image(&frame, "depth", Aspect::Depth), 1, 2)
    };
    let step = 2_f64.powi(-14);
    let biased = drawn(r#"{"constant": 1024}"#) - drawn("{}");
    assert!((0.5 * step..=2.0 * step).contains(&biased), "{biased}");
    if has(backend, Feature::DepthBiasClamp) {
        let clamped = drawn(r#"{"constant": 8388608, "clamp": 0.125}"#);
        assert!((clamped - 0.625).abs() < 1e-5, "{clamped}");
    }
}

pub(crate) fn depth_is_clamped(backend: &WgpuBackend) {
    if !has(backend, Feature::DepthClamp) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1]},
                              "depth": {"format": "depth32float", "clear": 0.5} },
             "passes": [ {"color": ["color"], "depth_stencil": "depth", "draws": [
                 {"mesh": {"kind": "rect", "texels": [0, 0, 2, 4], "z": 1.5}, "shader": "uniform_color",
                  "params": {"color": [1, 0, 0, 1]}, "depth_clamp": true,
                  "depth": {"compare": "always", "write": true}},
                 {"mesh": {"kind": "rect", "texels": [2, 0, 4, 4], "z": 1.5}, "shader": "uniform_color",
                  "params": {"color": [1, 0, 0, 1]}, "depth": {"compare": "always", "write": true}}]} ],
             "read": ["color", "depth"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| if x < 2 { RED } else { BLUE });
    let depth = image(&frame, "depth", Aspect::Depth);
    assert_eq!([value(depth, 1, 1), value(depth, 2, 1)], [1.0, 0.5]);
}

const RESTARTED: &str = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]} },
    "passes": [ {"color": ["color"], "draws": [
        {"mesh": {"kind": "vertices", "units": "texels", "values": [[1, 0, 0, 1]],
                  "positions": [[0, 0, 0], [0, 8, 0], [2.25, 0, 0], [2, 8, 0],
                                [5, 0, 0], [5, 8, 0], [8.25, 0, 0], [8, 8, 0]],
                  "indices": [INDICES]},
         "topology": "TOPOLOGY", "shader": "flat_color"}]} ],
    "read": ["color"] }"#;

/// wgpu's OpenGL never enables the restart of primitives: there the two rectangles are joined, or
/// worse, which is for the suite to find.
pub(crate) fn strips_begin_again(backend: &WgpuBackend) {
    if backend.adapter().name.starts_with("wgpu:gl:") {
        return;
    }
    let scene = RESTARTED
        .replace("INDICES", "0, 1, 2, 3, null, 4, 5, 6, 7")
        .replace("TOPOLOGY", "triangle-strip");
    let frame = frame(backend, &scene);
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| if (2..5).contains(&x) { BLUE } else { RED });
}

pub(crate) fn lists_leave_out_what_is_not_whole(backend: &WgpuBackend) {
    let scene = RESTARTED
        .replace("INDICES", "0, 1, 2, 2, 1, 3, 4, null, 5, 5, null, 6")
        .replace("TOPOLOGY", "triangle-list");
    let frame = frame(backend, &scene);
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| if x < 2 { RED } else { BLUE });
}

pub(crate) fn points_and_lines(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "vertices", "units": "texels", "values": [[1, 0, 0, 1], [0, 1, 0, 1]],
                           "positions": [[0.5, 0.5, 0], [6.5, 7.5, 0]]},
                  "topology": "point-list", "shader": "flat_color"},
                 {"mesh": {"kind": "vertices", "units": "texels", "values": [[1, 0, 0, 1]],
                           "positions": [[2, 2.5, 0], [6, 2.5, 0]]},
                  "topology": "line-list", "shader": "flat_color", "depth_bias": {"constant": 4}},
                 {"mesh": {"kind": "vertices", "units": "texels", "values": [[0, 1, 0, 1]],
                           "positions": [[1, 4.5, 0], [3, 4.5, 0], [5, 4.5, 0]]},
                  "topology": "line-strip", "shader": "flat_color"}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, y| match (x, y) {
        (0, 0) | (2..6, 2) => RED,
        (6, 7) | (1..5, 4) => GREEN,
        _ => BLUE,
    });
}

pub(crate) fn edges_of_a_triangle(backend: &WgpuBackend) {
    if !has(backend, Feature::PolygonModeLine) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8], "clear": [0, 0, 1, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "vertices", "units": "texels", "values": [[1, 0, 0, 1]],
                           "positions": [[0.5, 0.5, 0], [0.5, 7.5, 0], [7.5, 0.5, 0]]},
                  "polygon_mode": "line", "shader": "flat_color"}]} ],
             "read": ["color"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    let texel = |x, y| color.sample(x, y, 0);
    // What lies on the two straight edges and off their ends, inside, and outside.
    assert_eq!([texel(3, 0), texel(0, 3)], [RED; 2]);
    assert_eq!([texel(2, 2), texel(1, 3), texel(7, 7)], [BLUE; 3]);
}

pub(crate) fn depth_that_is_only_read(backend: &WgpuBackend) {
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1]},
                              "ds": {"format": "depth32float-stencil8", "clear": {"depth": 0.5, "stencil": 7}} },
             "passes": [ {"color": ["color"], "depth_stencil": "ds", "depth_stencil_read_only": true, "draws": [
                 {"mesh": {"kind": "columns", "values": [0, 0], "z": [0.25, 0.75]}, "shader": "uniform_color",
                  "params": {"color": [1, 0, 0, 1]}, "depth": {"compare": "less", "write": false},
                  "stencil": {"reference": 7, "front": {"compare": "equal"}}}]} ],
             "read": ["color", "ds"] }"#,
    );
    let color = image(&frame, "color", Aspect::Color);
    assert_texels(color, |x, _| if x < 2 { RED } else { BLUE });
    let depth = image(&frame, "ds", Aspect::Depth);
    assert_eq!(depth.channels, [ChannelEncoding::Float32]);
    assert_texels(depth, |_, _| [0.5_f32.to_bits()]);
    assert_texels(image(&frame, "ds", Aspect::Stencil), |_, _| [7]);
}
