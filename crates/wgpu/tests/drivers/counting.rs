//! Counters of each kind, and tests before the shader, drawn where the limits offer them.

use crate::harness::{assert_texels, frame, has, image, value};
use etalon_backend::{Backend, BackendError};
use etalon_frame::{Aspect, Feature, Requirement};
use etalon_wgpu::WgpuBackend;

const RED: [u32; 4] = [255, 0, 0, 255];
const BLUE: [u32; 4] = [0, 0, 255, 255];

pub(crate) fn all(backend: &WgpuBackend) {
    any_sample_that_passes(backend);
    runs_are_counted(backend);
    shader_invocations(backend);
    three_counters_of_one_draw(backend);
    tests_before_the_shader(backend);
    promised_depths(backend);
}

pub(crate) fn any_sample_that_passes(backend: &WgpuBackend) {
    let draw = |texels: &str, compare: &str, counter: &str| {
        format!(
            r#"{{"mesh": {{"kind": "rect", "texels": {texels}, "z": 0.5}}, "shader": "flat_color",
                "depth": {{"compare": "{compare}", "write": false}}, "counters": [{counter}]}}"#
        )
    };
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 8]}},
                                    "depth": {{"format": "depth32float", "clear": 1}} }},
                 "counters": {{"a": "any-samples-passed", "b": "any-samples-passed",
                               "c": "any-samples-passed", "d": "any-samples-passed"}},
                 "passes": [ {{"color": ["color"], "depth_stencil": "depth", "draws": [{}, {}, {}, {}]}},
                             {{"color": ["color"], "depth_stencil": "depth", "draws": [{}, {}]}} ],
                 "read": ["color"] }}"#,
            draw("[0, 0, 8, 8]", "greater", r#""a""#),
            draw("[5, 6, 6, 7]", "less", r#""b""#),
            draw("[0, 0, 8, 8]", "less", ""),
            draw("[0, 0, 8, 8]", "greater", r#""c""#),
            draw("[0, 0, 3, 3]", "less", r#""c""#),
            draw("[0, 0, 8, 8]", "equal", r#""a""#),
        ),
    );
    assert_eq!(frame.counters, [0, 1, 1, 0]);
}

pub(crate) fn samples_are_not_counted(backend: &WgpuBackend) {
    assert!(!has(backend, Feature::PreciseOcclusion));
    let scene = crate::harness::scene(
        r#"{ "attachments": { "color": {"format": "rgba8unorm"} },
             "counters": {"n": "samples-passed"},
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "full"}, "shader": "flat_color", "counters": ["n"]}]} ],
             "read": ["color"] }"#,
    );
    let due = Requirement::Feature(Feature::PreciseOcclusion);
    let error = backend.prepare(&scene).err();
    assert_eq!(error, Some(BackendError::NotSupported(due)));
}

pub(crate) fn runs_are_counted(backend: &WgpuBackend) {
    if !has(backend, Feature::StorageCounters) {
        return;
    }
    // Unless the tests are forced to be early, what they reject runs all the same.
    let draw = |texels: &str, shader: &str, more: &str| {
        format!(
            r#"{{"mesh": {{"kind": "rect", "texels": {texels}, "value": 0.5}}, "shader": "counted_{shader}",
                "params": {{"color": [1, 0, 0, 1]}}, "depth": {{"compare": "never", "write": true}}, {more}}}"#
        )
    };
    let frame = frame(
        backend,
        &format!(
            r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [8, 8]}},
                                    "depth": {{"format": "depth32float", "clear": 1}},
                                    "source": {{"format": "rgba8unorm", "texels": {{"kind": "columns", "values":
                                        [[0, 0, 0, 0], [0, 0, 0, 255], [0, 0, 0, 0], [0, 0, 0, 255],
                                         [0, 0, 0, 0], [0, 0, 0, 255], [0, 0, 0, 0], [0, 0, 0, 255]]}}}} }},
                 "counters": {{"a": "shader-runs", "b": "shader-runs", "c": "shader-runs"}},
                 "passes": [ {{"color": ["color"], "depth_stencil": "depth", "draws": [{}, {}, {}]}},
                             {{"color": ["color"], "depth_stencil": "depth", "draws": [{}]}} ],
                 "read": ["color"] }}"#,
            draw("[0, 0, 3, 2]", "color", r#""counters": ["b"]"#),
            draw("[2, 1, 8, 4]", "depth", r#""counters": ["a"]"#),
            draw(
                "[0, 0, 8, 8]",
                "discard",
                r#""textures": ["source"], "counters": ["c"]"#
            ),
            draw("[7, 7, 8, 8]", "color", r#""counters": ["b"]"#),
        ),
    );
    assert_eq!(frame.counters, [18, 7, 64]);
}

pub(crate) fn shader_invocations(backend: &WgpuBackend) {
    if !has(backend, Feature::FragmentInvocations) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8]} },
             "counters": {"none": "fragment-invocations", "some": "fragment-invocations"},
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "cover", "uv": [0, 0, 1, 1]}, "shader": "flat_color", "counters": ["some"]},
                 {"mesh": {"kind": "cover", "uv": [0, 0, 1, 1]}, "shader": "flat_color", "cull": "front",
                  "counters": ["none"]},
                 {"mesh": {"kind": "cover", "uv": [0, 0, 1, 1]}, "shader": "flat_color", "counters": ["some"]}]} ],
             "read": ["color"] }"#,
    );
    let [none, some] = frame.counters[..] else {
        panic!("two counters are due")
    };
    // Helpers may count too.
    assert_eq!(none, 0);
    assert!((128..=512).contains(&some), "{some}");
}

