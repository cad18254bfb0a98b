//! Scenes side by side and again, limits, adapters, the validation layer, and every built-in case.

use crate::common::{backend, check_shape, draw, scene};
use etalon_backend::{Backend, BackendError};
use etalon_case::{Library, Profile};
use etalon_frame::{Api, Feature, ReadPath, Requirement, TextureFormat};
use etalon_vulkan::{Options, VulkanBackend, enumerate, open};

/// Two passes, blending onto what is there, an upload, depth and stencil that change.
const BUSY: &str = r#"{
    "attachments": {
        "color": { "format": "rgba8unorm", "clear": [0.5, 0, 0, 0.5] },
        "ds": { "format": "depth32float-stencil8", "clear": { "depth": 1, "stencil": 1 } },
        "source": { "format": "rgba8unorm", "texels": { "kind": "columns", "values": [
            [1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],[1,2,3,4],
            [9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4],[9,2,3,4]] } } },
    "passes": [
        { "color": ["color"], "depth_stencil": "ds", "draws": [
            { "mesh": { "kind": "columns", "values": [0, 0.5, 1] }, "shader": "flat_color_depth",
              "params": { "color": [0, 1, 0, 0.5] }, "depth": { "compare": "less", "write": true },
              "blend": { "color": { "operation": "add", "src_factor": "one", "dst_factor": "one" },
                         "alpha": { "operation": "max", "src_factor": "one", "dst_factor": "one" } },
              "stencil": { "front": { "compare": "always", "pass_op": "increment-clamp" } } } ] },
        { "color": ["color"], "draws": [
            { "mesh": { "kind": "rect", "texels": [2, 3, 7, 9] }, "shader": "texel_color", "textures": ["source"],
              "blend": { "color": { "operation": "add", "src_factor": "one", "dst_factor": "one" },
                         "alpha": { "operation": "add", "src_factor": "one", "dst_factor": "one" } } } ] },
        { "depth_stencil": "ds", "draws": [
            { "mesh": { "kind": "full" }, "shader": "uniform_color",
              "stencil": { "front": { "compare": "equal", "pass_op": "increment-clamp", "reference": 2 } } } ] } ],
    "read": ["color", "ds", "source"] }"#;

#[test]
fn a_second_submit_gives_the_same_frame() {
    let backend = backend(true);
    let scene = scene(BUSY);
    let mut prepared = backend.prepare(&scene).unwrap();
    prepared.submit().unwrap();
    let first = prepared.read_back().unwrap();
    assert_eq!(prepared.read_back().unwrap(), first);
    for _ in 0..3 {
        let time = prepared.submit().unwrap();
        assert!(time.cpu <= time.wall);
        if let Some(gpu) = time.gpu {
            // Two clocks; this holds the unit.
            assert!(gpu <= 2 * time.wall, "{time:?}");
        }
    }
    assert_eq!(prepared.read_back().unwrap(), first);
    drop(prepared);
    // From reused images and buffers too.
    assert_eq!(draw(&backend, &scene), first);
    assert_eq!(backend.messages(), Vec::<String>::new());
}

#[test]
fn prepared_scenes_do_not_disturb_each_other() {
    let backend = backend(true);
    let one = scene(BUSY);
    let other = scene(&BUSY.replace("[0.5, 0, 0, 0.5]", "[0, 0, 1, 1]"));
    let (due_one, due_other) = (draw(&backend, &one), draw(&backend, &other));
    assert_ne!(due_one, due_other);
    let mut a = backend.prepare(&one).unwrap();
    let mut b = backend.prepare(&other).unwrap();
    a.submit().unwrap();
    b.submit().unwrap();
    a.submit().unwrap();
    assert_eq!(b.read_back().unwrap(), due_other);
    assert_eq!(a.read_back().unwrap(), due_one);
    drop(a);
    b.submit().unwrap();
    assert_eq!(b.read_back().unwrap(), due_other);
    drop(b);
    assert_eq!(backend.messages(), Vec::<String>::new());
}

#[test]
fn reading_before_drawing_is_an_error() {
    let backend = backend(false);
    let scene = scene(BUSY);
    let mut prepared = backend.prepare(&scene).unwrap();
    let error = prepared.read_back().unwrap_err();
    assert!(matches!(error, BackendError::Internal(_)), "{error}");
}

