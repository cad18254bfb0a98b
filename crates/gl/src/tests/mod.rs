//! Checks of internals: the choices that a context makes, and drivers with capabilities disabled.

use crate::{GlBackend, GlOptions, Platform, Profile, Tuning, open_with};
use etalon_backend::{Backend, BackendError};
use etalon_conformance::{
    Defect, GALLIUM_INSTALL, KnownFaults, LLVMPIPE, SOFTPIPE, SOFTPIPE_CLEARS, SOFTPIPE_WRONG,
    TestedDriver, ZINK, in_child, json, known, run_all, scene, variables,
};
use etalon_frame::{Feature, Requirement};

/// Returns the contexts of a driver, core profile first.
fn contexts(driver: &str, clip_control: bool) -> [GlBackend; 2] {
    [Profile::Core, Profile::Es].map(|profile| {
        let options = GlOptions {
            profile,
            platform: Platform::Surfaceless,
            library: None,
            debug: true,
            fault: None,
            record: false,
        };
        let backend = open_with("gl:test", &options, Tuning { clip_control })
            .unwrap_or_else(|e| panic!("{driver} cannot be opened: {e} ({GALLIUM_INSTALL})"));
        let device = backend.adapter().device.to_lowercase();
        assert!(device.starts_with(driver), "{device} is not {driver}");
        assert_eq!(backend.context.caps.clip_control, clip_control);
        backend
    })
}

/// Runs every check without `glClipControl`. The vertex shader adapts instead.
fn without_clip_control(driver: &str, defects: &'static [&'static [Defect]]) {
    for backend in &contexts(driver, false) {
        let prefix = if backend.context.caps.es {
            "gl:es"
        } else {
            "gl"
        };
        let described = TestedDriver {
            known: KnownFaults {
                defects,
                ..known(&format!("{prefix}:{driver}"))
            },
            environment: Vec::new(),
            open: |_| unreachable!("it is open"),
            tolerated: &[],
        };
        run_all(backend, &described);
    }
}

#[test]
fn llvmpipe_draws_right_without_clip_control() {
    let test = "tests::llvmpipe_draws_right_without_clip_control";
    in_child(test, &variables(LLVMPIPE), || {
        without_clip_control("llvmpipe", &[]);
    });
}

#[test]
fn softpipe_draws_as_described_without_clip_control() {
    let test = "tests::softpipe_draws_as_described_without_clip_control";
    in_child(test, &variables(SOFTPIPE), || {
        without_clip_control("softpipe", &[SOFTPIPE_WRONG, SOFTPIPE_CLEARS]);
    });
}

/// Checks that the limits follow from the context. The drivers' descriptions cover the other features.
fn features(backend: &GlBackend) {
    let caps = &backend.context.caps;
    let has = |feature| backend.limits().features.contains(&feature);
    assert_eq!(has(Feature::PreciseOcclusion), !caps.es);
    assert_eq!(has(Feature::FragmentInvocations), !caps.es);
    assert!(has(Feature::ForcedEarlyTests));
    // ES needs an extension for it.
    assert!(caps.es || caps.conservative_depth);
    assert_eq!(has(Feature::ConservativeDepth), caps.conservative_depth);
}

/// Without viewport arrays, GL takes integers.
fn a_viewport_between_texels_is_drawn_with_viewport_arrays(backend: &GlBackend) {
    let has_arrays = backend.context.entry_points.viewport_indexed.is_some();
    let between = scene(json!({
        "attachments": { "color": { "format": "rgba8unorm", "clear": [0, 0, 1, 1] } },
        "passes": [{ "color": ["color"], "draws": [{
            "mesh": { "kind": "full" }, "shader": "uniform_color",
            "viewport": { "rect": [0, 0, 8.5, 16], "depth": [0, 1] } }] }],
        "read": ["color"],
    }));
    let refused = backend.prepare(&between).err();
    let lacks = Requirement::Feature(Feature::FractionalViewport);
    let is_refused = matches!(refused, Some(BackendError::NotSupported(needed)) if needed == lacks);
    assert_ne!(is_refused, has_arrays);
}

/// Debug output must report errors: otherwise its silence elsewhere proves nothing.
fn a_planted_mistake_is_told(backend: &GlBackend) {
    backend.context.make_current().expect("it becomes current");
    assert_eq!(backend.messages(), Vec::<String>::new());
    // SAFETY: the context is current; the call is a mistake that GL defines.
    unsafe { glow::HasContext::enable(&backend.context.gl, 0xFFFF) };
    let messages = backend.messages();
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].starts_with("error "), "{messages:?}");
    assert!(backend.context.check("the mistake").is_err());
    assert_eq!(backend.messages(), Vec::<String>::new());
}

fn insides(driver: &str) {
    for backend in contexts(driver, true) {
        features(&backend);
        a_viewport_between_texels_is_drawn_with_viewport_arrays(&backend);
        a_planted_mistake_is_told(&backend);
    }
}

#[test]
fn llvmpipe_passes_checks_of_features_viewports_and_mistakes() {
    let test = "tests::llvmpipe_passes_checks_of_features_viewports_and_mistakes";
    in_child(test, &variables(LLVMPIPE), || insides("llvmpipe"));
}

#[test]
fn softpipe_passes_checks_of_features_viewports_and_mistakes() {
    let test = "tests::softpipe_passes_checks_of_features_viewports_and_mistakes";
    in_child(test, &variables(SOFTPIPE), || insides("softpipe"));
}

#[test]
fn zink_passes_checks_of_features_viewports_and_mistakes() {
    let test = "tests::zink_passes_checks_of_features_viewports_and_mistakes";
    in_child(test, &variables(ZINK), || insides("zink"));
}
