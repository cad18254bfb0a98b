//! Counters of each kind.

use super::Checked;
use crate::frames::{NONE, RED, check, color, depth};
use crate::scenes::{list, scene};
use crate::subject::Subject;
use etalon_frame::{Feature, Frame, Image};

/// Draws into colour and a depth of a half, with counters as the insides of their JSON. The alpha of
/// the texture `half` is 1 in the first ten columns.
pub(super) fn counted(
    s: &Subject,
    counters: &str,
    draws: &[String],
) -> Result<Frame, crate::Missing> {
    let texel = |x| if x < 10 { RED } else { NONE };
    let half: Vec<_> = (0..16).map(texel).collect();
    let draws = list(draws);
    s.draw(&scene(&format!(
        r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm" }},
                "depth": {{ "format": "depth32float", "clear": 0.5 }},
                "half": {{ "format": "rgba8unorm", "texels": {{ "kind": "columns", "values": {half:?} }} }} }},
            "passes": [ {{ "color": ["color"], "depth_stencil": "depth", "draws": [ {draws} ] }} ],
            "read": ["color", "depth"], "counters": {{ {counters} }} }}"#
    )))
}

/// A rectangle of 15 texels, in front of the stored depth or behind it.
fn corner(front: bool, shader: &str, more: &str) -> String {
    let z = if front { 0.25 } else { 0.75 };
    format!(
        r#"{{ "mesh": {{ "kind": "rect", "texels": [0, 0, 5, 3], "z": {z} }}, "shader": "{shader}",
            "params": {{ "color": [1, 0, 0, 1] }}, "depth": {{ "compare": "less", "write": false }} {more} }}"#
    )
}

/// The left half lies before the cleared depth, the right half behind it.
pub(super) const HALVES: &str = r#""mesh": { "kind": "columns", "values": [0, 0], "z": [0.25, 0.75] },
    "depth": { "compare": "less", "write": true }"#;

