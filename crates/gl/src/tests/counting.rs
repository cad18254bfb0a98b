//! Counters, discarded fragments and fragment tests before the shader.

use super::help::{CLEAR, RED, SIZE, draw, each};
use crate::GlBackend;
use etalon_backend::Backend;
use etalon_frame::{Feature, Frame};

pub(super) fn all(backend: &GlBackend) {
    features_are_as_the_drivers_have_them(backend);
    any_samples_are_told(backend);
    if has(backend, Feature::PreciseOcclusion) {
        samples_are_counted(backend);
    }
    if has(backend, Feature::FragmentInvocations) {
        invocations_are_counted(backend);
    }
    if has(backend, Feature::StorageCounters) {
        runs_are_counted(backend);
        counters_of_all_kinds_go_together(backend);
    }
    for early in ["implicit", "forced"] {
        discarded_fragments_leave_nothing_but_early_depth(backend, early);
    }
    if has(backend, Feature::ConservativeDepth) {
        depths_are_written_as_promised(backend);
    }
}

fn has(backend: &GlBackend, feature: Feature) -> bool {
    backend.limits().features.contains(&feature)
}

fn features_are_as_the_drivers_have_them(backend: &GlBackend) {
    let caps = &backend.context.caps;
    let softpipe = backend
        .adapter()
        .device
        .to_lowercase()
        .starts_with("softpipe");
    assert_eq!(has(backend, Feature::PreciseOcclusion), !caps.es);
    assert_eq!(has(backend, Feature::FragmentInvocations), !caps.es);
    // Its core profile is too old for storage buffers.
    assert_eq!(has(backend, Feature::StorageCounters), caps.es || !softpipe);
    assert!(has(backend, Feature::ForcedEarlyTests));
    // In ES it takes an extension.
    assert!(caps.es || caps.conservative_depth);
    let conservative = has(backend, Feature::ConservativeDepth);
    assert_eq!(conservative, caps.conservative_depth);
    assert!(!has(backend, Feature::MirroredViewport));
}

/// Draws over blue and over a depth of a half.
fn counted(backend: &GlBackend, counters: &str, draws: &str) -> Frame {
    draw(
        backend,
        &format!(
            r#"{{"attachments": {{
                "c": {{"format":"rgba8unorm","size":[16,16],"clear":[0,0,1,1]}},
                "d": {{"format":"depth32float","clear":0.5}},
                "t": {{"format":"rgba8unorm","texels":{{"kind":"columns","values":[
                    [255,0,0,0],[255,0,0,0],[255,0,0,0],[255,0,0,0],
                    [255,0,0,0],[255,0,0,0],[255,0,0,255],[255,0,0,255],
                    [255,0,0,255],[255,0,0,255],[255,0,0,255],[255,0,0,255],
                    [255,0,0,255],[255,0,0,255],[255,0,0,255],[255,0,0,255]]}}}}}},
            "passes": [{{"color":["c"],"depth_stencil":"d","draws":[{draws}]}}],
            "read": ["c","d"],
            "counters": {counters}}}"#
        ),
    )
}

/// A rectangle of 15 texels, in front of what is stored or behind it.
fn corner(front: bool, shader: &str, more: &str) -> String {
    let z = if front { 0.25 } else { 0.75 };
    format!(
        r#"{{"mesh":{{"kind":"rect","texels":[0,0,5,3],"z":{z}}},"shader":"{shader}",
            "params":{{"color":[1,0,0,1]}},"depth":{{"compare":"less","write":false}}{more}}}"#
    )
}

fn any_samples_are_told(backend: &GlBackend) {
    let by = |name: &str| format!(r#","counters":["{name}"]"#);
    let draws = [
        corner(true, "uniform_color", &by("a")),
        corner(false, "uniform_color", &by("b")),
        corner(false, "uniform_color", &by("c")),
        corner(true, "uniform_color", ""),
        corner(true, "uniform_color", &by("a")),
        corner(true, "uniform_color", &by("c")),
    ];
    let any = r#"{"a":"any-samples-passed","b":"any-samples-passed","c":"any-samples-passed",
        "d":"any-samples-passed"}"#;
    assert_eq!(
        counted(backend, any, &draws.join(",")).counters,
        [1, 0, 1, 0]
    );
}

