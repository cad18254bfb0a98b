//! Legal sets by version of the specification, by promises of the adapter and by evidence.

use crate::common::{limits, scene};
use etalon_frame::{Api, ApiVersion, Grade, Limits, Property};
use etalon_reference::{Rules, legal_set};
use etalon_scene::Scene;

pub(crate) fn version(api: Api, major: u8, minor: u8) -> Limits {
    let mut limits = limits(api);
    limits.version = ApiVersion::new(major, minor);
    limits.properties.clear();
    limits
}

/// Returns whether each kind of evidence, from all to only musts, allows the orders of a sample.
pub(crate) fn allowed(scene: &Scene, limits: &Limits, sample: u32, orders: &[i64]) -> [bool; 3] {
    let rules = Rules::of(limits);
    Grade::ALL.map(|grade| {
        let set = legal_set(scene, limits, &rules.bound_by(grade));
        set.groups[0].sample(1, 1, sample).allows(orders)
    })
}

pub(crate) const NEVER: [bool; 3] = [false; 3];
pub(crate) const ALWAYS: [bool; 3] = [true; 3];
/// A disputed reading forbids it.
pub(crate) const DISPUTED: [bool; 3] = [false, true, true];
/// A case of the CTS forbids it.
pub(crate) const BY_CTS: [bool; 3] = [false, false, true];

#[test]
fn signed_blending_is_clamped_as_the_version_says() {
    // -1 × 1 + 0: -127 by the range of the format, 0 if everything is clamped to [0,1].
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8snorm","size":[4,4],"clear":[0,0,0,0]}},
            "passes":[{"color":["c"],"draws":[{"mesh":{"kind":"full"},"shader":"uniform_color","params":{"color":[-1,-1,-1,-1]},
              "blend":{"color":{"operation":"add","src_factor":"one","dst_factor":"one"},
                       "alpha":{"operation":"add","src_factor":"one","dst_factor":"one"}}}]}],
            "read":["c"]}"#,
    );
    let allows = |limits: &Limits, order: i64| allowed(&scene, limits, 0, &[order; 4]);
    let old = version(Api::OpenGl, 3, 3);
    assert_eq!(allows(&old, 0), ALWAYS);
    assert_eq!(allows(&old, -127), DISPUTED);
    for new in [version(Api::OpenGl, 4, 5), version(Api::OpenGl, 4, 6)] {
        assert_eq!(allows(&new, -127), ALWAYS);
        assert_eq!(allows(&new, 0), DISPUTED, "17.3.7 clamps to [0,1]");
        assert_eq!(allows(&new, -128), NEVER);
        assert_eq!(allows(&new, -64), NEVER, "no reading has a value between");
    }
    let vulkan = version(Api::Vulkan, 1, 3);
    assert_eq!(allows(&vulkan, -127), ALWAYS);
    assert_eq!(allows(&vulkan, 0), NEVER);
    // A copy may give either code of -1.
    let webgpu = limits(Api::WebGpu);
    assert_eq!(allows(&webgpu, -127), ALWAYS);
    assert_eq!(allows(&webgpu, -128), ALWAYS);
    assert_eq!(allows(&webgpu, 0), NEVER);
}

#[test]
fn logic_operations_may_apply_to_srgb_only_in_opengl_3_3() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm-srgb","size":[4,4],"clear":[1,1,1,1]}},
            "passes":[{"color":["c"],"draws":[{"mesh":{"kind":"full"},"shader":"uniform_color","params":{"color":[1,1,1,1]},
              "logic":"xor"}]}],"read":["c"]}"#,
    );
    let allows = |limits: &Limits, order: i64| allowed(&scene, limits, 0, &[order; 4]);
    let old = version(Api::OpenGl, 3, 3);
    assert_eq!(allows(&old, 0), ALWAYS);
    assert_eq!(allows(&old, 255), DISPUTED);
    // No reading permits a value between them.
    assert_eq!(allows(&old, 128), NEVER);
    let new = version(Api::OpenGl, 4, 6);
    assert_eq!(allows(&new, 255), ALWAYS);
    assert_eq!(allows(&new, 0), NEVER);
}

/// A draw with forced early tests on a stencil of 5. The sample mask excludes sample 1 of 4, or alpha is 0
/// under alpha to coverage.
fn early(multisample: &str, alpha: u8) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4],"samples":4,"clear":[0,0,0,0]}},
             "s":{{"format":"stencil8","samples":4,"clear":5}}}},
            "passes":[{{"color":["c"],"depth_stencil":"s","draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
              "params":{{"color":[1,1,1,{alpha}]}},"early_tests":"forced",
              "multisample":{{{multisample}}},
              "stencil":{{"front":{{"compare":"always","pass_op":"increment-clamp"}}}}}}]}}],
            "read":["s"]}}"#
    ))
}