pub(crate) fn three_counters_of_one_draw(backend: &WgpuBackend) {
    if !has(backend, Feature::FragmentInvocations) || !has(backend, Feature::StorageCounters) {
        return;
    }
    let frame = frame(
        backend,
        r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [8, 8]} },
             "counters": {"passed": "any-samples-passed", "runs": "shader-runs", "statistics": "fragment-invocations"},
             "passes": [ {"color": ["color"], "draws": [
                 {"mesh": {"kind": "cover", "uv": [0, 0, 1, 1]}, "shader": "counted_color",
                  "counters": ["passed", "runs", "statistics"]}]} ],
             "read": ["color"] }"#,
    );
    let [passed, runs, statistics] = frame.counters[..] else {
        panic!("three counters are due")
    };
    assert_eq!([passed, runs], [1, 64]);
    assert!((64..=256).contains(&statistics), "{statistics}");
}

/// A discarded fragment writes its depth when the test came before the shader, and a rejected one
/// does not run it.
pub(crate) fn tests_before_the_shader(backend: &WgpuBackend) {
    if !has(backend, Feature::ForcedEarlyTests) {
        return;
    }
    for (tests, early) in [("implicit", false), ("forced", true)] {
        let scene = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1]},
                              "ds": {"format": "depth32float-stencil8", "clear": {"depth": 1, "stencil": 3}},
                              "source": {"format": "rgba8unorm", "texels": {"kind": "columns", "values":
                                  [[255, 0, 0, 255], [255, 0, 0, 255], [255, 0, 0, 0], [255, 0, 0, 0]]}} },
             "passes": [ {"color": ["color"], "depth_stencil": "ds", "draws": [
                 {"mesh": {"kind": "full", "z": 0.5}, "shader": "texel_discard", "textures": ["source"],
                  "params": {"color": [0, 0, 0, 0.5]}, "early_tests": "TESTS",
                  "depth": {"compare": "less", "write": true},
                  "stencil": {"front": {"compare": "always", "pass_op": "increment-wrap"}}}]} ],
             "read": ["color", "ds"] }"#;
        let frame = frame(backend, &scene.replace("TESTS", tests));
        let color = image(&frame, "color", Aspect::Color);
        assert_texels(color, |x, _| if x < 2 { RED } else { BLUE });
        let depth = image(&frame, "ds", Aspect::Depth);
        let stencil = image(&frame, "ds", Aspect::Stencil);
        for x in 0..4 {
            let tested = x < 2 || early;
            let due = if tested { (0.5, 4) } else { (1.0, 3) };
            let came = (value(depth, x, 1), stencil.sample(x, 1, 0)[0]);
            assert_eq!(came, due, "{tests}, column {x}");
        }
    }
    if !has(backend, Feature::StorageCounters) {
        return;
    }
    // A written depth of 0 would pass where the fragment's own does not; it is ignored.
    for (tests, runs) in [("implicit", 16), ("forced", 8)] {
        let scene = r#"{ "attachments": { "color": {"format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 1, 1]},
                              "depth": {"format": "depth32float", "clear": 0.5} },
             "counters": {"runs": "shader-runs"},
             "passes": [ {"color": ["color"], "depth_stencil": "depth", "draws": [
                 {"mesh": {"kind": "columns", "values": [0, 0], "z": [0.25, 0.75]}, "shader": "counted_depth",
                  "params": {"color": [1, 0, 0, 1]}, "early_tests": "TESTS", "counters": ["runs"],
                  "depth": {"compare": "less", "write": true}}]} ],
             "read": ["color", "depth"] }"#;
        let frame = frame(backend, &scene.replace("TESTS", tests));
        assert_eq!(frame.counters, [runs], "{tests}");
        let forced = tests == "forced";
        let color = image(&frame, "color", Aspect::Color);
        assert_texels(color, |x, _| if x < 2 || !forced { RED } else { BLUE });
        let depth = image(&frame, "depth", Aspect::Depth);
        let due = if forced { [0.25, 0.5] } else { [0.0, 0.0] };
        assert_eq!([value(depth, 1, 2), value(depth, 2, 2)], due, "{tests}");
    }
}

/// Shaders that keep what they promise of their depth write it as others do.
pub(crate) fn promised_depths(backend: &WgpuBackend) {
    if !has(backend, Feature::ConservativeDepth) {
        return;
    }
    for (tests, shader, written) in [
        ("greater-equal", "flat_color_depth", 0.5),
        ("greater-equal", "flat_color_depth", 0.25),
        ("less-equal", "flat_color_depth", 0.125),
        ("unchanged", "frag_coord_depth", 0.25),
        ("unchanged", "flat_color_depth", 0.25),
    ] {
        let frame = frame(
            backend,
            &format!(
                r#"{{ "attachments": {{ "color": {{"format": "rgba8unorm", "size": [4, 4]}},
                                        "depth": {{"format": "depth32float", "clear": 1}},
                                        "alone": {{"format": "rgba8unorm"}} }},
                     "passes": [ {{"color": ["color"], "depth_stencil": "depth", "draws": [
                         {{"mesh": {{"kind": "full", "z": 0.25, "value": {written}}}, "shader": "{shader}",
                          "early_tests": "{tests}", "depth": {{"compare": "less", "write": true}}}}]}},
                                 {{"color": ["alone"], "draws": [
                         {{"mesh": {{"kind": "full", "z": 0.25, "value": 1}}, "shader": "frag_coord_depth",
                          "early_tests": "{tests}"}}]}} ],
                     "read": ["alone", "depth"] }}"#
            ),
        );
        let depth = image(&frame, "depth", Aspect::Depth);
        for x in 0..4 {
            assert_eq!(value(depth, x, 3), written, "{tests}");
        }
        assert_texels(image(&frame, "alone", Aspect::Color), |_, _| [255; 4]);
    }
}