fn samples_are_counted(backend: &GlBackend) {
    let by = |name: &str| format!(r#","counters":["{name}"]"#);
    let draws = [
        corner(true, "uniform_color", &by("a")),
        corner(false, "uniform_color", &by("b")),
        corner(true, "uniform_color", ""),
        corner(true, "uniform_color", &by("a")),
        corner(
            true,
            "uniform_color",
            &format!(r#"{},"scissor":[1,1,2,16]"#, by("c")),
        ),
    ];
    let passed = r#"{"a":"samples-passed","b":"samples-passed","c":"samples-passed"}"#;
    let frame = counted(backend, passed, &draws.join(","));
    assert_eq!(frame.counters, [30, 0, 4]);
}

fn invocations_are_counted(backend: &GlBackend) {
    let by = |name: &str| format!(r#","counters":["{name}"]"#);
    let draws = [
        corner(true, "uniform_color", &by("a")),
        corner(true, "uniform_color", &by("b")),
        corner(true, "uniform_color", &by("b")),
        corner(
            true,
            "uniform_color",
            &format!(r#"{},"rasterizer_discard":true"#, by("c")),
        ),
    ];
    let kinds = r#"{"a":"fragment-invocations","b":"fragment-invocations",
        "c":"fragment-invocations"}"#;
    let frame = counted(backend, kinds, &draws.join(","));
    println!("fragment invocations {:?}", frame.counters);
    let [one, two, none] = frame.counters[..] else {
        panic!("{:?}", frame.counters);
    };
    // Drivers may run the shader for texels beside the primitive.
    assert!(one >= 15);
    assert_eq!((two, none), (2 * one, 0));
}

fn runs_are_counted(backend: &GlBackend) {
    let by = |name: &str| format!(r#","early_tests":"forced","counters":["{name}"]"#);
    let draws = [
        corner(true, "counted_color", &by("a")),
        corner(false, "counted_color", &by("b")),
        corner(true, "counted_color", &by("c")),
        corner(true, "counted_color", &by("c")),
    ];
    let kinds = r#"{"a":"shader-runs","b":"shader-runs","c":"shader-runs"}"#;
    let frame = counted(backend, kinds, &draws.join(","));
    assert_eq!(frame.counters, [15, 0, 30]);
    each(&frame.images[0], |x, y| {
        if x < 5 && y < 3 { RED } else { CLEAR }.to_vec()
    });
}

fn counters_of_all_kinds_go_together(backend: &GlBackend) {
    let core =
        has(backend, Feature::PreciseOcclusion) && has(backend, Feature::FragmentInvocations);
    let (kinds, names) = if core {
        (
            r#"{"i":"fragment-invocations","p":"samples-passed","r":"shader-runs"}"#,
            r#"["i","p","r"]"#,
        )
    } else {
        (
            r#"{"p":"any-samples-passed","r":"shader-runs"}"#,
            r#"["p","r"]"#,
        )
    };
    let draws = format!(
        r#"{{"mesh":{{"kind":"full","z":0.25}},"shader":"counted_discard","textures":["t"],
            "params":{{"color":[0,0,0,0.5]}},"depth":{{"compare":"less","write":true}},
            "counters":{names}}}"#
    );
    let counters = counted(backend, kinds, &draws).counters;
    println!("counters of a draw that discards {counters:?}");
    if core {
        assert!(counters[0] >= 256);
        assert_eq!(counters[1..], [160, 256]);
    } else {
        assert_eq!(counters, [1, 256]);
    }
}

/// The first six columns are discarded; tests before the shader have by then stored their depth.
fn discarded_fragments_leave_nothing_but_early_depth(backend: &GlBackend, early: &str) {
    let draws = format!(
        r#"{{"mesh":{{"kind":"full","z":0.25}},"shader":"texel_discard","textures":["t"],
            "params":{{"color":[0,0,0,0.5]}},"depth":{{"compare":"less","write":true}},
            "early_tests":"{early}"}}"#
    );
    let frame = counted(backend, "{}", &draws);
    each(&frame.images[0], |x, _| {
        if x < 6 { CLEAR } else { RED }.to_vec()
    });
    each(&frame.images[1], |x, _| {
        let kept = x < 6 && early == "implicit";
        vec![if kept { 0.5_f32 } else { 0.25 }.to_bits()]
    });
}

fn depths_are_written_as_promised(backend: &GlBackend) {
    for (early, shader, z, written) in [
        ("greater-equal", "flat_color_depth", 0.125, 0.375),
        ("less-equal", "flat_color_depth", 0.75, 0.375),
        ("less-equal", "flat_color_depth", 0.375, 0.375),
        ("greater-equal", "flat_color_depth", 0.125, 0.625),
        ("unchanged", "frag_coord_depth", 0.25, 0.25),
        ("unchanged", "frag_coord_depth", 0.75, 0.75),
    ] {
        let draws = format!(
            r#"{{"mesh":{{"kind":"rect","texels":[0,0,{SIZE},8],"z":{z},"value":[{written},0,0,1]}},
                "shader":"{shader}","params":{{"color":[1,0,0,1]}},"early_tests":"{early}",
                "depth":{{"compare":"less","write":true}}}}"#
        );
        let frame = counted(backend, "{}", &draws);
        each(&frame.images[1], |_, y| {
            let stored: f32 = if y < 8 && written < 0.5 { written } else { 0.5 };
            vec![stored.to_bits()]
        });
    }
}