#[test]
fn the_sample_mask_may_act_after_forced_early_tests_without_a_promise() {
    let scene = early(r#""mask":13"#, 1);
    let mut vulkan = version(Api::Vulkan, 1, 3);
    assert_eq!(allowed(&scene, &vulkan, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 0, &[5]), NEVER);
    assert_eq!(allowed(&scene, &vulkan, 1, &[5]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 1, &[6]), ALWAYS);
    vulkan.properties.insert(Property::ShadesAfterCounting);
    assert_eq!(allowed(&scene, &vulkan, 1, &[6]), DISPUTED);
    vulkan.properties.insert(Property::MaskBeforeCounting);
    assert_eq!(allowed(&scene, &vulkan, 1, &[6]), NEVER);
    let gl = version(Api::OpenGl, 4, 6);
    assert_eq!(allowed(&scene, &gl, 1, &[6]), NEVER);
}

#[test]
fn alpha_to_coverage_may_precede_forced_early_tests_without_a_promise() {
    let scene = early(r#""alpha_to_coverage":true"#, 0);
    let mut vulkan = version(Api::Vulkan, 1, 3);
    for order in [5, 6] {
        assert_eq!(allowed(&scene, &vulkan, 0, &[order]), ALWAYS, "{order}");
    }
    vulkan.properties.insert(Property::ShadesAfterCounting);
    assert_eq!(allowed(&scene, &vulkan, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 0, &[5]), DISPUTED);
    vulkan.properties.insert(Property::CoverageAfterCounting);
    assert_eq!(allowed(&scene, &vulkan, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 0, &[5]), NEVER);
}

#[test]
fn the_cts_requires_early_updates_of_discarded_fragments() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4]},"s":{"format":"stencil8","clear":5},
             "t":{"format":"rgba8unorm","texels":{"kind":"rows","values":[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,0]]}}},
            "passes":[{"color":["c"],"depth_stencil":"s","draws":[{"mesh":{"kind":"full"},"shader":"texel_discard",
              "params":{"color":[0,0,0,0.5]},"textures":["t"],"early_tests":"forced",
              "stencil":{"front":{"compare":"always","pass_op":"increment-clamp"}}}]}],"read":["s"]}"#,
    );
    let mut vulkan = version(Api::Vulkan, 1, 3);
    assert_eq!(allowed(&scene, &vulkan, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 0, &[5]), BY_CTS);
    vulkan.properties.insert(Property::CoverageAfterCounting);
    assert_eq!(allowed(&scene, &vulkan, 0, &[5]), NEVER);
    let gl = version(Api::OpenGl, 4, 6);
    assert_eq!(allowed(&scene, &gl, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &gl, 0, &[5]), DISPUTED);
}

#[test]
fn depth_and_stencil_of_masked_samples_change_independently_in_opengl() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4],"samples":4,"clear":[0,0,0,0]},
             "d":{"format":"depth32float-stencil8","samples":4,"clear":{"depth":1,"stencil":5}}},
            "passes":[{"color":["c"],"depth_stencil":"d","draws":[{"mesh":{"kind":"full","z":0},"shader":"uniform_color",
              "params":{"color":[1,1,1,0]},"early_tests":"forced","multisample":{"alpha_to_coverage":true},
              "depth":{"compare":"less","write":true},
              "stencil":{"front":{"compare":"always","pass_op":"increment-clamp"}}}]}],"read":["d"]}"#,
    );
    let one = i64::from(1.0_f32.to_bits());
    let both = |limits: &Limits, depth: i64, stencil: i64| {
        allowed(&scene, limits, 0, &[depth, stencil])[2]
    };
    let gl = version(Api::OpenGl, 4, 6);
    for (depth, stencil) in [(one, 5), (one, 6), (0, 5), (0, 6)] {
        assert!(both(&gl, depth, stencil), "{depth} {stencil}");
    }
    let vulkan = version(Api::Vulkan, 1, 3);
    assert!(both(&vulkan, one, 5) && both(&vulkan, 0, 6));
    assert!(!both(&vulkan, one, 6) && !both(&vulkan, 0, 5));
}

