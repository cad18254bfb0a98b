//! Counters of each kind.

use super::CheckEnd;
use crate::frames::{Expect, NONE, RED};
use crate::scenes::{full, rect, red, scene, test, uploaded, with};
use crate::subject::{CheckedBackend, Missing};
use etalon_frame::{Feature, Frame};
use serde_json::{Value, json};

/// Draws to a colour attachment, and a depth attachment cleared to a half. The texture `half` has alpha 1
/// in the first ten columns.
pub(super) fn counted(
    s: &CheckedBackend,
    kinds: Value,
    draws: Vec<Value>,
) -> Result<Frame, Missing> {
    let half: Vec<_> = (0..16).map(|x| if x < 10 { RED } else { NONE }).collect();
    s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm" },
            "depth": { "format": "depth32float", "clear": 0.5 },
            "half": uploaded("columns", half) },
        "passes": [{ "color": ["color"], "depth_stencil": "depth", "draws": draws }],
        "read": ["color", "depth"],
        "counters": kinds,
    }))
}

/// Returns a rectangle of 15 texels, in front of or behind the stored depth, with its counters.
fn corner(front: bool, shader: &str, counters: &[&str]) -> Value {
    let z = if front { 0.25 } else { 0.75 };
    json!({ "mesh": { "kind": "rect", "texels": [0, 0, 5, 3], "z": z }, "shader": shader,
            "params": red(), "depth": test("less", false), "counters": counters })
}

/// Returns a draw whose left half is in front of the cleared depth, and whose right half is behind it.
pub(super) fn halves(shader: &str, counters: &[&str]) -> Value {
    json!({ "mesh": { "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] }, "shader": shader,
            "params": red(), "depth": test("less", true), "counters": counters })
}

fn counters_of(names: &[&str], kind: &str) -> Value {
    names.iter().map(|name| (*name, kind)).collect()
}

/// Asserts that `color` is red at the given texels, and cleared to 0 elsewhere.
#[track_caller]
pub(super) fn check_painted(frame: &Frame, red: impl Fn(u32, u32) -> bool) {
    frame.color_is("color", |x, y| if red(x, y) { RED } else { NONE });
}

/// Some draws pass, some fail, one has no counter, and one counter has no draw.
pub(crate) fn any_samples_that_pass_are_told(s: &CheckedBackend) -> CheckEnd {
    let draws = vec![
        corner(true, "uniform_color", &["a"]),
        corner(false, "uniform_color", &["b"]),
        corner(false, "uniform_color", &["c"]),
        corner(true, "uniform_color", &[]),
        corner(true, "uniform_color", &["a"]),
        corner(true, "uniform_color", &["c"]),
    ];
    let any = counters_of(&["a", "b", "c", "d"], "any-samples-passed");
    assert_eq!(counted(s, any, draws)?.counters, [1, 0, 1, 0]);
    Ok(())
}

/// Counts over two passes, and a single texel that passes.
pub(crate) fn any_samples_of_several_passes_are_told(s: &CheckedBackend) -> CheckEnd {
    let draw = |texels: [u32; 4], compare: &str, counters: &[&str]| {
        json!({ "mesh": { "kind": "rect", "texels": texels, "z": 0.5 }, "shader": "flat_color",
                "depth": test(compare, false), "counters": counters })
    };
    let frame = s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": [8, 8] },
            "depth": { "format": "depth32float", "clear": 1 } },
        "passes": [
            { "color": ["color"], "depth_stencil": "depth", "draws": [
                draw([0, 0, 8, 8], "greater", &["a"]),
                draw([5, 6, 6, 7], "less", &["b"]),
                draw([0, 0, 8, 8], "less", &[]),
                draw([0, 0, 8, 8], "greater", &["c"])] },
            { "color": ["color"], "depth_stencil": "depth", "draws": [
                draw([0, 0, 3, 3], "less", &["c"]),
                draw([0, 0, 8, 8], "equal", &["a"])] }],
        "counters": counters_of(&["a", "b", "c", "d"], "any-samples-passed"),
    }))?;
    assert_eq!(frame.counters, [0, 1, 1, 0]);
    Ok(())
}