#[test]
fn what_the_limits_deny_is_not_supported() {
    let backend = backend(false);
    let mut scene = scene(BUSY);
    let size = backend.limits().max_size + 1;
    scene.attachments[0].size = [size, 1];
    let error = backend.prepare(&scene).map(|_| ()).unwrap_err();
    let due = BackendError::NotSupported(Requirement::Size(size));
    assert_eq!(error, due);
}

#[test]
fn limits_tell_what_the_device_has() {
    let backend = backend(false);
    let limits = backend.limits();
    assert_eq!(limits.api, Api::Vulkan);
    // Vulkan, Required Limits.
    assert!(limits.sub_pixel_bits >= 4);
    assert!(limits.max_size >= 4096);
    assert_eq!(limits.sample_positions[&1], [[128, 128]]);
    assert!(limits.max_color_attachments >= 4);
    let is_lavapipe = backend.adapter().name == "vulkan:lavapipe";
    for format in TextureFormat::ALL {
        let Some(support) = limits.formats.get(&format) else {
            assert!(!is_lavapipe, "lavapipe lacks {format}");
            continue;
        };
        assert!(matches!(support.samples[..], [] | [1, ..]), "{format}");
        assert!(!is_lavapipe || support.samples.first() == Some(&1));
        assert!(format.is_color() || !support.blendable);
        assert_eq!(support.read, ReadPath::Copy);
        assert_eq!(support.depth.len(), usize::from(format.has_depth()));
        assert!(
            support
                .depth
                .iter()
                .all(|d| format.depth_encodings().contains(d))
        );
    }
    // What Vulkan has without asking, and what lavapipe has besides.
    for feature in Feature::ALL {
        let always = matches!(
            feature,
            Feature::ReversedDepthRange | Feature::TriangleFans | Feature::RasterizerDiscard
        );
        if always || (is_lavapipe && feature != Feature::DepthBounds) {
            assert!(limits.features.contains(&feature), "{}", feature.name());
        }
    }
}

#[test]
fn adapters_are_named_by_their_drivers() {
    let adapters = enumerate().expect("these tests need a Vulkan driver");
    for adapter in &adapters {
        assert!(adapter.name.len() > "vulkan:".len() && adapter.name.starts_with("vulkan:"));
        assert_eq!(adapter.backend, "vulkan");
        assert!(!adapter.driver_id.is_empty());
    }
}

#[test]
fn a_device_that_is_not_there_is_unavailable() {
    let options = Options {
        device: 1000,
        validate: false,
    };
    let error = open("vulkan:none", &options).map(|_| ()).unwrap_err();
    assert!(error.reason.contains("1000"), "{error}");
}

#[test]
fn every_quick_case_is_drawn() {
    draw_built_in(&backend(false), Profile::Quick, usize::MAX);
}

/// The layer is slow, so it sees up to 12 cases of every file, spread over its axes.
#[test]
fn the_validation_layer_keeps_quiet_about_every_case_file() {
    draw_built_in(&backend(true), Profile::Full, 12);
}

/// The whole way for so many cases of each file that is compiled in.
fn draw_built_in(backend: &VulkanBackend, profile: Profile, most: usize) {
    let library = Library::built_in().unwrap();
    let mut drawn = 0;
    let chosen = library.files().iter().flat_map(|file| {
        let cases: Vec<_> = file.cases(profile).collect();
        let step = cases.len().div_ceil(most);
        cases.into_iter().step_by(step)
    });
    for case in chosen {
        let case = case.build().unwrap();
        let requirements = case.scene.requirements();
        if backend.limits().missing(&requirements).is_some() {
            continue;
        }
        let result = backend.prepare(&case.scene).and_then(|mut prepared| {
            prepared.submit()?;
            prepared.read_back()
        });
        let frame = result.unwrap_or_else(|e| panic!("{}: {e}", case.id));
        check_shape(&case.scene, &frame);
        assert_eq!(backend.messages(), Vec::<String>::new(), "{}", case.id);
        drawn += 1;
    }
    assert!(drawn > 0, "no built-in case can be drawn");
}
