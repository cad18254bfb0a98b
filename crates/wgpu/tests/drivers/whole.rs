//! Every quick case, and what validation says of all that is drawn here.

use crate::scenes::{
    depth_formats_store_what_is_written, passes_keep_contents, stencil_without_depth,
    uploads_keep_their_orientation,
};
use crate::{capabilities, chains, counting, layers, samples, sampling, shaders};
use etalon_backend::Backend;
use etalon_case::{Library, Profile};
use etalon_frame::{Feature, Requirement};
use etalon_wgpu::WgpuBackend;

fn run_all(backend: &WgpuBackend) {
    let library = Library::built_in().expect("the built-in cases parse");
    let mut cases = Vec::new();
    for case in library.cases(Profile::Quick) {
        let case = case.build().expect("a built-in case builds");
        let requirements = case.scene.requirements();
        if backend.limits().missing(&requirements).is_none() {
            let two_sources = Requirement::Feature(Feature::DualSourceBlending);
            cases.push((requirements.contains(&two_sources), case));
        }
    }
    // After them wgpu's OpenGL leaves factors of a second source behind on all targets, and Mesa
    // drops a later draw to several of them.
    cases.sort_by_key(|(two_sources, _)| *two_sources);
    assert!(!cases.is_empty(), "no case can run");
    for (_, case) in cases {
        let result = backend.prepare(&case.scene).and_then(|mut prepared| {
            prepared.submit()?;
            prepared.read_back()
        });
        let frame = result.unwrap_or_else(|error| panic!("{}: {error}", case.id));
        let aspects = |i: &usize| case.scene.attachments[*i].format.aspects().len();
        let due: usize = case.scene.read.iter().map(aspects).sum();
        assert_eq!(frame.images.len(), due, "{}", case.id);
        let counters = case.scene.counters.len();
        assert_eq!(frame.counters.len(), counters, "{}", case.id);
        said_nothing(backend, &case.id.to_string());
    }
}

/// What wgpu 30 itself does wrong over Vulkan: it offers DEPTH_BIAS_CLAMP and does not enable the device's
/// depthBiasClamp.
const MISTAKES_OF_WGPU: [&str; 1] = ["VUID-VkGraphicsPipelineCreateInfo-pDynamicStates-00754"];

/// Nothing but what validation has to say, and nobody may have asked for it.
#[track_caller]
fn said_nothing(backend: &WgpuBackend, what: &str) {
    let mut messages = backend.messages();
    messages.retain(|m| !MISTAKES_OF_WGPU.iter().any(|known| m.contains(known)));
    assert!(messages.is_empty(), "{what}: {}", messages.join("\n"));
}

pub(crate) fn every_built_in_case_runs(backend: &WgpuBackend) {
    run_all(backend);
}

pub(crate) fn validation_is_clean(backend: &WgpuBackend) {
    said_nothing(backend, "opening the device");
    passes_keep_contents(backend);
    uploads_keep_their_orientation(backend);
    depth_formats_store_what_is_written(backend);
    stencil_without_depth(backend);
    said_nothing(backend, "scenes");
    capabilities::all(backend);
    said_nothing(backend, "capabilities");
    samples::all(backend);
    said_nothing(backend, "samples");
    counting::all(backend);
    said_nothing(backend, "counting");
    sampling::all(backend);
    said_nothing(backend, "sampling");
    chains::all(backend);
    said_nothing(backend, "chains");
    layers::all(backend);
    said_nothing(backend, "layers");
    shaders::every_shader_draws(backend);
    said_nothing(backend, "shaders");
    run_all(backend);
    capabilities::two_sources(backend);
    said_nothing(backend, "two sources");
}