fn of(names: &[&str], kind: &str) -> String {
    let each = |name: &&str| format!(r#""{name}": "{kind}""#);
    list(&names.iter().map(each).collect::<Vec<_>>())
}

/// Holds an image to be red where told, and cleared to 0 elsewhere.
#[track_caller]
pub(super) fn check_painted(image: &Image, red: impl Fn(u32, u32) -> bool) {
    check(image, |x, y| if red(x, y) { RED } else { NONE });
}

/// Some draws pass, some fail, one is not counted, and one counter is not used.
pub(crate) fn any_samples_that_pass_are_told(s: &Subject) -> Checked {
    let by = |name: &str| format!(r#", "counters": ["{name}"]"#);
    let draws = [
        corner(true, "uniform_color", &by("a")),
        corner(false, "uniform_color", &by("b")),
        corner(false, "uniform_color", &by("c")),
        corner(true, "uniform_color", ""),
        corner(true, "uniform_color", &by("a")),
        corner(true, "uniform_color", &by("c")),
    ];
    let any = of(&["a", "b", "c", "d"], "any-samples-passed");
    assert_eq!(counted(s, &any, &draws)?.counters, [1, 0, 1, 0]);
    Ok(())
}

/// Over two passes, and with a single texel that passes.
pub(crate) fn any_samples_of_several_passes_are_told(s: &Subject) -> Checked {
    let draw = |texels: &str, compare: &str, counter: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "rect", "texels": {texels}, "z": 0.5 }}, "shader": "flat_color",
                "depth": {{ "compare": "{compare}", "write": false }}, "counters": [{counter}] }}"#
        )
    };
    let any = of(&["a", "b", "c", "d"], "any-samples-passed");
    let frame = s.draw(&scene(&format!(
        r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "size": [8, 8] }},
                "depth": {{ "format": "depth32float", "clear": 1 }} }},
            "passes": [ {{ "color": ["color"], "depth_stencil": "depth", "draws": [{}, {}, {}, {}] }},
                        {{ "color": ["color"], "depth_stencil": "depth", "draws": [{}, {}] }} ],
            "read": ["color"], "counters": {{ {any} }} }}"#,
        draw("[0, 0, 8, 8]", "greater", r#""a""#),
        draw("[5, 6, 6, 7]", "less", r#""b""#),
        draw("[0, 0, 8, 8]", "less", ""),
        draw("[0, 0, 8, 8]", "greater", r#""c""#),
        draw("[0, 0, 3, 3]", "less", r#""c""#),
        draw("[0, 0, 8, 8]", "equal", r#""a""#),
    )))?;
    assert_eq!(frame.counters, [0, 1, 1, 0]);
    Ok(())
}

pub(crate) fn samples_that_pass_are_counted(s: &Subject) -> Checked {
    let by = |name: &str, more: &str| format!(r#", "counters": ["{name}"] {more}"#);
    let draws = [
        corner(true, "uniform_color", &by("a", "")),
        corner(false, "uniform_color", &by("b", "")),
        corner(true, "uniform_color", ""),
        corner(true, "uniform_color", &by("a", "")),
        corner(
            true,
            "uniform_color",
            &by("c", r#", "scissor": [1, 1, 2, 16]"#),
        ),
    ];
    let precise = of(&["a", "b", "c"], "samples-passed");
    assert_eq!(counted(s, &precise, &draws)?.counters, [30, 0, 4]);
    // The depths of what passes the first draw stop the second.
    let halves = |names: &str| {
        format!(r#"{{ {HALVES}, "shader": "uniform_color", "counters": [{names}] }}"#)
    };
    let draws = [halves(r#""a""#), halves(r#""b""#), halves("")];
    assert_eq!(counted(s, &precise, &draws)?.counters, [128, 0, 0]);
    // Nothing need be written.
    let again = r#"{ "mesh": { "kind": "rect", "texels": [1, 2, 4, 7] }, "shader": "uniform_color",
        "counters": ["a"], "write_mask": "" }"#
        .to_owned();
    let draws = [halves(r#""a""#), again.clone(), again];
    let frame = counted(s, &of(&["a"], "samples-passed"), &draws)?;
    assert_eq!(frame.counters, [128 + 2 * 15]);
    Ok(())
}

pub(crate) fn each_sample_counts_by_itself(s: &Subject) -> Checked {
    for (mask, due) in [(15, 1024), (5, 512), (0, 0)] {
        let frame = s.draw(&scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "samples": 4 }} }},
                "passes": [ {{ "color": ["color"], "draws": [ {{ "mesh": {{ "kind": "cover" }},
                    "shader": "uniform_color", "counters": ["n"], "multisample": {{ "mask": {mask} }} }} ] }} ],
                "read": ["color"], "counters": {{ "n": "samples-passed" }} }}"#
        )))?;
        assert_eq!(frame.counters, [due], "{mask}");
    }
    Ok(())
}

/// Drivers may run the shader for texels beside the primitive, but not where none is rasterized.
pub(crate) fn invocations_are_counted(s: &Subject) -> Checked {
    let by = |name: &str, more: &str| format!(r#", "counters": ["{name}"] {more}"#);
    let draws = [
        corner(true, "uniform_color", &by("a", "")),
        corner(true, "uniform_color", &by("b", "")),
        corner(true, "uniform_color", &by("b", "")),
        corner(true, "uniform_color", &by("c", r#", "cull": "front""#)),
        corner(
            true,
            "uniform_color",
            &by("c", r#", "scissor": [0, 0, 0, 0]"#),
        ),
    ];
    let kinds = of(&["a", "b", "c"], "fragment-invocations");
    let [one, two, none] = counted(s, &kinds, &draws)?.counters[..] else {
        panic!("three counters are due");
    };
    println!("{one} fragment invocations for 15 texels");
    assert!(one >= 15, "{one}");
    assert_eq!((two, none), (2 * one, 0));
    Ok(())
}

/// Statistics need not be exact, but nothing runs that is not rasterized, and what counts itself has
/// run.
pub(crate) fn statistics_tell_that_shaders_ran(s: &Subject) -> Checked {
    let draw = |scissor: &str, name: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "full" }}, "shader": "counted_color", "scissor": {scissor},
                "counters": ["runs", "{name}"] }}"#
        )
    };
    let draws = [
        draw("[0, 0, 16, 16]", "some"),
        draw("[0, 0, 0, 0]", "none"),
        draw("[0, 0, 16, 8]", "some"),
    ];
    let kinds =
        r#""none": "fragment-invocations", "runs": "shader-runs", "some": "fragment-invocations""#;
    let [none, runs, some] = counted(s, kinds, &draws)?.counters[..] else {
        panic!("three counters are due");
    };
    assert_eq!([none, runs], [0, 384]);
    assert!((384..2 * 384).contains(&some), "{some}");
    Ok(())
}