#[test]
fn alpha_to_one_is_certain_only_for_the_first_output() {
    let target = |name: &str| {
        format!(r#""{name}":{{"format":"rgba8unorm","size":[4,4],"samples":4,"clear":[0,0,0,0]}}"#)
    };
    let text = format!(
        r#"{{"attachments":{{{},{},"t":{{"format":"rgba8unorm","texels":{{"kind":"rows","values":
             [[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,0]]}}}}}},
            "passes":[{{"color":["a","b"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"texel_color_all","textures":["t"],
              "multisample":{{"alpha_to_one":true}}}}]}}],"read":["READ"]}}"#,
        target("a"),
        target("b")
    );
    for limits in [version(Api::Vulkan, 1, 3), version(Api::OpenGl, 4, 6)] {
        let first = scene(&text.replace("READ", "a"));
        assert_eq!(allowed(&first, &limits, 0, &[0, 0, 0, 255]), ALWAYS);
        assert_eq!(allowed(&first, &limits, 0, &[0; 4]), NEVER);
        let second = scene(&text.replace("READ", "b"));
        assert_eq!(allowed(&second, &limits, 0, &[0, 0, 0, 255]), ALWAYS);
        assert_eq!(allowed(&second, &limits, 0, &[0; 4]), ALWAYS);
        // Either value, and none between them.
        assert_eq!(allowed(&second, &limits, 0, &[0, 0, 0, 128]), NEVER);
    }
}

#[test]
fn small_floats_of_opengl_keep_what_they_can_hold() {
    let allows = |value: f32, limits: &Limits, order: i64| {
        let scene = scene(&format!(
            r#"{{"attachments":{{"c":{{"format":"rg11b10ufloat","size":[4,4],"clear":[0,0,0,0]}}}},
                "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
                  "params":{{"color":[{value},0,0,0]}}}}]}}],"read":["c"]}}"#
        ));
        allowed(&scene, limits, 0, &[order, 0, 0])
    };
    // 65024 is the largest; 31 << 6 is infinity.
    let (largest, infinity) = ((31 << 6) - 1, 31 << 6);
    let vulkan = version(Api::Vulkan, 1, 3);
    // OpenGL ES lets subnormal values be forced to zero.
    for (gl, flushed) in [
        (version(Api::OpenGl, 3, 3), NEVER),
        (version(Api::OpenGlEs, 3, 1), ALWAYS),
    ] {
        assert_eq!(allows(1e6, &gl, largest), ALWAYS);
        assert_eq!(allows(1e6, &gl, infinity), NEVER);
        // 2^-20 is the least subnormal value.
        assert_eq!(allows(2_f32.powi(-20), &gl, 1), ALWAYS);
        assert_eq!(allows(2_f32.powi(-20), &gl, 0), flushed);
        // 1 + 3/4 of a step: towards zero, or the nearest.
        let above = 1.0 + 0.75 / 64.0;
        assert_eq!(allows(above, &gl, 15 << 6), ALWAYS);
        assert_eq!(allows(above, &gl, (15 << 6) + 1), ALWAYS);
        // 1 + 1/4 of a step: both are 1.
        let near = 1.0 + 0.25 / 64.0;
        assert_eq!(allows(near, &gl, (15 << 6) + 1), NEVER);
        assert_eq!(allows(near, &vulkan, (15 << 6) + 1), ALWAYS);
    }
    assert_eq!(allows(1e6, &vulkan, infinity), ALWAYS);
}

#[test]
fn an_advanced_blend_of_a_negative_alpha_is_undefined_in_vulkan_and_disputed_in_opengl() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,1]}},
            "passes":[{"color":["c"],"draws":[{"mesh":{"kind":"full"},"shader":"uniform_color",
              "params":{"color":[0,0,0,-1]},"advanced_blend":"screen"}]}],"read":["c"]}"#,
    );
    let any = [77, 1, 2, 3];
    assert_eq!(
        allowed(&scene, &version(Api::Vulkan, 1, 3), 0, &any),
        DISPUTED
    );
    let gl = version(Api::OpenGl, 4, 6);
    assert_eq!(allowed(&scene, &gl, 0, &any), DISPUTED);
    // Alphas 3 and 3 give -3, also a negative alpha.
    for [before, alpha] in [[1, -1], [3, 3]] {
        let floats = self::scene(&format!(
            r#"{{"attachments":{{"c":{{"format":"rgba32float","size":[4,4],"clear":[0,0,0,{before}]}}}},
                "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
                  "params":{{"color":[0,0,0,{alpha}]}},"advanced_blend":"screen"}}]}}],"read":["c"]}}"#
        ));
        let vulkan = version(Api::Vulkan, 1, 3);
        assert_eq!(allowed(&floats, &vulkan, 0, &any), ALWAYS);
    }
}

