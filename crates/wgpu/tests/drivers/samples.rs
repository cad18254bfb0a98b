//! Several samples per texel, drawn where the limits offer them: on Vulkan.

use crate::harness::{frame, has, image};
use etalon_backend::Backend;
use etalon_frame::{Aspect, Feature, Image, TextureFormat};
use etalon_wgpu::WgpuBackend;

/// A triangle over every sample; the suite's rectangles are sure of the texels' centres only.
const EVERYWHERE: &str =
    r#"{"kind": "vertices", "positions": [[-1, -1, 0], [3, -1, 0], [-1, 3, 0]], "values": [1]}"#;

pub(crate) fn all(backend: &WgpuBackend) {
    a_mask_lets_samples_through(backend);
    every_format_has_its_samples(backend);
    the_shader_knows_its_sample(backend);
    samples_are_averaged(backend);
    alpha_takes_samples_away(backend);
    a_point_inside_the_primitive(backend);
    each_sample_writes_its_depth(backend);
}

fn offered(backend: &WgpuBackend, format: TextureFormat) -> bool {
    let support = &backend.limits().formats[&format];
    support.samples.contains(&4)
}

/// wgpu 30 over OpenGL says that it has four samples, also where the driver has one, and makes no
/// texture of which a shader could read them.
pub(crate) fn samples_are_truthful(backend: &WgpuBackend) {
    let vulkan = backend.adapter().name == "wgpu:vulkan:lavapipe";
    for format in backend.limits().formats.keys() {
        // Their codes could not be told for certain.
        let inexact = [
            TextureFormat::Rgba8Snorm,
            TextureFormat::Depth16Unorm,
            // WebGPU does not resolve integers.
            TextureFormat::Rgba8Uint,
        ];
        let due = vulkan && !inexact.contains(format);
        assert_eq!(offered(backend, *format), due, "{format}");
    }
    assert_eq!(backend.limits().sample_positions.contains_key(&4), vulkan);
}

#[track_caller]
fn assert_samples(image: &Image, due: impl Fn(u32, u32) -> Vec<u32>) {
    assert_eq!(image.samples, 4);
    for (y, x) in (0..image.size[1]).flat_map(|y| (0..image.size[0]).map(move |x| (y, x))) {
        for sample in 0..4 {
            let came = image.sample(x, y, sample);
            let name = &image.attachment;
            assert_eq!(
                came,
                due(x, sample),
                "{name} column {x}, row {y}, sample {sample}"
            );
        }
    }
}

pub(crate) fn a_mask_lets_samples_through(backend: &WgpuBackend) {
    if !offered(backend, TextureFormat::Rgba8Unorm) {
        return;
    }
    let scene = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "samples": 4, "clear": [0, 0, 1, 1]} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": EVERYWHERE, "shader": "uniform_color", "params": {"color": [1, 0, 0, 1]},
                  "multisample": {"mask": 5}}]} ],
             "read": ["color"] }"#;
    let frame = frame(backend, &scene.replace("EVERYWHERE", EVERYWHERE));
    assert_samples(image(&frame, "color", Aspect::Color), |_, sample| {
        if sample % 2 == 0 {
            vec![255, 0, 0, 255]
        } else {
            vec![0, 0, 255, 255]
        }
    });
}

/// Samples 1 and 2 of every format take 1, or depth 0 and stencil 9; the others keep their clear.
pub(crate) fn every_format_has_its_samples(backend: &WgpuBackend) {
    for (format, support) in &backend.limits().formats {
        if !support.samples.contains(&4) {
            continue;
        }
        let (pass, clear, tests) = match (format.has_depth(), format.has_stencil()) {
            (false, false) => (r#""color": ["a"]"#, "[0, 0, 0, 0]", ""),
            (true, false) => (
                r#""depth_stencil": "a""#,
                "1",
                r#", "depth": {"compare": "less", "write": true}"#,
            ),
            (false, true) => (
                r#""depth_stencil": "a""#,
                "5",
                r#", "stencil": {"reference": 9, "front": {"compare": "always", "pass_op": "replace"}}"#,
            ),
            (true, true) => (
                r#""depth_stencil": "a""#,
                r#"{"depth": 1, "stencil": 5}"#,
                r#", "depth": {"compare": "less", "write": true},
                   "stencil": {"reference": 9, "front": {"compare": "always", "pass_op": "replace"}}"#,
            ),
        };
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{ "a": {{"format": "{format}", "size": [5, 3], "samples": 4, "clear": {clear}}} }},
                     "passes": [ {{{pass}, "draws": [
                         {{"mesh": {EVERYWHERE}, "shader": "flat_color",
                          "multisample": {{"mask": 6}} {tests}}}]}} ],
                     "read": ["a"] }}"#
            ),
        );
        for image in &frame.images {
            if image.aspect != Aspect::Stencil {
                assert_eq!(image.read, support.read, "{format}");
            }
            assert_samples(image, |_, sample| {
                let drawn = sample == 1 || sample == 2;
                if image.aspect == Aspect::Stencil {
                    return vec![if drawn { 9 } else { 5 }];
                }
                let value = if drawn == format.is_color() { 1.0 } else { 0.0 };
                let channels = image.channels.iter();
                channels.map(|e| e.nearest_code(value)).collect()
            });
        }
    }
}