pub(crate) fn samples_that_pass_are_counted(s: &CheckedBackend) -> CheckEnd {
    let precise = || counters_of(&["a", "b", "c"], "samples-passed");
    let scissored = json!({ "scissor": [1, 1, 2, 16] });
    let draws = vec![
        corner(true, "uniform_color", &["a"]),
        corner(false, "uniform_color", &["b"]),
        corner(true, "uniform_color", &[]),
        corner(true, "uniform_color", &["a"]),
        with(corner(true, "uniform_color", &["c"]), scissored),
    ];
    assert_eq!(counted(s, precise(), draws)?.counters, [30, 0, 4]);
    // The depths written by the first draw reject the second draw.
    let draws = [&["a"][..], &["b"], &[]].map(|names| halves("uniform_color", names));
    assert_eq!(counted(s, precise(), draws.to_vec())?.counters, [128, 0, 0]);
    // Samples count even if nothing is written.
    let again = json!({ "mesh": rect([1, 2, 4, 7]), "shader": "uniform_color", "counters": ["a"],
                        "write_mask": "" });
    let draws = vec![halves("uniform_color", &["a"]), again.clone(), again];
    let frame = counted(s, counters_of(&["a"], "samples-passed"), draws)?;
    assert_eq!(frame.counters, [128 + 2 * 15]);
    Ok(())
}

/// A query over three draws, one of them rejected, and over passes. In Vulkan, other commands within the
/// query can count too.
pub(crate) fn a_query_counts_what_it_encloses(s: &CheckedBackend) -> CheckEnd {
    let draws = || {
        [
            (true, "a"),
            (false, "a"),
            (true, "a"),
            (false, "b"),
            (false, "b"),
        ]
        .map(|(front, name)| corner(front, "uniform_color", &[name]))
    };
    let scene = |queries: &str, kind: &str, passes: usize| {
        json!({
            "attachments": {
                "color": { "format": "rgba8unorm" },
                "depth": { "format": "depth32float", "clear": 0.5 } },
            "passes": vec![json!({
                "color": ["color"], "depth_stencil": "depth",
                "draws": draws()[..if passes > 1 { 3 } else { 5 }] }); passes],
            "read": ["color"],
            "counters": counters_of(&["a", "b"], kind),
            "queries": queries,
        })
    };
    let frame = s.show(scene("pass", "any-samples-passed", 1))?;
    assert_eq!(frame.counters, [1, 0]);
    if s.offers(Feature::PreciseOcclusion) {
        let frame = s.show(scene("pass", "samples-passed", 1))?;
        assert_eq!(frame.counters, [30, 0]);
        let frame = s.show(scene("frame", "samples-passed", 2))?;
        assert!(frame.counters[0] >= 60, "{:?}", frame.counters);
    }
    Ok(())
}

pub(crate) fn each_sample_counts_by_itself(s: &CheckedBackend) -> CheckEnd {
    for (mask, expected) in [(15, 1024), (5, 512), (0, 0)] {
        let frame = s.show(json!({
            "attachments": { "color": { "format": "rgba8unorm", "samples": 4 } },
            "draws": [{ "mesh": { "kind": "cover" }, "shader": "uniform_color", "counters": ["n"],
                        "multisample": { "mask": mask } }],
            "counters": { "n": "samples-passed" },
        }))?;
        assert_eq!(frame.counters, [expected], "{mask}");
    }
    Ok(())
}

/// Drivers can run the shader for texels next to the primitive, but not if nothing is rasterized.
pub(crate) fn invocations_are_counted(s: &CheckedBackend) -> CheckEnd {
    let draw = |name: &str, state: Value| with(corner(true, "uniform_color", &[name]), state);
    let draws = vec![
        draw("a", json!({})),
        draw("b", json!({})),
        draw("b", json!({})),
        draw("c", json!({ "cull": "front" })),
        draw("c", json!({ "scissor": [0, 0, 0, 0] })),
    ];
    let kinds = counters_of(&["a", "b", "c"], "fragment-invocations");
    let counters = counted(s, kinds, draws)?.counters;
    assert!(counters[0] >= 15, "{counters:?}");
    assert_eq!(counters, [counters[0], 2 * counters[0], 0]);
    Ok(())
}