/// A draw on a stencil of 5 whose shader writes the mask 13, which excludes sample 1.
fn masked(early: &str, samples: u32, mask: u32) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4],"samples":{samples},"clear":[0,0,0,0]}},
             "s":{{"format":"stencil8","samples":{samples},"clear":5}},
             "t":{{"format":"rgba32float","texels":{{"kind":"columns","values":
               [[{mask},0,0,1],[{mask},0,0,1],[{mask},0,0,1],[{mask},0,0,1]]}}}}}},
            "passes":[{{"color":["c"],"depth_stencil":"s","draws":[{{"mesh":{{"kind":"full"}},"shader":"masked_color",
              "textures":["t"],"early_tests":"{early}",
              "stencil":{{"front":{{"compare":"always","pass_op":"increment-clamp"}}}}}}]}}],
            "read":["s"]}}"#
    ))
}

#[test]
fn the_cts_requires_early_updates_of_samples_that_a_shader_masks() {
    let scene = masked("forced", 4, 13);
    let mut vulkan = version(Api::Vulkan, 1, 3);
    assert_eq!(allowed(&scene, &vulkan, 1, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 1, &[5]), BY_CTS);
    vulkan.properties.insert(Property::CoverageAfterCounting);
    assert_eq!(allowed(&scene, &vulkan, 1, &[5]), NEVER);
    for order in [5, 6] {
        let gl = version(Api::OpenGl, 4, 6);
        assert_eq!(allowed(&scene, &gl, 1, &[order]), ALWAYS, "{order}");
    }
    let late = masked("implicit", 4, 13);
    // In WebGPU, the positions of samples and coverage of the edge between both triangles are open by musts alone.
    for (limits, uncovered) in [
        (version(Api::OpenGlEs, 3, 2), NEVER),
        (limits(Api::WebGpu), DISPUTED),
        (vulkan, NEVER),
    ] {
        assert_eq!(allowed(&late, &limits, 1, &[6]), NEVER);
        assert_eq!(allowed(&late, &limits, 1, &[5]), ALWAYS);
        assert_eq!(allowed(&late, &limits, 2, &[5]), uncovered);
    }
}

#[test]
fn the_mask_that_a_shader_writes_acts_on_one_sample_as_each_specification_says() {
    let scene = masked("implicit", 1, 2);
    for limits in [version(Api::Vulkan, 1, 0), limits(Api::WebGpu)] {
        assert_eq!(allowed(&scene, &limits, 0, &[5]), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &[6]), NEVER);
    }
    for limits in [version(Api::OpenGl, 4, 6), version(Api::OpenGlEs, 3, 2)] {
        assert_eq!(allowed(&scene, &limits, 0, &[6]), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &[5]), BY_CTS);
    }
}

/// A draw on a stencil of 5 whose shader writes the reference 300; the draw's own is 9.
fn exporting(early: &str) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,0]}},
             "s":{{"format":"stencil8","clear":5}},
             "t":{{"format":"rgba32float","texels":{{"kind":"columns","values":
               [[300,0,0,1],[300,0,0,1],[300,0,0,1],[300,0,0,1]]}}}}}},
            "passes":[{{"color":["c"],"depth_stencil":"s","draws":[{{"mesh":{{"kind":"full"}},"shader":"exported_color",
              "textures":["t"],"early_tests":"{early}",
              "stencil":{{"front":{{"compare":"greater","pass_op":"replace"}},"reference":9}}}}]}}],
            "read":["s"]}}"#
    ))
}

#[test]
fn the_reference_that_a_shader_writes_counts_in_the_bits_of_the_attachment() {
    for limits in [version(Api::Vulkan, 1, 3), version(Api::OpenGl, 3, 3)] {
        for (early, reference) in [("implicit", 44), ("forced", 9)] {
            let scene = exporting(early);
            for stored in [5, 9, 44, 255] {
                let expected = match (early, stored) {
                    _ if stored == reference => ALWAYS,
                    // A shader that "should" run after the tests may run before them.
                    ("forced", 44) if limits.api == Api::Vulkan => DISPUTED,
                    _ => NEVER,
                };
                assert_eq!(
                    allowed(&scene, &limits, 0, &[stored]),
                    expected,
                    "{early}, {stored}"
                );
            }
        }
    }
}

#[test]
fn stencil_runs_without_a_fragment_shader_but_opengl_has_another_reading() {
    let scene = scene(
        r#"{"attachments":{"s":{"format":"stencil8","size":[4,4],"clear":5}},
            "passes":[{"depth_stencil":"s","draws":[{"mesh":{"kind":"full"},"shader":"vertex_only",
              "stencil":{"front":{"compare":"always","pass_op":"increment-clamp"}}}]}],"read":["s"]}"#,
    );
    for limits in [version(Api::Vulkan, 1, 0), limits(Api::WebGpu)] {
        assert_eq!(allowed(&scene, &limits, 0, &[6]), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &[5]), NEVER);
    }
    let gl = version(Api::OpenGl, 3, 3);
    assert_eq!(allowed(&scene, &gl, 0, &[6]), ALWAYS);
    assert_eq!(allowed(&scene, &gl, 0, &[5]), DISPUTED);
}

