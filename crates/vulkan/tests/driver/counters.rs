//! Counters: occlusion queries, runs of shaders, statistics; and when the tests before them happen.

use crate::common::{BLACK, RED, backend, check, draw_if_there, image, scene};
use etalon_backend::Backend;
use etalon_frame::{Aspect, Feature};
use etalon_scene::Scene;

const RED_PARAMS: &str = r#""params": { "color": [1, 0, 0, 1] }"#;
/// The left half lies before the cleared depth, the right half behind it.
const HALVES: &str = r#""mesh": { "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] },
    "depth": { "compare": "less", "write": true }"#;

/// A scene of draws into colour and a depth of 0.5, with counters as the insides of their JSON.
fn counted(counters: &str, draws: &str) -> Scene {
    let (red, none) = ("[255, 0, 0, 255]", "[0, 0, 0, 0]");
    scene(&format!(
        r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm" }},
                "depth": {{ "format": "depth32float", "clear": 0.5 }},
                "half": {{ "format": "rgba8unorm", "texels": {{ "kind": "columns", "values": [
                    {red}, {red}, {red}, {red}, {red}, {red}, {red}, {red},
                    {none}, {none}, {none}, {none}, {none}, {none}, {none}, {none}] }} }} }},
            "passes": [ {{ "color": ["color"], "depth_stencil": "depth", "draws": [ {draws} ] }} ],
            "read": ["color", "depth"], "counters": {{ {counters} }} }}"#
    ))
}

/// Holds the counters of a scene to be these, in ascending order of their names.
#[track_caller]
fn check_counters(scene: &Scene, due: &[u64]) {
    if let Some(counters) = counters(scene) {
        assert_eq!(counters, due);
    }
}

/// Draws a scene and gives its counters.
fn counters(scene: &Scene) -> Option<Vec<u64>> {
    draw_if_there(&backend(true), scene).map(|frame| frame.counters)
}

#[test]
fn samples_that_pass_are_counted_over_the_draws_that_ask() {
    let draw = |counters: &str| {
        format!(r#"{{ {HALVES}, "shader": "uniform_color", "counters": [{counters}] }}"#)
    };
    // What passes the first draw stops the second.
    let scene = counted(
        r#""a": "samples-passed", "b": "samples-passed", "unused": "samples-passed""#,
        &[draw(r#""a""#), draw(r#""b""#), draw("")].join(","),
    );
    check_counters(&scene, &[128, 0, 0]);
    let again = r#"{ "mesh": { "kind": "rect", "texels": [1, 2, 4, 7] }, "shader": "uniform_color",
        "counters": ["a"], "write_mask": "" }"#;
    let scene = counted(
        r#""a": "samples-passed""#,
        &[draw(r#""a""#), again.to_owned(), again.to_owned()].join(","),
    );
    check_counters(&scene, &[128 + 2 * 15]);
}

#[test]
fn each_sample_counts_by_itself() {
    for (mask, due) in [(15, 1024), (5, 512), (0, 0)] {
        let scene = scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "samples": 4 }} }},
                "passes": [ {{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "cover" }},
                    "shader": "uniform_color", "counters": ["n"], "multisample": {{ "mask": {mask} }} }} ] }} ],
                "read": ["color"], "counters": {{ "n": "samples-passed" }} }}"#
        ));
        check_counters(&scene, &[due]);
    }
}

#[test]
fn an_imprecise_query_tells_any_from_none() {
    let draw = |counters: &str, compare: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "full", "z": 0.25 }}, "shader": "uniform_color",
                "counters": [{counters}], "depth": {{ "compare": "{compare}", "write": false }} }}"#
        )
    };
    let scene = counted(
        r#""both": "any-samples-passed", "none": "any-samples-passed", "one": "any-samples-passed""#,
        &[
            draw(r#""both""#, "less"),
            draw(r#""none""#, "greater"),
            draw(r#""one""#, "greater"),
            draw(r#""both""#, "less"),
            draw(r#""one""#, "less"),
        ]
        .join(","),
    );
    check_counters(&scene, &[1, 0, 1]);
}

/// Storage writes happen although the test then fails, unless the test is forced to come first.
#[test]
fn forced_tests_come_before_the_shader() {
    for (early, runs) in [("implicit", 256), ("forced", 128)] {
        let scene = counted(
            r#""passed": "samples-passed", "runs": "shader-runs""#,
            &format!(
                r#"{{ {HALVES}, "shader": "counted_color", {RED_PARAMS}, "early_tests": "{early}",
                    "counters": ["runs", "passed"] }}"#
            ),
        );
        let Some(frame) = draw_if_there(&backend(true), &scene) else {
            return;
        };
        assert_eq!(frame.counters, [128, runs], "{early}");
        check(image(&frame, "color", Aspect::Color), |x, _| {
            if x < 8 { RED } else { BLACK }.to_vec()
        });
    }
}

/// What is discarded has its depth written all the same where the tests come first.
#[test]
fn discarded_fragments_have_been_tested_where_tests_are_forced() {
    for (shader, early, behind) in [
        ("texel_discard", "implicit", 0.5_f32),
        ("texel_discard", "forced", 0.25),
        ("counted_discard", "implicit", 0.5),
        ("counted_discard", "forced", 0.25),
    ] {
        let counts = shader.starts_with("counted");
        let scene = counted(
            if counts { r#""n": "shader-runs""# } else { "" },
            &format!(
                r#"{{ "mesh": {{ "kind": "full", "z": 0.25 }}, "shader": "{shader}", "textures": ["half"],
                    "params": {{ "color": 0.5 }}, "early_tests": "{early}", "counters": [{}],
                    "depth": {{ "compare": "less", "write": true }} }}"#,
                if counts { r#""n""# } else { "" }
            ),
        );
        let Some(frame) = draw_if_there(&backend(true), &scene) else {
            return;
        };
        assert_eq!(frame.counters, vec![256; usize::from(counts)]);
        check(image(&frame, "color", Aspect::Color), |x, _| {
            if x < 8 { RED } else { BLACK }.to_vec()
        });
        check(image(&frame, "depth", Aspect::Depth), |x, _| {
            vec![if x < 8 { 0.25 } else { behind }.to_bits()]
        });
    }
}

/// A forced early test takes the fragment's own depth, not the shader's.
#[test]
fn a_forced_test_knows_nothing_of_the_written_depth() {
    let scene = counted(
        r#""runs": "shader-runs""#,
        &format!(
            r#"{{ "mesh": {{ "kind": "full", "z": 0.25, "value": 0.125 }}, "shader": "counted_depth", {RED_PARAMS},
                "early_tests": "forced", "counters": ["runs"], "depth": {{ "compare": "less", "write": true }} }}"#
        ),
    );
    let Some(frame) = draw_if_there(&backend(true), &scene) else {
        return;
    };
    assert_eq!(frame.counters, [256]);
    check(image(&frame, "depth", Aspect::Depth), |_, _| {
        vec![0.25_f32.to_bits()]
    });
}