pub(crate) fn discarded_primitives_run_no_shader(s: &Subject) -> Checked {
    let draws = [corner(
        true,
        "uniform_color",
        r#", "counters": ["n"], "rasterizer_discard": true"#,
    )];
    let frame = counted(s, &of(&["n"], "fragment-invocations"), &draws)?;
    assert_eq!(frame.counters, [0]);
    Ok(())
}

pub(crate) fn runs_are_counted(s: &Subject) -> Checked {
    let by = |name: &str| format!(r#", "early_tests": "forced", "counters": ["{name}"]"#);
    let draws = [
        corner(true, "counted_color", &by("a")),
        corner(false, "counted_color", &by("b")),
        corner(true, "counted_color", &by("c")),
        corner(true, "counted_color", &by("c")),
    ];
    let frame = counted(s, &of(&["a", "b", "c"], "shader-runs"), &draws)?;
    assert_eq!(frame.counters, [15, 0, 30]);
    check_painted(color(&frame, "color"), |x, y| x < 5 && y < 3);
    Ok(())
}

/// Unless the tests are forced to be early, fragments that they reject run all the same.
pub(crate) fn rejected_fragments_run(s: &Subject) -> Checked {
    let draw = |texels: &str, shader: &str, more: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "rect", "texels": {texels}, "value": 0.5 }}, "shader": "counted_{shader}",
                {PARAMS}, "depth": {{ "compare": "never", "write": true }}, {more} }}"#
        )
    };
    let source = [NONE, [0, 0, 0, 255]].repeat(4);
    let kinds = of(&["a", "b", "c"], "shader-runs");
    let frame = s.draw(&scene(&format!(
        r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm", "size": [8, 8] }},
                "depth": {{ "format": "depth32float", "clear": 1 }},
                "source": {{ "format": "rgba8unorm", "texels": {{ "kind": "columns", "values": {source:?} }} }} }},
            "passes": [ {{ "color": ["color"], "depth_stencil": "depth", "draws": [{}, {}, {}] }},
                        {{ "color": ["color"], "depth_stencil": "depth", "draws": [{}] }} ],
            "read": ["color"], "counters": {{ {kinds} }} }}"#,
        draw("[0, 0, 3, 2]", "color", r#""counters": ["b"]"#),
        draw("[2, 1, 8, 4]", "depth", r#""counters": ["a"]"#),
        draw(
            "[0, 0, 8, 8]",
            "discard",
            r#""textures": ["source"], "counters": ["c"]"#
        ),
        draw("[7, 7, 8, 8]", "color", r#""counters": ["b"]"#),
    )))?;
    assert_eq!(frame.counters, [18, 7, 64]);
    Ok(())
}

pub(super) const PARAMS: &str = r#""params": { "color": [1, 0, 0, 1] }"#;