/// Statistics need not be exact, but nothing runs without being rasterized, and a shader that counts its
/// own runs has run.
pub(crate) fn statistics_tell_that_shaders_ran(s: &CheckedBackend) -> CheckEnd {
    let draw = |scissor: [u32; 4], name: &str| {
        json!({ "mesh": full(), "shader": "counted_color", "scissor": scissor,
                "counters": ["runs", name] })
    };
    let draws = vec![
        draw([0, 0, 16, 16], "some"),
        draw([0, 0, 0, 0], "none"),
        draw([0, 0, 16, 8], "some"),
    ];
    let kinds = json!({ "none": "fragment-invocations", "runs": "shader-runs",
                        "some": "fragment-invocations" });
    let counters = counted(s, kinds, draws)?.counters;
    assert_eq!((counters.len(), &counters[..2]), (3, &[0, 384][..]));
    assert!((384..2 * 384).contains(&counters[2]), "{counters:?}");
    Ok(())
}

pub(crate) fn discarded_primitives_run_no_shader(s: &CheckedBackend) -> CheckEnd {
    let discarded = json!({ "rasterizer_discard": true });
    let draw = with(corner(true, "uniform_color", &["n"]), discarded);
    let frame = counted(s, counters_of(&["n"], "fragment-invocations"), vec![draw])?;
    assert_eq!(frame.counters, [0]);
    Ok(())
}

pub(crate) fn runs_are_counted(s: &CheckedBackend) -> CheckEnd {
    let draws = [(true, "a"), (false, "b"), (true, "c"), (true, "c")].map(|(front, name)| {
        with(
            corner(front, "counted_color", &[name]),
            json!({ "early_tests": "forced" }),
        )
    });
    let frame = counted(
        s,
        counters_of(&["a", "b", "c"], "shader-runs"),
        draws.to_vec(),
    )?;
    assert_eq!(frame.counters, [15, 0, 30]);
    check_painted(&frame, |x, y| x < 5 && y < 3);
    Ok(())
}

/// Unless early tests are forced, the shader runs for fragments that the tests reject.
pub(crate) fn rejected_fragments_run(s: &CheckedBackend) -> CheckEnd {
    let draw = |texels: [u32; 4], shader: &str, textures: &[&str], name: &str| {
        json!({ "mesh": { "kind": "rect", "texels": texels, "value": 0.5 }, "shader": shader,
                "textures": textures, "params": red(), "depth": test("never", true),
                "counters": [name] })
    };
    let frame = s.show(json!({
        "attachments": {
            "color": { "format": "rgba8unorm", "size": [8, 8] },
            "depth": { "format": "depth32float", "clear": 1 },
            "source": uploaded("columns", [NONE, [0, 0, 0, 255]].repeat(4)) },
        "passes": [
            { "color": ["color"], "depth_stencil": "depth", "draws": [
                draw([0, 0, 3, 2], "counted_color", &[], "b"),
                draw([2, 1, 8, 4], "counted_depth", &[], "a"),
                draw([0, 0, 8, 8], "counted_discard", &["source"], "c")] },
            { "color": ["color"], "depth_stencil": "depth", "draws": [
                draw([7, 7, 8, 8], "counted_color", &[], "b")] }],
        "read": ["color"],
        "counters": counters_of(&["a", "b", "c"], "shader-runs"),
    }))?;
    assert_eq!(frame.counters, [18, 7, 64]);
    Ok(())
}

