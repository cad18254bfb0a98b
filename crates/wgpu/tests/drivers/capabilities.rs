//! Features, formats and samples that wgpu offers over each driver, and what it denies.

use etalon_backend::{Backend, BackendError};
use etalon_conformance::{Value, json, scene, with};
use etalon_frame::{Api, Feature, Requirement, TextureFormat};

/// Facts that the drivers' descriptions do not give.
pub(crate) fn offers(backend: &dyn Backend) {
    let limits = backend.limits();
    assert_eq!(limits.api, Api::WebGpu);
    for (format, support) in &limits.formats {
        assert!(matches!(support.samples[..], [] | [1, ..]), "{format}");
    }
    assert_eq!(limits.formats[&TextureFormat::Rgba8Uint].samples, [1]);
    // Over OpenGL wgpu 30 reports four samples, even if the driver has one.
    let color = &limits.formats[&TextureFormat::Rgba8Unorm];
    assert_eq!(color.samples, [1, 4]);
    assert!(limits.sample_positions.contains_key(&4));
    denies(backend);
    if backend.adapter().name == "wgpu:gl:softpipe" {
        loses_the_clear_of_integers(backend);
    }
}

fn denies(backend: &dyn Backend) {
    let denied = |target: Value, draw: Value, counters: Value, expected: Requirement| {
        let drawn = json!({ "mesh": { "kind": "full" }, "shader": "uniform_color" });
        let scene = scene(json!({
            "attachments": { "color": with(json!({ "format": "rgba8unorm" }), target.clone()),
                             "ds": with(json!({ "format": "stencil8" }), target) },
            "passes": [{ "color": ["color"], "depth_stencil": "ds", "draws": [with(drawn, draw)] }],
            "read": ["color"],
            "counters": counters,
        }));
        let error = backend.prepare(&scene).err();
        assert_eq!(error, Some(BackendError::NotSupported(expected)));
    };
    let none = || json!({});
    let feature = Requirement::Feature;
    let cull = json!({ "cull": "front-and-back" });
    denied(none(), cull, none(), feature(Feature::FrontAndBackCulling));
    let back = json!({ "compare": "always", "reference": 1 });
    let stencil = json!({ "stencil": { "front": { "compare": "always" }, "back": back } });
    denied(
        none(),
        stencil,
        none(),
        feature(Feature::SeparateStencilMasks),
    );
    let samples = Requirement::Samples(TextureFormat::Rgba8Unorm, 8);
    denied(json!({ "samples": 8 }), none(), none(), samples);
    let (counter, counters) = (
        json!({ "counters": ["n"] }),
        json!({ "n": "samples-passed" }),
    );
    denied(
        none(),
        counter,
        counters,
        feature(Feature::PreciseOcclusion),
    );
}

/// Cleared texels are 0 if a draw of the pass leaves them.
fn loses_the_clear_of_integers(backend: &dyn Backend) {
    let scene = scene(json!({
        "attachments": { "color": { "format": "rgba8uint", "size": [4, 4], "clear": [1, 128, 255, 0] } },
        "passes": [{ "color": ["color"], "draws": [{
            "mesh": { "kind": "rect", "texels": [0, 0, 2, 4] }, "shader": "uint_color",
            "params": { "color": [255, 0, 17, 200] } }] }],
        "read": ["color"],
    }));
    let mut prepared = backend.prepare(&scene).expect("it is prepared");
    prepared.submit().expect("it is drawn");
    let frame = prepared.read_back().expect("it is read back");
    assert_eq!(frame.images[0].sample(1, 1, 0), [255, 0, 17, 200]);
    assert_eq!(frame.images[0].sample(2, 1, 0), [0; 4]);
}