/// Of a draw that discards: what runs, is invoked and passes are three numbers.
pub(crate) fn counters_of_all_kinds_go_together(s: &Subject) -> Checked {
    let draw = |names: &str| {
        format!(
            r#"{{ "mesh": {{ "kind": "full", "z": 0.25 }}, "shader": "counted_discard", "textures": ["half"],
                "params": {{ "color": [0, 0, 0, 0.5] }}, "depth": {{ "compare": "less", "write": true }},
                "counters": [{names}] }}"#
        )
    };
    let [any, precise, runs, invoked] = [
        r#""p": "any-samples-passed""#,
        r#""p": "samples-passed""#,
        r#""r": "shader-runs""#,
        r#""i": "fragment-invocations""#,
    ];
    let two = [draw(r#""p", "r""#)];
    let frame = counted(s, &format!("{any}, {runs}"), &two)?;
    assert_eq!(frame.counters, [1, 256]);
    if s.offers(Feature::PreciseOcclusion) {
        let frame = counted(s, &format!("{precise}, {runs}"), &two)?;
        assert_eq!(frame.counters, [160, 256]);
    }
    let occlusion = match s.offers(Feature::PreciseOcclusion) {
        true => (precise, 160),
        false => (any, 1),
    };
    let three = [draw(r#""i", "p", "r""#)];
    let frame = counted(s, &format!("{invoked}, {}, {runs}", occlusion.0), &three)?;
    println!("{:?}", frame.counters);
    assert!((256..=1024).contains(&frame.counters[0]));
    assert_eq!(frame.counters[1..], [occlusion.1, 256]);
    Ok(())
}

/// All kinds, over two passes, drawn again and again, beside another scene of more draws.
pub(crate) fn counters_start_from_0_at_every_submit(s: &Subject) -> Checked {
    let draw = r#"{ "mesh": { "kind": "full" }, "shader": "counted_color", "counters": ["runs", "passed", "run"] }"#;
    let scene = |draws: usize| {
        let draws = list(&vec![draw.to_owned(); draws]);
        let pass = format!(r#"{{ "color": ["color"], "draws": [ {draws} ] }}"#);
        scene(&format!(
            r#"{{ "attachments": {{ "color": {{ "format": "rgba8unorm" }} }}, "passes": [ {pass}, {pass} ],
                "read": ["color"], "counters": {{ "passed": "samples-passed", "run": "fragment-invocations",
                "runs": "shader-runs" }} }}"#
        ))
    };
    let (few, many) = (scene(1), scene(20));
    let (mut a, mut b) = (s.prepare(&few)?, s.prepare(&many)?);
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
    s.check_silence("counters");
    Ok(())
}

/// Storage writes happen although the test then fails, unless the test is forced to come first.
pub(crate) fn forced_tests_come_before_the_shader(s: &Subject) -> Checked {
    for (early, runs) in [("implicit", 256), ("forced", 128)] {
        let draws = [format!(
            r#"{{ {HALVES}, "shader": "counted_color", {PARAMS}, "early_tests": "{early}", "counters": ["runs"] }}"#
        )];
        let frame = counted(s, &of(&["runs"], "shader-runs"), &draws)?;
        assert_eq!(frame.counters, [runs], "{early}");
        check_painted(color(&frame, "color"), |x, _| x < 8);
        if s.offers(Feature::PreciseOcclusion) {
            let draws = [draws[0].replace(r#"["runs"]"#, r#"["runs", "passed"]"#)];
            let kinds = r#""passed": "samples-passed", "runs": "shader-runs""#;
            assert_eq!(counted(s, kinds, &draws)?.counters, [128, runs], "{early}");
        }
    }
    Ok(())
}

/// A forced test takes the fragment's own depth, not the shader's, and that is stored.
pub(crate) fn forced_tests_ignore_the_written_depth(s: &Subject) -> Checked {
    let kinds = of(&["runs"], "shader-runs");
    let full = format!(
        r#"{{ "mesh": {{ "kind": "full", "z": 0.25, "value": 0.125 }}, "shader": "counted_depth", {PARAMS},
            "early_tests": "forced", "counters": ["runs"], "depth": {{ "compare": "less", "write": true }} }}"#
    );
    let frame = counted(s, &kinds, &[full])?;
    assert_eq!(frame.counters, [256]);
    check(depth(&frame, "depth"), |_, _| [0.25_f32.to_bits()]);
    // A written depth of 0 would pass where the fragment's own does not.
    for (tests, runs, red, stored) in [
        ("implicit", 256, 16, [0.0, 0.0_f32]),
        ("forced", 128, 8, [0.25, 0.5]),
    ] {
        let halves = format!(
            r#"{{ {HALVES}, "shader": "counted_depth", {PARAMS}, "early_tests": "{tests}", "counters": ["runs"] }}"#
        );
        let frame = counted(s, &kinds, &[halves])?;
        assert_eq!(frame.counters, [runs], "{tests}");
        check_painted(color(&frame, "color"), |x, _| x < red);
        check(depth(&frame, "depth"), |x, _| {
            [stored[x as usize / 8].to_bits()]
        });
    }
    Ok(())
}