/// Promises that are kept change nothing. Each column writes a depth of its own, against 0.5.
#[test]
fn kept_promises_about_depth_change_nothing() {
    for (promise, z, written) in [
        ("implicit", 0.25, [0.25, 0.75_f32]),
        ("greater_equal", 0.25, [0.25, 0.75]),
        ("less_equal", 0.75, [0.25, 0.75]),
        ("unchanged", 0.25, [0.25, 0.25]),
    ] {
        let promise = promise.replace('_', "-");
        for shader in ["flat_color_depth", "counted_depth"] {
            let counts = shader == "counted_depth";
            let scene = counted(
                if counts { r#""n": "shader-runs""# } else { "" },
                &format!(
                    r#"{{ "mesh": {{ "kind": "columns", "values": {written:?}, "z": [{z}] }}, "shader": "{shader}",
                        {RED_PARAMS}, "early_tests": "{promise}", "counters": [{}],
                        "depth": {{ "compare": "less", "write": true }} }}"#,
                    if counts { r#""n""# } else { "" }
                ),
            );
            let Some(frame) = draw_if_there(&backend(true), &scene) else {
                return;
            };
            let passes = |x: u32| written[x as usize / 8] < 0.5;
            check(image(&frame, "color", Aspect::Color), |x, _| {
                if passes(x) { RED } else { BLACK }.to_vec()
            });
            check(image(&frame, "depth", Aspect::Depth), |x, _| {
                let depth = if passes(x) {
                    written[x as usize / 8]
                } else {
                    0.5
                };
                vec![depth.to_bits()]
            });
            assert_eq!(frame.counters, vec![256; usize::from(counts)], "{promise}");
        }
    }
}

/// Statistics need not be exact, but nothing can run that is not rasterized, and what counts itself
/// has run.
#[test]
fn statistics_tell_that_shaders_ran() {
    let draw = |scissor: &str, counter: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "full" }}, "shader": "counted_color", "scissor": {scissor},
                "counters": ["runs", "{counter}"] }}"#
        )
    };
    let scene = counted(
        r#""none": "fragment-invocations", "runs": "shader-runs", "some": "fragment-invocations""#,
        &[
            draw("[0, 0, 16, 16]", "some"),
            draw("[0, 0, 0, 0]", "none"),
            draw("[0, 0, 16, 8]", "some"),
        ]
        .join(","),
    );
    let Some(counters) = counters(&scene) else {
        return;
    };
    assert_eq!(counters[..2], [0, 384]);
    assert!((384..2 * 384).contains(&counters[2]), "{counters:?}");
}

/// All kinds at once, over two passes, drawn again and again, beside another scene of more draws.
#[test]
fn counters_start_from_0_at_every_submit() {
    let backend = backend(true);
    let draw = r#"{ "mesh": { "kind": "full" }, "shader": "counted_color", "counters": ["runs", "passed", "run"] }"#;
    let text = |draws: usize| {
        let pass = format!(
            r#"{{ "color": ["color"], "draws": [ {} ] }}"#,
            vec![draw; draws].join(",")
        );
        format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm" }} }}, "passes": [ {pass}, {pass} ],
                "read": ["color"], "counters": {{ "passed": "samples-passed", "run": "fragment-invocations",
                "runs": "shader-runs" }} }}"#
        )
    };
    let (few, many) = (scene(&text(1)), scene(&text(20)));
    let needed = [
        Feature::StorageCounters,
        Feature::FragmentInvocations,
        Feature::PreciseOcclusion,
    ];
    if draw_if_there(&backend, &few).is_none() {
        let has = |f| backend.limits().features.contains(f);
        assert!(!needed.iter().all(has));
        return;
    }
    let mut a = backend.prepare(&few).unwrap();
    let mut b = backend.prepare(&many).unwrap();
    for _ in 0..3 {
        a.submit().unwrap();
        b.submit().unwrap();
        for (prepared, draws) in [(&mut a, 2), (&mut b, 40)] {
            let counters = prepared.read_back().unwrap().counters;
            let [passed, invoked, runs] = counters[..] else {
                panic!("{counters:?}");
            };
            assert_eq!([passed, runs], [draws * 256; 2]);
            assert!((draws * 256..draws * 512).contains(&invoked), "{invoked}");
        }
    }
    drop((a, b));
    assert_eq!(backend.messages(), Vec::<String>::new());
}