#[test]
fn webgpu_does_not_say_that_the_stencil_reference_is_masked() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,0]},
             "s":{"format":"stencil8","clear":0}},
            "passes":[{"color":["c"],"depth_stencil":"s","draws":[{"mesh":{"kind":"full"},"shader":"uniform_color",
              "params":{"color":[1,1,1,1]},
              "stencil":{"front":{"compare":"greater","reference":170,"read_mask":0}}}]}],"read":["c"]}"#,
    );
    let (drawn, kept) = ([255; 4], [0; 4]);
    let webgpu = limits(Api::WebGpu);
    assert_eq!(allowed(&scene, &webgpu, 0, &kept), ALWAYS);
    assert_eq!(allowed(&scene, &webgpu, 0, &drawn), DISPUTED);
    for other in [version(Api::Vulkan, 1, 3), version(Api::OpenGl, 3, 3)] {
        assert_eq!(allowed(&scene, &other, 0, &drawn), NEVER);
    }
}

/// The legal range of a counter of shader runs, by all evidence and by only musts.
fn runs(scene: &Scene, limits: &Limits) -> [(u64, Option<u64>); 2] {
    let rules = Rules::of(limits);
    [Grade::Disputed, Grade::Proven].map(|grade| {
        let range = legal_set(scene, limits, &rules.bound_by(grade)).counters[0].range;
        (range.low, range.high)
    })
}

fn counted(early: &str, draws: &str) -> Scene {
    let draw = format!(
        r#"{{"mesh":{{"kind":"full"}},"shader":"counted_color","params":{{"color":[1,1,1,1]}},"early_tests":"{early}",
             "depth":{{"compare":"never","write":true}},"counters":["n"]}}"#
    );
    let draws = draws.replace("COUNTED", &draw);
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4]}},"d":{{"format":"depth32float","clear":1}}}},
            "counters":{{"n":"shader-runs"}},
            "passes":[{{"color":["c"],"depth_stencil":"d","draws":[{draws}]}}],"read":["c"]}}"#
    ))
}

#[test]
fn a_fragment_that_fails_its_late_tests_is_shaded_as_each_specification_says() {
    let scene = counted("implicit", "COUNTED");
    let exact = (16, Some(16));
    assert_eq!(runs(&scene, &version(Api::Vulkan, 1, 3)), [(16, None); 2]);
    assert_eq!(
        runs(&scene, &version(Api::OpenGlEs, 3, 1)),
        [exact, (0, Some(16))]
    );
    assert_eq!(runs(&scene, &version(Api::OpenGl, 4, 5)), [exact; 2]);
    assert_eq!(
        runs(&scene, &version(Api::OpenGl, 4, 6)),
        [exact, (0, None)]
    );
}

#[test]
fn forced_early_tests_prevent_shader_runs_as_each_specification_says() {
    let scene = counted("forced", "COUNTED");
    let none = (0, Some(0));
    assert_eq!(runs(&scene, &version(Api::Vulkan, 1, 3)), [none, (0, None)]);
    assert_eq!(runs(&scene, &version(Api::OpenGlEs, 3, 1)), [none; 2]);
    assert_eq!(runs(&scene, &version(Api::OpenGl, 4, 5)), [none; 2]);
    assert_eq!(runs(&scene, &version(Api::OpenGl, 4, 6)), [none, (0, None)]);
}

#[test]
fn a_fragment_that_is_overwritten_may_go_without_a_run_in_es() {
    let visible = r#"{"mesh":{"kind":"full"},"shader":"counted_color","params":{"color":[1,1,1,1]},"counters":["n"]}"#;
    let scene = counted("implicit", &format!("{visible},{visible}"));
    assert_eq!(runs(&scene, &version(Api::Vulkan, 1, 3)), [(32, None); 2]);
    // At least the last of a texel's two fragments.
    assert_eq!(
        runs(&scene, &version(Api::OpenGlEs, 3, 2)),
        [(16, Some(32)); 2]
    );
    assert_eq!(
        runs(&scene, &version(Api::OpenGl, 4, 5)),
        [(32, Some(32)); 2]
    );
}