/// A draw that discards, for which shader runs, invocations and passed samples are counted separately.
pub(crate) fn counters_of_all_kinds_go_together(s: &CheckedBackend) -> CheckEnd {
    let drawn = |kinds: Value| {
        let names: Vec<_> = kinds.as_object().unwrap().keys().cloned().collect();
        let draw = json!({
            "mesh": { "kind": "full", "z": 0.25 }, "shader": "counted_discard", "textures": ["half"],
            "params": { "color": [0, 0, 0, 0.5] }, "depth": test("less", true), "counters": names });
        counted(s, kinds, vec![draw]).map(|frame| frame.counters)
    };
    let mut occlusion = ("any-samples-passed", 1);
    let counters = drawn(json!({ "p": occlusion.0, "r": "shader-runs" }))?;
    assert_eq!(counters, [1, 256]);
    if s.offers(Feature::PreciseOcclusion) {
        occlusion = ("samples-passed", 160);
        let counters = drawn(json!({ "p": occlusion.0, "r": "shader-runs" }))?;
        assert_eq!(counters, [160, 256]);
    }
    let counters =
        drawn(json!({ "i": "fragment-invocations", "p": occlusion.0, "r": "shader-runs" }))?;
    assert!((256..=1024).contains(&counters[0]), "{counters:?}");
    assert_eq!(counters[1..], [occlusion.1, 256]);
    Ok(())
}

/// Counts all kinds over two passes, repeatedly, alternating with a scene that has more draws.
pub(crate) fn counters_start_from_0_at_every_submit(s: &CheckedBackend) -> CheckEnd {
    let draw =
        json!({ "mesh": full(), "shader": "counted_color", "counters": ["runs", "passed", "run"] });
    let scene = |draws: usize| {
        let pass = json!({ "color": ["color"], "draws": vec![draw.clone(); draws] });
        scene(json!({
            "attachments": { "color": { "format": "rgba8unorm" } },
            "passes": [pass, pass],
            "counters": { "passed": "samples-passed", "run": "fragment-invocations",
                          "runs": "shader-runs" },
        }))
    };
    let (few, many) = (scene(1), scene(20));
    let (mut a, mut b) = (s.prepare(&few)?, s.prepare(&many)?);
    for _ in 0..3 {
        s.submit(a.as_mut())?;
        s.submit(b.as_mut())?;
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
    s.check_silence("counters");
    Ok(())
}

/// Storage writes happen even if the test then fails, unless the test is forced to come first.
pub(crate) fn forced_tests_come_before_the_shader(s: &CheckedBackend) -> CheckEnd {
    for (early, runs) in [("implicit", 256), ("forced", 128)] {
        let draw = |counters: &[&str]| {
            vec![with(
                halves("counted_color", counters),
                json!({ "early_tests": early }),
            )]
        };
        let frame = counted(s, counters_of(&["runs"], "shader-runs"), draw(&["runs"]))?;
        assert_eq!(frame.counters, [runs], "{early}");
        check_painted(&frame, |x, _| x < 8);
        if s.offers(Feature::PreciseOcclusion) {
            let kinds = json!({ "passed": "samples-passed", "runs": "shader-runs" });
            let frame = counted(s, kinds, draw(&["runs", "passed"]))?;
            assert_eq!(frame.counters, [128, runs], "{early}");
        }
    }
    Ok(())
}

/// A forced test compares and stores the fragment's own depth, not the shader's.
pub(crate) fn forced_tests_ignore_the_written_depth(s: &CheckedBackend) -> CheckEnd {
    let kinds = || counters_of(&["runs"], "shader-runs");
    let full = json!({
        "mesh": { "kind": "full", "z": 0.25, "value": 0.125 }, "shader": "counted_depth",
        "params": red(), "early_tests": "forced", "counters": ["runs"], "depth": test("less", true) });
    let frame = counted(s, kinds(), vec![full])?;
    assert_eq!(frame.counters, [256]);
    frame.depth_is("depth", |_, _| 0.25);
    // A written depth of 0 would pass the test that the fragment's own depth fails.
    for (tests, runs, red, stored) in [
        ("implicit", 256, 16, [0.0, 0.0]),
        ("forced", 128, 8, [0.25, 0.5]),
    ] {
        let draw = with(
            halves("counted_depth", &["runs"]),
            json!({ "early_tests": tests }),
        );
        let frame = counted(s, kinds(), vec![draw])?;
        assert_eq!(frame.counters, [runs], "{tests}");
        check_painted(&frame, |x, _| x < red);
        frame.depth_is("depth", |x, _| stored[x as usize / 8]);
    }
    Ok(())
}
