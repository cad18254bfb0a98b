//! Features, formats and samples that wgpu offers over each driver, and what it denies.

use crate::drivers;
use etalon_backend::{Backend, BackendError};
use etalon_conformance::{CHECKS, COUNTING_SHADERS, FOUR_SAMPLES, scene};
use etalon_frame::{Api, Feature, Requirement, TextureFormat};

/// A check that is skipped where it should run would pass.
pub(crate) fn offers(backend: &dyn Backend) {
    let limits = backend.limits();
    let mut due = vec![
        Feature::CentroidInterpolation,
        Feature::ConservativeDepth,
        Feature::DepthClamp,
        Feature::DualSourceBlending,
        Feature::ForcedEarlyTests,
        // Of softpipe's GLSL 330 wgpu says so too, and then does not translate it.
        Feature::StorageCounters,
        Feature::ViewportOutside,
    ];
    let name = backend.adapter().name.as_str();
    if name != "wgpu:gl:softpipe" {
        due.extend([Feature::IndependentBlend, Feature::SampleShading]);
    }
    let vulkan = name == "wgpu:vulkan:lavapipe";
    if vulkan {
        due.extend([Feature::DepthBiasClamp, Feature::FragmentInvocations]);
    }
    assert_eq!(limits.api, Api::WebGpu);
    assert_eq!(limits.features, due.into_iter().collect());
    for format in TextureFormat::ALL.iter().copied() {
        let support = limits.formats.get(&format);
        let packed = matches!(
            format,
            TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm
        );
        assert_eq!(support.is_none(), packed, "{format}");
        let Some(support) = support else { continue };
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
        // The codes of these could not be told for certain; WebGPU does not resolve integers.
        let inexact = [
            TextureFormat::Rgba8Snorm,
            TextureFormat::Depth16Unorm,
            TextureFormat::Rgba8Uint,
        ];
        let four = !inexact.contains(&format);
        if vulkan {
            assert_eq!(support.samples.contains(&4), four, "{format}");
        }
    }
    assert_eq!(limits.formats[&TextureFormat::Rgba8Uint].samples, [1]);
    // Over OpenGL wgpu 30 says that it has four samples, also where the driver has one.
    let color = &limits.formats[&TextureFormat::Rgba8Unorm];
    assert_eq!(color.samples, [1, 4]);
    assert!(limits.sample_positions.contains_key(&4));
    denies(backend);
    if name == "wgpu:gl:softpipe" {
        loses_the_clear_of_integers(backend);
    }
}

fn denies(backend: &dyn Backend) {
    let denied = |target: &str, draw: &str, counters: &str, due: Requirement| {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm" {target} }}, "ds": {{ "format": "stencil8" {target} }} }},
                 "passes": [ {{ "color": ["color"], "depth_stencil": "ds", "draws": [
                     {{ "mesh": {{ "kind": "full" }}, "shader": "uniform_color" {draw} }} ] }} ],
                 "read": ["color"] {counters} }}"#
        ));
        let error = backend.prepare(&scene).err();
        assert_eq!(error, Some(BackendError::NotSupported(due)));
    };
    let feature = Requirement::Feature;
    denied(
        "",
        r#", "cull": "front-and-back""#,
        "",
        feature(Feature::FrontAndBackCulling),
    );
    denied(
        "",
        r#", "stencil": { "front": { "compare": "always" }, "back": { "compare": "always", "reference": 1 } }"#,
        "",
        feature(Feature::SeparateStencilMasks),
    );
    let samples = Requirement::Samples(TextureFormat::Rgba8Unorm, 8);
    denied(r#", "samples": 8"#, "", "", samples);
    let counters = r#", "counters": { "n": "samples-passed" }"#;
    denied(
        "",
        r#", "counters": ["n"]"#,
        counters,
        feature(Feature::PreciseOcclusion),
    );
    let floats = TextureFormat::Rgba32Float;
    if backend.adapter().name == "wgpu:gl:llvmpipe" {
        assert!(backend.limits().formats[&floats].samples.is_empty());
    }
}

/// Texels of the clear are 0 where a draw of the pass leaves them.
fn loses_the_clear_of_integers(backend: &dyn Backend) {
    let scene = scene(
        r#"{ "attachments": { "color": { "format": "rgba8uint", "size": [4, 4], "clear": [1, 128, 255, 0] } },
             "passes": [ { "color": ["color"], "draws": [
                 { "mesh": { "kind": "rect", "texels": [0, 0, 2, 4] }, "shader": "uint_color",
                   "params": { "color": [255, 0, 17, 200] } } ] } ],
             "read": ["color"] }"#,
    );
    let mut prepared = backend.prepare(&scene).expect("it is prepared");
    prepared.submit().expect("it is drawn");
    let frame = prepared.read_back().expect("it is read back");
    assert_eq!(frame.images[0].sample(1, 1, 0), [255, 0, 17, 200]);
    assert_eq!(frame.images[0].sample(2, 1, 0), [0; 4]);
}

#[test]
fn checks_known_to_fail_exist() {
    for (name, _) in &drivers::softpipe().defects {
        let whole = [FOUR_SAMPLES, COUNTING_SHADERS].contains(name);
        assert!(
            whole || CHECKS.iter().any(|check| check.name == *name),
            "{name}"
        );
    }
}