#[test]
fn a_point_beside_the_viewport_is_drawn_or_not_as_each_specification_says() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,0]}},
            "passes":[{"color":["c"],"draws":[{"shader":"uniform_color","params":{"color":[1,1,1,1]},
              "topology":"point-list","viewport":{"rect":[2,2,2,2],"depth":[0,1]},
              "mesh":{"kind":"vertices","positions":[[-1.5,1.5,0]]}}]}],"read":["c"]}"#,
    );
    let drawn = |limits| allowed(&scene, &limits, 0, &[255; 4]);
    for corrected in [version(Api::OpenGl, 3, 3), version(Api::OpenGl, 4, 5)] {
        assert_eq!(drawn(corrected), DISPUTED);
    }
    for open in [version(Api::OpenGl, 4, 6), version(Api::OpenGlEs, 3, 2)] {
        assert_eq!(drawn(open), ALWAYS);
    }
}

#[test]
fn samples_at_edges_are_covered_if_the_specification_says_so() {
    // A triangle whose right edge goes through the middle of column 1.
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4],"samples":4,"clear":[0,0,0,0]}},
            "passes":[{"color":["c"],"draws":[{"shader":"uniform_color","params":{"color":[1,1,1,1]},
              "mesh":{"kind":"vertices","positions":[[-9,-40,0],[-0.25,-40,0],[-0.25,40,0]]}}]}],"read":["c"]}"#,
    );
    let (covered, kept) = ([255; 4], [0; 4]);
    let exact = version(Api::Vulkan, 1, 3);
    // The standard positions: 3/8 and 7/8 from the left.
    assert_eq!(allowed(&scene, &exact, 0, &covered), ALWAYS);
    assert_eq!(allowed(&scene, &exact, 0, &kept), NEVER);
    assert_eq!(allowed(&scene, &exact, 1, &covered), NEVER);
    for open in [
        version(Api::OpenGl, 3, 3),
        version(Api::OpenGl, 4, 6),
        version(Api::OpenGlEs, 3, 2),
    ] {
        assert_eq!(allowed(&scene, &open, 0, &covered), ALWAYS);
        assert_eq!(allowed(&scene, &open, 0, &kept), DISPUTED);
        assert_eq!(allowed(&scene, &open, 1, &covered), DISPUTED);
    }
}

#[test]
fn an_overflowing_half_float_is_certainly_no_nan_only_in_vulkan() {
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba16float","size":[4,4],"clear":[0,0,0,0]}},
            "passes":[{"color":["c"],"draws":[{"mesh":{"kind":"full"},"shader":"uniform_color",
              "params":{"color":[100000,100000,100000,100000]}}]}],"read":["c"]}"#,
    );
    let (largest, infinity, nan) = ([0x7bff; 4], [0x7c00; 4], [0x7e00; 4]);
    let vulkan = version(Api::Vulkan, 1, 3);
    for legal in [largest, infinity] {
        assert_eq!(allowed(&scene, &vulkan, 0, &legal), ALWAYS);
        assert_eq!(
            allowed(&scene, &version(Api::OpenGlEs, 3, 1), 0, &legal),
            ALWAYS
        );
    }
    assert_eq!(allowed(&scene, &vulkan, 0, &nan), NEVER);
    assert_eq!(
        allowed(&scene, &version(Api::OpenGlEs, 3, 1), 0, &nan),
        DISPUTED
    );
    // A copy in WebGPU may change a value that is not a number.
    assert_eq!(allowed(&scene, &limits(Api::WebGpu), 0, &nan), ALWAYS);
}

/// A white line over black.
fn line(shader: &str, mesh: &str) -> Scene {
    scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,0]}}}},
            "passes":[{{"color":["c"],"draws":[{{{shader},"topology":"line-list",
              "mesh":{{"kind":"vertices",{mesh}}}}}]}}],"read":["c"]}}"#
    ))
}

const WHITE: &str = r#""shader":"uniform_color","params":{"color":[1,1,1,1]}"#;
const OTHERS: [(Api, u8, u8); 2] = [(Api::OpenGl, 3, 3), (Api::OpenGlEs, 3, 2)];