pub(crate) fn the_shader_knows_its_sample(backend: &WgpuBackend) {
    if !offered(backend, TextureFormat::Bgra8Unorm) {
        return;
    }
    let scene = r#"{ "attachments": { "color": {"format": "bgra8unorm", "size": [4, 4], "samples": 4} },
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": EVERYWHERE, "shader": "sample_index"}]} ],
             "read": ["color"] }"#;
    let frame = frame(backend, &scene.replace("EVERYWHERE", EVERYWHERE));
    assert_samples(image(&frame, "color", Aspect::Color), |_, sample| {
        vec![255 * (sample & 1), 255 * (sample >> 1), 0, 255]
    });
}

pub(crate) fn samples_are_averaged(backend: &WgpuBackend) {
    if !offered(backend, TextureFormat::Rgba8Unorm) {
        return;
    }
    let scene = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "samples": 4, "clear": [0, 0, 0, 1]},
                              "one": {"format": "rgba8unorm", "clear": [0, 1, 0, 1]} },
             "passes": [ {"color": ["color"], "resolve": ["one"], "draws": [
                 {"mesh": EVERYWHERE, "shader": "uniform_color", "params": {"color": [1, 0, 0, 1]},
                  "multisample": {"mask": 3}}]} ],
             "read": ["one"] }"#;
    let frame = frame(backend, &scene.replace("EVERYWHERE", EVERYWHERE));
    let one = image(&frame, "one", Aspect::Color);
    for (x, y) in (0..4).flat_map(|x| (0..4).map(move |y| (x, y))) {
        let [r, g, b, a] = one.sample(x, y, 0) else {
            panic!("four channels are due")
        };
        assert!((126..=129).contains(r), "{r}");
        assert_eq!([*g, *b, *a], [0, 0, 255]);
    }
}

/// The halves are drawn without a scissor: lavapipe's lets a sample of the column before through.
pub(crate) fn alpha_takes_samples_away(backend: &WgpuBackend) {
    if !offered(backend, TextureFormat::Rgba8Unorm) {
        return;
    }
    let half = |left: i32, alpha: u32| {
        let right = left + 1;
        format!(
            r#"{{"mesh": {{"kind": "vertices", "values": [[1, 0, 0, {alpha}]],
                 "positions": [[{left}, -1, 0], [{right}, -1, 0], [{left}, 1, 0], [{right}, 1, 0]]}},
                "topology": "triangle-strip", "shader": "flat_color",
                "multisample": {{"alpha_to_coverage": true}}}}"#
        )
    };
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [4, 4], "samples": 4, "clear": [0, 0, 1, 0]}} }},
                 "passes": [ {{"color": ["color"], "draws": [{}, {}]}} ], "read": ["color"] }}"#,
            half(-1, 0),
            half(0, 1)
        ),
    );
    assert_samples(image(&frame, "color", Aspect::Color), |x, _| {
        if x < 2 {
            vec![0, 0, 255, 0]
        } else {
            vec![255, 0, 0, 255]
        }
    });
}

/// An edge leaves of the third column only the sample farthest to the left, and the texel's centre
/// lies where the coordinate, were it not interpolated inside, would be negative.
pub(crate) fn a_point_inside_the_primitive(backend: &WgpuBackend) {
    assert!(has(backend, Feature::CentroidInterpolation));
    let samples = if offered(backend, TextureFormat::Rgba8Unorm) {
        4
    } else {
        1
    };
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [4, 4], "samples": {samples}, "clear": [0, 0, 1, 1]}} }},
                 "passes": [ {{"color": ["color"], "draws": [
                     {{"mesh": {{"kind": "vertices", "units": "texels", "values": [1],
                                 "positions": [[-2, -2, 0], [-2, 6, 0], [2.25, -2, 0], [2.25, 6, 0]],
                                 "uv": [[4.25, 0], [4.25, 0], [0, 0], [0, 0]]}},
                      "topology": "triangle-strip", "shader": "centroid",
                      "params": {{"color": [1, 0, 0, 1], "back_color": [0, 1, 0, 1]}}}}]}} ],
                 "read": ["color"] }}"#
        ),
    );
    let color = image(&frame, "color", Aspect::Color);
    for (x, y) in (0..4).flat_map(|x| (0..4).map(move |y| (x, y))) {
        for sample in 0..samples {
            let covered = x < 2 || (samples, x, sample) == (4, 2, 2);
            let due = if covered {
                [255, 0, 0, 255]
            } else {
                [0, 0, 255, 255]
            };
            let came = color.sample(x, y, sample);
            assert_eq!(came, due, "column {x}, row {y}, sample {sample}");
        }
    }
}

pub(crate) fn each_sample_writes_its_depth(backend: &WgpuBackend) {
    if !offered(backend, TextureFormat::Depth32Float) {
        return;
    }
    let scene = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "samples": 4, "clear": [0, 0, 1, 1]},
                              "depth": {"format": "depth32float", "samples": 4, "clear": 0.078125} },
             "passes": [ {"color": ["color"], "depth_stencil": "depth", "draws": [
                 {"mesh": EVERYWHERE, "shader": "sample_depth", "params": {"color": [1, 0, 0, 1]},
                  "depth": {"compare": "less", "write": true}}]} ],
             "read": ["color", "depth"] }"#;
    let frame = frame(backend, &scene.replace("EVERYWHERE", EVERYWHERE));
    assert_samples(image(&frame, "color", Aspect::Color), |_, sample| {
        if sample < 2 {
            vec![255, 0, 0, 255]
        } else {
            vec![0, 0, 255, 255]
        }
    });
    assert_samples(image(&frame, "depth", Aspect::Depth), |_, sample| {
        let due = [0.03125_f32, 0.0625, 0.078125, 0.078125][sample as usize];
        vec![due.to_bits()]
    });
}
