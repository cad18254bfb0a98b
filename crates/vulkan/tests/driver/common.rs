//! What the tests share: an adapter, scenes from JSON, frames.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Profile};
use etalon_frame::{Aspect, Frame, Image};
use etalon_scene::Scene;
use etalon_vulkan::{Options, VulkanBackend, enumerate, open};

pub(crate) const RED: [u32; 4] = [255, 0, 0, 255];
pub(crate) const GREEN: [u32; 4] = [0, 255, 0, 255];
pub(crate) const BLACK: [u32; 4] = [0; 4];

/// Opens lavapipe, or the adapter that `ETALON_VULKAN_ADAPTER` names, with the validation layer
/// watching where asked for.
///
/// Without it a test fails: nothing would have been tested.
pub(crate) fn backend(validate: bool) -> VulkanBackend {
    let name = std::env::var("ETALON_VULKAN_ADAPTER").unwrap_or("vulkan:lavapipe".to_owned());
    let adapters = enumerate().unwrap_or_else(|e| panic!("these tests need {name}: {e}"));
    let names: Vec<_> = adapters.iter().map(|a| a.name.as_str()).collect();
    let Some(device) = names.iter().position(|n| *n == name) else {
        panic!(
            "these tests need {name}, and there is only {names:?}; apt-get install \
             mesa-vulkan-drivers, or name another in ETALON_VULKAN_ADAPTER"
        );
    };
    open(&name, &Options { device, validate }).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The scene of a case file's text around `"scene": …`.
pub(crate) fn scene(json: &str) -> Scene {
    let text = format!(r#"{{ "about": "A test.", "spec": [], "scene": {json} }}"#);
    let file = CaseFile::parse("t.json", &text).unwrap();
    let case = file.cases(Profile::Full).next().unwrap();
    case.build().unwrap().scene
}

/// A scene of attachments and passes, as the insides of their JSON, with everything named read back.
pub(crate) fn scene_of(attachments: &str, passes: &str, read: &[&str]) -> Scene {
    scene(&format!(
        r#"{{ "attachments": {{ {attachments} }}, "passes": [ {passes} ], "read": {read:?} }}"#
    ))
}

/// A scene of one draw, which may have more keys, into an `rgba8unorm` attachment `color` of 16 by
/// 16 texels, cleared to 0.
pub(crate) fn one_draw(draw: &str) -> Scene {
    scene_of(
        r#""color": { "format": "rgba8unorm", "clear": [0, 0, 0, 0] }"#,
        &format!(r#"{{ "color": ["color"], "draws": [ {{ {draw} }} ] }}"#),
        &["color"],
    )
}

/// Draws a scene once. What the adapter lacks is skipped with a word, except on lavapipe, which has
/// everything that these tests need but depth bounds: there it is a failure.
pub(crate) fn draw_if_there(backend: &VulkanBackend, scene: &Scene) -> Option<Frame> {
    if let Some(missing) = backend.limits().missing(&scene.requirements()) {
        let name = &backend.adapter().name;
        assert_ne!(name, "vulkan:lavapipe", "it lacks {missing}");
        eprintln!("not tested: {name} lacks {missing}");
        return None;
    }
    Some(draw(backend, scene))
}

/// Draws a scene once, and holds the validation layer, where it watches, to have said nothing.
#[track_caller]
pub(crate) fn draw(backend: &VulkanBackend, scene: &Scene) -> Frame {
    let mut prepared = backend.prepare(scene).unwrap();
    prepared.submit().unwrap();
    let frame = prepared.read_back().unwrap();
    check_shape(scene, &frame);
    drop(prepared);
    assert_eq!(backend.messages(), Vec::<String>::new());
    frame
}

/// Every image must be the one asked for, and whole.
pub(crate) fn check_shape(scene: &Scene, frame: &Frame) {
    let mut due = Vec::new();
    for index in &scene.read {
        let attachment = &scene.attachments[*index];
        for aspect in attachment.format.aspects() {
            due.push((attachment.name.clone(), *aspect));
        }
    }
    let came: Vec<_> = frame
        .images
        .iter()
        .map(|i| (i.attachment.clone(), i.aspect))
        .collect();
    assert_eq!(came, due);
    for image in &frame.images {
        assert_eq!(image.codes.len(), image.expected_len());
    }
    assert_eq!(frame.counters.len(), scene.counters.len());
}

/// The image of an attachment's aspect.
pub(crate) fn image<'a>(frame: &'a Frame, attachment: &str, aspect: Aspect) -> &'a Image {
    let found = frame
        .images
        .iter()
        .find(|i| i.attachment == attachment && i.aspect == aspect);
    found.unwrap_or_else(|| panic!("the frame has no {aspect} of {attachment}"))
}

/// Holds every texel of an image against what is due at its column and row.
#[track_caller]
pub(crate) fn check(image: &Image, due: impl Fn(u32, u32) -> Vec<u32>) {
    for y in 0..image.size[1] {
        for x in 0..image.size[0] {
            let due = due(x, y);
            for sample in 0..image.samples {
                let codes = image.sample(x, y, sample);
                assert_eq!(codes, due, "{} at ({x}, {y}), {sample}", image.aspect);
            }
        }
    }
}