#[test]
fn only_the_cts_requires_vulkan_to_clip_a_line_before_the_near_plane() {
    let (drawn, kept) = ([255; 4], [0; 4]);
    let before = line(
        WHITE,
        r#""units":"texels","positions":[[-8,1.5,-0.5],[12,1.5,-0.5]]"#,
    );
    let behind = line(WHITE, r#""positions":[[-1,-0.25,0.5,-1],[1,-0.25,0.5,-1]]"#);
    for scene in [before, behind] {
        let vulkan = version(Api::Vulkan, 1, 3);
        assert_eq!(allowed(&scene, &vulkan, 0, &kept), ALWAYS);
        assert_eq!(allowed(&scene, &vulkan, 0, &drawn), BY_CTS);
        for (api, major, minor) in OTHERS {
            assert_eq!(
                allowed(&scene, &version(api, major, minor), 0, &drawn),
                NEVER
            );
        }
        assert_eq!(allowed(&scene, &limits(Api::WebGpu), 0, &drawn), NEVER);
    }
}

#[test]
fn a_line_that_ends_behind_the_eye_is_cut_by_the_cts_and_drawn_by_a_reading_in_vulkan() {
    let (drawn, kept) = ([255; 4], [0; 4]);
    let mut vulkan = version(Api::Vulkan, 1, 3);
    vulkan.properties.insert(Property::LinesAreParallelograms);
    // Both run to the right without end. Divided by w, the second end is far to the left.
    let [through, beside] = [-3.0, 1.3].map(|start| {
        let mesh = format!(r#""positions":[[{start},0.25,0.5,1],[7,-0.25,-0.5,-1]]"#);
        line(WHITE, &mesh)
    });
    assert_eq!(allowed(&through, &vulkan, 0, &drawn), ALWAYS);
    assert_eq!(allowed(&through, &vulkan, 0, &kept), DISPUTED);
    assert_eq!(allowed(&beside, &vulkan, 0, &kept), ALWAYS);
    assert_eq!(allowed(&beside, &vulkan, 0, &drawn), BY_CTS);
    // A line that a plane cuts in front of the eye is there, clipped or not.
    let front = line(WHITE, r#""positions":[[-3,0.25,0.5,1],[12,1,-0.5,4]]"#);
    assert_eq!(allowed(&front, &vulkan, 0, &drawn), ALWAYS);
    assert_eq!(allowed(&front, &vulkan, 0, &kept), BY_CTS);
    for (api, major, minor) in OTHERS {
        let limits = version(api, major, minor);
        assert_eq!(allowed(&through, &limits, 0, &drawn), ALWAYS);
        assert_eq!(allowed(&beside, &limits, 0, &drawn), NEVER);
    }
}

#[test]
fn clip_distances_of_a_line_are_disputed_in_vulkan_alone() {
    let (drawn, kept) = ([255; 4], [0; 4]);
    let scene = line(
        r#""shader":"clip_flat""#,
        r#""units":"texels","positions":[[-8,1.5,0.5],[12,1.5,0.5]],"values":[[1,1,1,1]],"uv":[[-1,-1],[-1,-1]]"#,
    );
    let vulkan = version(Api::Vulkan, 1, 3);
    assert_eq!(allowed(&scene, &vulkan, 0, &kept), ALWAYS);
    assert_eq!(allowed(&scene, &vulkan, 0, &drawn), DISPUTED);
    for (api, major, minor) in OTHERS {
        assert_eq!(
            allowed(&scene, &version(api, major, minor), 0, &drawn),
            NEVER
        );
    }
}

#[test]
fn a_line_along_an_axis_has_no_gap_if_lines_are_parallelograms() {
    let (drawn, kept) = ([255; 4], [0; 4]);
    let scene = line(
        WHITE,
        r#""units":"texels","positions":[[-8,1.5,0.5],[12,1.5,0.5]]"#,
    );
    let mut vulkan = version(Api::Vulkan, 1, 3);
    let [gl, es] = OTHERS.map(|(api, major, minor)| version(api, major, minor));
    for limits in [&vulkan, &gl, &es, &limits(Api::WebGpu)] {
        assert_eq!(allowed(&scene, limits, 0, &drawn), ALWAYS);
        assert_eq!(allowed(&scene, limits, 0, &kept), DISPUTED);
    }
    vulkan.properties.insert(Property::LinesAreParallelograms);
    assert_eq!(allowed(&scene, &vulkan, 0, &kept), NEVER);
}

#[test]
fn a_strict_line_covers_the_samples_of_its_shape_and_no_others() {
    let (drawn, kept) = ([255; 4], [0; 4]);
    let of = |positions: &str| {
        line(
            WHITE,
            &format!(r#""units":"texels","positions":{positions}"#),
        )
    };
    // 0.25 texels above the sample, and 1.25 below it.
    let through = of("[[0.25,0.5,0.5],[3.75,2.5,0.5]]");
    let beside = of("[[0.25,2.6,0.5],[3.75,3.4,0.5]]");
    let strict = |limits: &Limits| {
        let mut limits = limits.clone();
        limits.properties.insert(Property::LinesAreParallelograms);
        limits
    };
    let vulkan = version(Api::Vulkan, 1, 3);
    for scene in [&through, &beside] {
        assert_eq!(allowed(scene, &vulkan, 0, &drawn), ALWAYS);
        assert_eq!(allowed(scene, &vulkan, 0, &kept), ALWAYS);
    }
    assert_eq!(allowed(&through, &strict(&vulkan), 0, &drawn), ALWAYS);
    assert_eq!(allowed(&through, &strict(&vulkan), 0, &kept), NEVER);
    assert_eq!(allowed(&beside, &strict(&vulkan), 0, &kept), ALWAYS);
    assert_eq!(allowed(&beside, &strict(&vulkan), 0, &drawn), NEVER);
}

#[test]
fn clears_within_a_query_count_nothing_by_the_cts_in_vulkan_and_by_the_text_elsewhere() {
    let scene = scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4]}},"d":{{"format":"depth32float","clear":1}}}},
            "counters":{{"n":"samples-passed"}},
            "passes":[{{"color":["c"],"depth_stencil":"d",
              "clears":[{{"before":1,"depth":0.5}}],
              "draws":[{{{WHITE},"mesh":{{"kind":"full"}},"counters":["n"]}},{{{WHITE},"mesh":{{"kind":"full"}},"counters":["n"]}}]}}],
            "queries":"pass","read":["c"]}}"#
    ));
    let most = |limits: &Limits| {
        let rules = Rules::of(limits);
        Grade::ALL.map(|grade| {
            let set = legal_set(&scene, limits, &rules.bound_by(grade));
            set.counters[0].range.high
        })
    };
    assert_eq!(
        most(&version(Api::Vulkan, 1, 3)),
        [Some(32), Some(32), None]
    );
    for (api, major, minor) in OTHERS {
        assert_eq!(most(&version(api, major, minor)), [Some(32); 3]);
    }
}

/// Returns the order of a 32-bit float.
fn order(depth: f32) -> i64 {
    i64::from(depth.to_bits())
}

#[test]
fn a_small_depth_is_as_precise_as_the_terms_it_is_made_of() {
    let depth = 2_f32.powi(-10);
    let scene = scene(&format!(
        r#"{{"attachments":{{"c":{{"format":"rgba8unorm","size":[4,4]}},"d":{{"format":"depth32float","clear":1}}}},
            "passes":[{{"color":["c"],"depth_stencil":"d","draws":[{{{WHITE},"depth":{{"compare":"always","write":true}},
              "mesh":{{"kind":"vertices","positions":[[-1,-1,{depth:?}],[3,-1,{depth:?}],[-1,3,{depth:?}]]}}}}]}}],
            "read":["d"]}}"#
    ));
    // Half a percent of the depth, and a 200,000th of the range.
    let off = [order(depth + 5e-6)];
    assert_eq!(allowed(&scene, &version(Api::Vulkan, 1, 3), 0, &off), NEVER);
    assert_eq!(allowed(&scene, &limits(Api::WebGpu), 0, &off), DISPUTED);
    for (api, major, minor) in OTHERS {
        let mut limits = version(api, major, minor);
        assert_eq!(allowed(&scene, &limits, 0, &off), ALWAYS);
        limits.properties.insert(Property::DepthFromZero);
        assert_eq!(allowed(&scene, &limits, 0, &off), NEVER);
    }
    let far = [order(depth + 2e-4)];
    assert_eq!(allowed(&scene, &limits(Api::WebGpu), 0, &far), NEVER);
}

#[test]
fn the_slope_of_a_bias_is_the_larger_derivative_in_webgpu() {
    // The depth grows by a 64th per texel across and down: 0.3125 at the sample.
    let scene = scene(
        r#"{"attachments":{"c":{"format":"rgba8unorm","size":[4,4]},"d":{"format":"depth32float","clear":1}},
            "passes":[{"color":["c"],"depth_stencil":"d","draws":[{"shader":"uniform_color","params":{"color":[1,1,1,1]},
              "depth":{"compare":"always","write":true},"depth_bias":{"slope":1},
              "mesh":{"kind":"vertices","positions":[[-1,-1,0.25],[3,-1,0.375],[-1,3,0.375]]}}]}],"read":["d"]}"#,
    );
    let larger = [order(0.312_5 + 1.0 / 64.0)];
    let root = [order(0.312_5 + std::f32::consts::SQRT_2 / 64.0)];
    for (limits, by_root) in [
        (version(Api::Vulkan, 1, 3), ALWAYS),
        (version(Api::OpenGl, 4, 6), ALWAYS),
        (limits(Api::WebGpu), NEVER),
    ] {
        assert_eq!(allowed(&scene, &limits, 0, &larger), ALWAYS);
        assert_eq!(allowed(&scene, &limits, 0, &root), by_root);
    }
}
