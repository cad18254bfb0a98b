use super::{Sample, explain, legal_set};
use crate::rules::Rules;
use crate::test_limits::limits;
use etalon_case::{Case, CaseFile, Profile};
use etalon_frame::{
    Api, ApiVersion, ChannelEncoding, DepthTest, Effect, Grade, Limits, Operation, Property,
    Rejection, Step, ValueRange,
};
use etalon_scene::Scene;

fn case(text: &str) -> Case {
    let file = CaseFile::parse("t.json", text).expect("parses");
    file.cases(Profile::Full)
        .next()
        .expect("one case")
        .build()
        .expect("builds")
}

fn scene(attachments: &str, draws: &str, read: &str) -> Scene {
    case(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{{attachments}}},
           "passes":[{{"color":["color"],"depth_stencil":"depth","draws":[{draws}]}}],
           "read":[{read}]}}}}"#
    ))
    .scene
}

const COLOR: &str = r#""color":{"format":"rgba8unorm","size":[4,4]}"#;

#[test]
fn a_written_depth_of_zero_and_one_is_pinned_and_so_is_what_follows() {
    let scene = scene(
        &format!(r#"{COLOR},"depth":{{"format":"depth16unorm","clear":1}}"#),
        r#"{"mesh":{"kind":"columns","values":[0,1]},"shader":"flat_color_depth",
            "params":{"color":[1,0,0,1]},"depth":{"compare":"less","write":true}}"#,
        r#""color","depth""#,
    );
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
        let limits = limits(api);
        for rules in [Rules::of(&limits), Rules::yardstick(&limits)] {
            let set = legal_set(&scene, &limits, &rules);
            for (aspect, figures) in set.statistics() {
                assert_eq!(figures.exact, figures.channels, "{api} {aspect}");
            }
            let group = &set.groups[0];
            assert!(group.sample(0, 0, 0).allows(&[255, 0, 0, 255, 0]));
            assert!(group.sample(3, 3, 0).allows(&[0, 0, 0, 0, 65535]));
        }
    }
}

#[test]
fn a_vertex_depth_of_one_half_has_four_codes_on_16_bits_and_many_on_24() {
    let codes_of = |format: &str| {
        let scene = scene(
            &format!(r#"{COLOR},"depth":{{"format":"{format}","clear":1}}"#),
            r#"{"mesh":{"kind":"full","z":0.5},"shader":"uniform_color",
                "depth":{"compare":"always","write":true}}"#,
            r#""depth""#,
        );
        let set = legal_set(
            &scene,
            &limits(Api::Vulkan),
            &Rules::of(&limits(Api::Vulkan)),
        );
        set.groups[0].sample(1, 1, 0).count(0)
    };
    // Viewport, interpolation and store are each computed within 1 part in 10^5.
    assert_eq!(codes_of("depth16unorm"), 4);
    assert!((490..520).contains(&codes_of("depth24plus")));
    assert!((490..520).contains(&codes_of("depth32float")));
}

#[test]
fn a_depth_between_those_of_the_vertices_may_pass_them_by_the_error_of_interpolation() {
    let scene = scene(
        &format!(r#"{COLOR},"depth":{{"format":"depth32float","clear":1}}"#),
        r#"{"mesh":{"kind":"vertices","positions":[[-1,-1,0.75],[3,-1,0.7499999],[-1,3,0.75]]},
            "shader":"uniform_color","depth":{"compare":"always","write":true}}"#,
        r#""depth""#,
    );
    let limits = limits(Api::Vulkan);
    let set = legal_set(&scene, &limits, &Rules::of(&limits));
    let highest = set.groups[0]
        .sample(0, 0, 0)
        .hull(0)
        .expect("asserted")
        .high;
    // The vertices' own error reaches up to 0.75 * (1 + 1e-5).
    assert!(highest > i64::from((0.75_f32 * 1.000_01).to_bits()));
}

#[test]
fn an_undecided_comparison_leaves_two_joint_outcomes() {
    let scene = scene(
        &format!(r#"{COLOR},"depth":{{"format":"depth24plus","clear":0.5}}"#),
        r#"{"mesh":{"kind":"full","z":0.5},"shader":"uniform_color",
            "params":{"color":[1,1,1,1]},"depth":{"compare":"less","write":true}}"#,
        r#""color","depth""#,
    );
    let set = legal_set(
        &scene,
        &limits(Api::Vulkan),
        &Rules::of(&limits(Api::Vulkan)),
    );
    let sample = set.groups[0].sample(0, 0, 0);
    assert_eq!(sample.worlds.len(), 2);
    let half = 1 << 23;
    assert!(sample.allows(&[0, 0, 0, 0, half]));
    assert!(sample.allows(&[255, 255, 255, 255, half - 1]));
    // Half a colour, or a colour without its depth, is not consistent.
    assert!(!sample.allows(&[255, 0, 0, 0, half]));
    assert!(!sample.allows(&[0, 0, 0, 0, half - 100]));
}

const SQUARE: &str = r#"{"mesh":{"kind":"vertices","positions":[[-1,-1,0],[1,-1,0],[1,1,0],[-1,-1,0],[1,1,0],[-1,1,0]]},
    "shader":"uniform_color","stencil":{"front":{"compare":"always","pass_op":"increment-clamp"}}}"#;

#[test]
fn a_shared_diagonal_is_counted_exactly_once_where_the_rules_say_so() {
    let attachments = format!(r#"{COLOR},"depth":{{"format":"stencil8","clear":0}}"#);
    let scene = scene(&attachments, SQUARE, r#""depth""#);
    let legal = |api| {
        let limits = limits(api);
        let set = legal_set(&scene, &limits, &Rules::of(&limits));
        let sample = set.groups[0].sample(1, 2, 0).clone();
        (0..4)
            .filter(|n| sample.allows(&[*n]))
            .collect::<Vec<i64>>()
    };
    assert_eq!(legal(Api::Vulkan), [1]);
    assert_eq!(legal(Api::OpenGl), [1]);
    assert_eq!(legal(Api::WebGpu), [0, 1, 2]);
    let limits = limits(Api::Vulkan);
    let set = legal_set(&scene, &limits, &Rules::yardstick(&limits));
    assert_eq!(set.statistics()[0].1.exact, 16);
}

#[test]
fn a_scene_without_decisions_costs_no_second_world() {
    let library = etalon_case::Library::built_in();
    let reference = library.cases(Profile::Full).next().expect("a case");
    let case = reference.build().expect("builds");
    let limits = limits(Api::Vulkan);
    let set = legal_set(&case.scene, &limits, &Rules::yardstick(&limits));
    assert!(set.groups.iter().all(|g| g.distinct().len() < 256));
}

#[test]
fn a_story_names_operations_and_citations() {
    let scene = scene(
        &format!(r#"{COLOR},"depth":{{"format":"depth32float","clear":0.25}}"#),
        r#"{"mesh":{"kind":"columns","values":[0.5]},"shader":"flat_color_depth",
            "params":{"color":[1,0,0,1]},"depth":{"compare":"less","write":true}}"#,
        r#""color","depth""#,
    );
    let limits = limits(Api::Vulkan);
    let at = Sample {
        size: [4, 4],
        samples: 1,
        x: 2,
        y: 1,
        sample: 0,
    };
    let story = explain(&scene, &limits, &Rules::of(&limits), at, None);
    let mut events = story.events.iter();
    let test = events
        .find(|e| e.operation() == Operation::DepthTest)
        .expect("a depth test");
    let exact = |value| ValueRange {
        low: value,
        high: value,
    };
    let compared = DepthTest::Compared {
        compare: "less".to_owned(),
        incoming: exact(0.5),
        stored: exact(0.25),
    };
    assert_eq!(test.step, Step::DepthTest(compared));
    assert_eq!(test.effect, Effect::Rejects(Rejection::Depth));
    assert!(test.citation.as_ref().is_some_and(|c| c.contains("Depth")));
}

#[test]
fn a_story_names_the_stencil_reference_that_counts() {
    let draw = |early: &str| {
        format!(
            r#"{{"mesh":{{"kind":"full"}},"shader":"exported_color","textures":["t"],"early_tests":"{early}",
               "stencil":{{"front":{{"compare":"greater"}},"reference":9}}}}"#
        )
    };
    let attachments = format!(
        r#"{COLOR},"depth":{{"format":"stencil8","clear":5}},"t":{{"format":"rgba32float","texels":{{"kind":"rows",
           "values":[[300,0,0,1],[300,0,0,1],[300,0,0,1],[300,0,0,1]]}}}}"#
    );
    let test = |reference, exported| Step::StencilTest {
        reference,
        exported,
        compare: "greater".to_owned(),
        stored: 5,
        read_mask: 0xff,
        depth_fails: false,
    };
    let written = Step::StencilExport {
        written: 300,
        reference: 44,
        draw: 9,
    };
    let steps = [
        ("implicit", written, test(44, true)),
        (
            "forced",
            Step::LateStencilExport { draw: 9 },
            test(9, false),
        ),
    ];
    let at = Sample {
        size: [4, 4],
        samples: 1,
        x: 2,
        y: 1,
        sample: 0,
    };
    for api in [Api::Vulkan, Api::OpenGl] {
        let limits = limits(api);
        for (early, export, test) in &steps {
            let scene = scene(&attachments, &draw(early), r#""depth""#);
            let story = explain(&scene, &limits, &Rules::of(&limits), at, None);
            let event = |operation: Operation| {
                let mut events = story.events.iter();
                events.find(|e| e.operation() == operation)
            };
            let export_event = event(Operation::StencilExport).expect("an export");
            let test_event = event(Operation::StencilTest).expect("a test");
            assert_eq!((&export_event.step, &test_event.step), (export, test));
            assert!(test_event.effect.is_none(), "it passes");
        }
    }
}

/// Returns the set of two passes over `color` and `depth`, with the keys `first` and `second` added.
fn passes(api: Api, first: &str, second: &str) -> etalon_frame::LegalSet {
    let pass = |keys: &str| format!(r#"{{"color":["color"],"depth_stencil":"depth"{keys}}}"#);
    let text = format!(
        r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{{COLOR},
           "depth":{{"format":"depth24plus-stencil8","clear":{{"depth":0,"stencil":170}}}}}},
           "counters":{{"passed":"samples-passed"}},
           "passes":[{},{}],"read":["color","depth"]}}}}"#,
        pass(first),
        pass(second)
    );
    let limits = limits(api);
    legal_set(&case(&text).scene, &limits, &Rules::of(&limits))
}

#[test]
fn load_operations_and_clears_store_what_the_first_clear_stores() {
    for api in [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu] {
        let set = passes(
            api,
            r#","draws":[],"operations":{"color":[{"load":{"clear":[1,0,0,1]}}],"depth":{"load":{"clear":1}}}"#,
            r#","draws":[],"clears":[{"before":0,"color":0,"value":[0,1,1,0],"write_mask":"ga"},
               {"before":0,"stencil":255,"write_mask":15,"rect":[1,1,2,3]}]"#,
        );
        let group = &set.groups[0];
        let deep = 0xff_ffff;
        assert!(
            group.sample(0, 0, 0).allows(&[255, 255, 0, 0, deep, 170]),
            "{api}"
        );
        assert!(
            group.sample(2, 3, 0).allows(&[255, 255, 0, 0, deep, 175]),
            "{api}"
        );
        assert!(
            !group.sample(3, 3, 0).allows(&[255, 255, 0, 0, deep, 175]),
            "{api}"
        );
        let first = &group.sample(0, 0, 0).worlds;
        assert!(first[0].channels.iter().all(|c| c.is_exact()), "{api}");
    }
}

#[test]
fn clears_are_executed_between_their_draws() {
    let draw = r#"{"mesh":{"kind":"full"},"shader":"uniform_color","params":{"color":[1,0,0,1]}}"#;
    let set = passes(
        Api::Vulkan,
        &format!(
            r#","draws":[{draw},{{"mesh":{{"kind":"rect","texels":[0,0,2,4]}},"shader":"uniform_color",
               "params":{{"color":[0,0,1,0]}}}}],
               "clears":[{{"before":0,"color":0,"value":[0,0,0,0]}},
               {{"before":1,"color":0,"value":[0,1,0,1],"rect":[1,0,2,4]}},
               {{"before":2,"color":0,"value":[1,1,1,1],"rect":[0,0,4,1]}}]"#
        ),
        r#","draws":[]"#,
    );
    let group = &set.groups[0];
    let holds = |x, y, expected: [i64; 4]| {
        let worlds = &group.sample(x, y, 0).worlds;
        assert_eq!(worlds.len(), 1);
        let found: Vec<_> = worlds[0].channels[..4]
            .iter()
            .map(|c| (c.low, c.high))
            .collect();
        assert_eq!(found, expected.map(|d| (d, d)), "{x}, {y}");
    };
    holds(0, 0, [255; 4]);
    holds(1, 1, [0, 0, 255, 0]);
    holds(2, 1, [0, 255, 0, 255]);
    holds(3, 1, [255, 0, 0, 255]);
}

#[test]
fn operations_around_the_passes_of_a_query_may_count_only_in_vulkan() {
    let range = |api: Api, queries: &str, clears: &str| {
        let draw = |compare: &str| {
            format!(
                r#"{{"mesh":{{"kind":"full"}},"shader":"uniform_color","counters":["passed"],
                     "depth":{{"compare":"{compare}","write":false}}}}"#
            )
        };
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{{COLOR},
               "depth":{{"format":"depth32float","clear":0.5}}}},
               "counters":{{"passed":"samples-passed"}},"queries":"{queries}",
               "passes":[{{"color":["color"],"depth_stencil":"depth","draws":[{},{}]{clears}}}],
               "read":["color"]}}}}"#,
            draw("always"),
            draw("never"),
        );
        let limits = limits(api);
        let set = legal_set(&case(&text).scene, &limits, &Rules::of(&limits));
        (set.counters[0].range.low, set.counters[0].range.high)
    };
    let between = r#","clears":[{"before":1,"color":0,"value":[1,0,0,1]}]"#;
    let around = r#","clears":[{"before":0,"depth":0.25},{"before":2,"depth":0.75}]"#;
    for (api, open) in [(Api::Vulkan, None), (Api::OpenGl, Some(16))] {
        assert_eq!(range(api, "draw", between), (16, Some(16)), "{api}");
        assert_eq!(range(api, "pass", around), (16, Some(16)), "{api}");
        assert_eq!(range(api, "pass", between), (16, Some(16)), "{api}");
        assert_eq!(range(api, "frame", ""), (16, open), "{api}");
    }
}

#[test]
fn values_that_depend_on_discarded_contents_are_not_asserted() {
    let draw = |compare: &str| {
        format!(
            r#","draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color","counters":["passed"],
               "params":{{"color":[1,0,0,1]}},"depth":{{"compare":"{compare}","write":false}}}}]"#
        )
    };
    let discard = r#","draws":[],"operations":{"depth":{"store":"discard"}}"#;
    let shares = |first: &str, second: &str| {
        let set = passes(Api::Vulkan, first, second);
        let range = set.counters[0].range;
        let figures = set.statistics().iter();
        let asserted: Vec<u64> = figures.map(|(_, f)| f.asserted).collect();
        (asserted, range.low, range.high)
    };
    assert_eq!(shares(discard, &draw("greater")), (vec![0, 0, 16], 0, None));
    assert_eq!(
        shares(discard, &draw("always")),
        (vec![64, 0, 16], 16, Some(16))
    );
    let cleared = format!(
        r#"{},"operations":{{"depth":{{"load":{{"clear":1}}}}}}"#,
        draw("less")
    );
    assert_eq!(shares(discard, &cleared), (vec![64, 16, 16], 16, Some(16)));
}

/// Returns the set of `one`, to which four samples of depth and stencil are resolved: 0, 1, 0.5, 1 and 7, 3,
/// 9, 3.
fn resolved(format: &str, depth: &str, stencil: &str) -> etalon_frame::LegalSet {
    let values = [(0.0, 7), (1.0, 3), (0.5, 9), (1.0, 3)]
        .into_iter()
        .enumerate();
    let draws: Vec<String> = values
        .map(|(sample, (depth, stencil))| {
            format!(
                r#"{{"mesh":{{"kind":"cover","value":{depth}}},"shader":"flat_color_depth",
                   "depth":{{"compare":"always","write":true}},
                   "stencil":{{"front":{{"compare":"always","pass_op":"replace"}},"reference":{stencil}}},
                   "multisample":{{"mask":{}}}}}"#,
                1 << sample
            )
        })
        .collect();
    let text = format!(
        r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{
           "many":{{"format":"{format}","size":[2,2],"samples":4}},
           "one":{{"format":"{format}","clear":{{"depth":0.25,"stencil":100}}}}}},
           "passes":[{{"depth_stencil":"many","draws":[{}],"depth_stencil_resolve":
           {{"to":"one","depth":"{depth}","stencil":"{stencil}"}}}}],"read":["one"]}}}}"#,
        draws.join(",")
    );
    let limits = limits(Api::Vulkan);
    legal_set(&case(&text).scene, &limits, &Rules::of(&limits))
}

#[test]
fn depth_and_stencil_are_resolved_each_by_its_mode() {
    let code = |value: f32| i64::from(value.to_bits());
    for (depth, stencil, expected) in [
        ("sample-zero", "sample-zero", [code(0.0), 7]),
        ("max", "min", [code(1.0), 3]),
        ("min", "max", [code(0.0), 9]),
        ("none", "max", [code(0.25), 9]),
        ("max", "none", [code(1.0), 100]),
    ] {
        let set = resolved("depth32float-stencil8", depth, stencil);
        let worlds = &set.groups[0].sample(1, 1, 0).worlds;
        assert_eq!(worlds.len(), 1, "{depth}, {stencil}");
        let found: Vec<_> = worlds[0].channels.iter().map(|c| (c.low, c.high)).collect();
        assert_eq!(found, expected.map(|d| (d, d)), "{depth}, {stencil}");
    }
}

#[test]
fn a_resolve_of_a_possible_nan_may_be_anything() {
    // A colour with alpha 0, by which advanced blending divides.
    let text = r#"{"about":"t","spec":["t"],"scene":{"attachments":{
        "many":{"format":"rgba16float","size":[1,1],"samples":2},
        "one":{"format":"rgba16float"}},
        "passes":[{"color":["many"],"resolve":["one"],"draws":[{"mesh":{"kind":"full"},
        "shader":"uniform_color","params":{"color":[0,0,1,0]},"advanced_blend":"multiply"}]}],
        "read":["one"]}}"#;
    let limits = limits(Api::Vulkan);
    let set = legal_set(&case(text).scene, &limits, &Rules::of(&limits));
    for world in &set.groups[0].sample(0, 0, 0).worlds {
        let blue = world.channels[2];
        assert_eq!((blue.low, blue.high), (-0x7fff, 0x7fff));
    }
}

#[test]
fn an_average_depth_may_be_a_little_off_and_no_more() {
    let set = resolved("depth32float-stencil8", "average", "min");
    let sample = set.groups[0].sample(0, 0, 0);
    let code = |value: f32| i64::from(value.to_bits());
    for (value, allowed) in [
        (0.625, true),
        (0.625_001, true),
        (0.624, false),
        (0.63, false),
    ] {
        assert_eq!(sample.allows(&[code(value), 3]), allowed, "{value}");
    }
}

#[test]
fn a_line_between_texels_that_its_viewport_clips_is_not_lost() {
    let scene = case(
        r#"{"about":"t","spec":["t"],"scene":{
            "attachments":{"color":{"format":"rgba8unorm","size":[7,64]}},
            "passes":[{"color":["color"],"draws":[{
                "mesh":{"kind":"vertices","units":"texels",
                    "positions":[[-0.25,13.75,0.17],[0.5,38.5,0.17]]},
                "params":{"color":[1,1,1,1]},"shader":"uniform_color","topology":"line-list",
                "viewport":{"rect":[4,0,1,255],"depth":[0,0]}}]}],
            "read":["color"]}}"#,
    )
    .scene;
    let limits = limits(Api::Vulkan);
    let set = legal_set(&scene, &limits, &Rules::of(&limits));
    let group = &set.groups[0];
    // No other texel of these rows is inside the viewport.
    let drawn = |y: u32| group.sample(4, y, 0).allows(&[255; 4]);
    let rows: Vec<u32> = (0..64).filter(|y| drawn(*y)).collect();
    assert!(rows.contains(&22) && rows.contains(&23), "{rows:?}");
}

/// Returns which texels of row 3 can be red and which must be, with a viewport that begins at column 4.
fn beside_the_viewport(topology: &str, positions: &str, limits: &Limits) -> Vec<(bool, bool)> {
    in_viewport(4.0, topology, positions, limits, &Rules::of(limits))
}

/// Returns which texels of row 3 can be red and which must be, with a viewport that begins at a column.
fn in_viewport(
    left: f32,
    topology: &str,
    positions: &str,
    limits: &Limits,
    rules: &Rules,
) -> Vec<(bool, bool)> {
    let scene = case(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"color":{{"format":"rgba8unorm","size":[8,8]}}}},
            "passes":[{{"color":["color"],"draws":[{{
                "mesh":{{"kind":"vertices","units":"texels","positions":{positions}}},
                "params":{{"color":[1,1,1,1]}},"shader":"uniform_color","topology":"{topology}",
                "viewport":{{"rect":[{left},0,4,8],"depth":[0,1]}}}}]}}],
            "read":["color"]}}}}"#
    ))
    .scene;
    let set = legal_set(&scene, limits, rules);
    let texel = |x: u32| set.groups[0].sample(x, 3, 0);
    let both = |x: u32| (texel(x).allows(&[255; 4]), !texel(x).allows(&[0; 4]));
    (0..8).map(both).collect()
}

/// Returns the limits of a version, with or without Vulkan's promise to discard points outside the view
/// volume.
fn clipping_limits(api: Api, version: [u8; 2], promise: bool) -> Limits {
    let mut limits = limits(api);
    limits.version = ApiVersion::new(version[0], version[1]);
    if promise {
        limits.properties = Property::ALL.into_iter().collect();
    }
    limits
}

#[test]
fn a_point_beside_the_viewport_is_discarded_if_the_specification_says_so() {
    for (api, version, promise, may) in [
        (Api::OpenGl, [3, 3], false, false),
        (Api::OpenGl, [4, 5], false, false),
        (Api::OpenGl, [4, 6], false, true),
        (Api::OpenGlEs, [3, 0], false, true),
        (Api::OpenGlEs, [3, 2], false, true),
        (Api::Vulkan, [1, 3], false, true),
        (Api::Vulkan, [1, 3], true, false),
        (Api::WebGpu, [0, 0], false, false),
    ] {
        let limits = clipping_limits(api, version, promise);
        for (x, column) in [("-0.5", 3), ("-3.5", 0)] {
            let texels = beside_the_viewport("point-list", &format!("[[{x},3.5,0]]"), &limits);
            let mut expected = vec![(false, false); 8];
            expected[column].0 = may;
            assert_eq!(texels, expected, "{api} {version:?} {promise}");
        }
        // A point inside is drawn, whatever the specification says about others.
        let inside = beside_the_viewport("point-list", "[[1.5,3.5,0]]", &limits);
        assert_eq!(inside[5], (true, true), "{api}");
    }
}

/// Clipping comes before snapping: on the side a point is drawn, and a thousandth of a texel outside it need
/// not be, though both are snapped to the side.
#[test]
fn a_point_is_clipped_before_it_is_snapped() {
    for api in [Api::OpenGl, Api::OpenGlEs, Api::Vulkan] {
        let limits = limits(api);
        for (x, drawn) in [("0", (true, true)), ("-0.001", (true, false))] {
            let positions = format!("[[{x},3.25,0]]");
            let rules = Rules::yardstick(&limits);
            let texels = in_viewport(4.25, "point-list", &positions, &limits, &rules);
            assert_eq!(texels[4], drawn, "{api} {x}");
        }
    }
}

#[test]
fn a_point_before_the_near_plane_may_be_drawn_in_vulkan_without_the_promise() {
    for (api, promise, may) in [
        (Api::OpenGl, false, false),
        (Api::OpenGlEs, false, false),
        (Api::Vulkan, false, true),
        (Api::Vulkan, true, false),
    ] {
        let limits = clipping_limits(api, [9, 9], promise);
        let texels = beside_the_viewport("point-list", "[[1.5,3.5,-0.5]]", &limits);
        assert_eq!(texels[5], (may, false), "{api} {promise}");
    }
}

#[test]
fn a_line_may_leave_the_viewport_if_the_specification_permits_it() {
    for (api, may) in [
        (Api::OpenGl, false),
        (Api::WebGpu, false),
        (Api::OpenGlEs, true),
        (Api::Vulkan, true),
    ] {
        let limits = clipping_limits(api, [9, 9], true);
        let texels = |positions| beside_the_viewport("line-list", positions, &limits);
        let crossing = texels("[[-3.75,3.5,0],[3.75,3.5,0]]");
        assert_eq!(crossing[0].0, may, "{api}: {crossing:?}");
        assert!(crossing[5].1, "{api}: {crossing:?}");
        // A line wholly outside is discarded or drawn whole.
        let outside = texels("[[-3.75,3.5,0],[-0.25,3.5,0]]");
        assert_eq!(outside[3].0, may, "{api}: {outside:?}");
        assert!(outside.iter().all(|texel| !texel.1), "{api}: {outside:?}");
    }
}

#[test]
fn alpha_does_nothing_to_the_coverage_of_integers() {
    let scene = case(
        r#"{"about":"t","spec":["t"],"scene":{
            "attachments":{"color":{"format":"rgba8uint","size":[2,2],"samples":4}},
            "passes":[{"color":["color"],"draws":[{
                "mesh":{"kind":"full"},"shader":"uint_color","params":{"color":[7,0,0,0]},
                "multisample":{"alpha_to_coverage":true,"alpha_to_one":true}}]}],
            "read":["color"]}}"#,
    )
    .scene;
    for api in [Api::Vulkan, Api::OpenGl] {
        let limits = limits(api);
        let set = legal_set(&scene, &limits, &Rules::of(&limits));
        let sample = set.groups[0].sample(0, 0, 3);
        assert!(sample.allows(&[7, 0, 0, 0]), "{api}");
        assert!(
            !sample.allows(&[0; 4]) && !sample.allows(&[7, 0, 0, 1]),
            "{api}"
        );
    }
}

/// Returns whether a draw with this alpha to coverage may leave the stencil and whether it may write it, in a pass
/// without colour attachments.
fn colorless(api: Api, alpha: u8) -> [bool; 2] {
    let scene = case(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
            "attachments":{{"stencil":{{"format":"stencil8","size":[1,1],"samples":4,"clear":9}}}},
            "passes":[{{"color":[],"depth_stencil":"stencil","draws":[{{
                "mesh":{{"kind":"full"}},"shader":"uniform_color","params":{{"color":[0,0,0,{alpha}]}},
                "multisample":{{"alpha_to_coverage":true}},
                "stencil":{{"front":{{"compare":"always","pass_op":"zero"}}}}}}]}}],
            "read":["stencil"]}}}}"#
    ))
    .scene;
    let limits = limits(api);
    let set = legal_set(&scene, &limits, &Rules::of(&limits));
    [9, 0].map(|stencil| set.groups[0].sample(0, 0, 0).allows(&[stencil]))
}

#[test]
fn without_colour_attachments_alpha_covers_what_a_case_of_the_cts_without_them_demands() {
    for alpha in [0, 1] {
        assert_eq!(colorless(Api::OpenGl, alpha), [true, true], "{alpha}");
        assert_eq!(colorless(Api::OpenGlEs, alpha), [true, true], "{alpha}");
    }
    assert_eq!(colorless(Api::Vulkan, 0), [true, true]);
    assert_eq!(colorless(Api::Vulkan, 1), [false, true]);
}

/// Returns true for each depth that a polygon of one depth may have after a constant bias of 255.
fn may_be_biased_to<const N: usize>(z: f32, depths: [f32; N]) -> [bool; N] {
    let scene = scene(
        &format!(r#"{COLOR},"depth":{{"format":"depth32float","clear":1}}"#),
        &format!(
            r#"{{"mesh":{{"kind":"full","z":{z:e}}},"shader":"uniform_color","depth_bias":{{"constant":255}},
                "depth":{{"compare":"always","write":true}}}}"#
        ),
        r#""depth""#,
    );
    let limits = limits(Api::Vulkan);
    let set = legal_set(&scene, &limits, &Rules::of(&limits));
    let sample = set.groups[0].sample(0, 0, 0);
    depths.map(|depth| sample.allows(&[i64::from(depth.to_bits())]))
}

#[test]
fn a_bias_whose_unit_is_no_normal_number_is_unknown() {
    // No depth has a unit above 2^-23.
    let most = 255.0 * f32::EPSILON;
    let depths = [0.0, f32::MIN_POSITIVE, most, 2.0 * most];
    assert_eq!(may_be_biased_to(0.0, depths), [true, true, true, false]);
    let z = f32::MIN_POSITIVE * 8_388_608.0;
    assert_eq!(may_be_biased_to(z / 2.0, [z / 2.0, most]), [true, true]);
    let biased = f32::from_bits(z.to_bits() + 255);
    assert_eq!(may_be_biased_to(z, [biased, z * 1.5]), [true, false]);
}

#[test]
fn samples_of_minus_one_are_read_as_either_code() {
    // A logic operation alone stores the least code, and no API can copy several samples out unresolved.
    let legal_with = |samples: u32| {
        let scene = case(&format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
               "attachments":{{"c":{{"format":"rgba8snorm","size":[1,1],"samples":{samples}}}}},
               "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"cover"}},"shader":"uniform_color",
                   "params":{{"color":[1,0,1,1]}},"logic":"equivalent"}}]}}],"read":["c"]}}}}"#
        ))
        .scene;
        let limits = limits(Api::Vulkan);
        legal_set(&scene, &limits, &Rules::of(&limits))
    };
    let allows = |samples: u32| {
        let set = legal_with(samples);
        let sample = set.groups[0].sample(0, 0, 0);
        [-128, -127, -126].map(|code| sample.allows(&[code, -1, code, code]))
    };
    assert_eq!(allows(1), [true, false, false]);
    assert_eq!(allows(4), [true, true, false]);
}

#[test]
fn opengl_3_may_clamp_biased_depths_at_vertices() {
    let scene = case(
        r#"{"about":"t","spec":["t"],"scene":{
           "attachments":{"d":{"format":"depth32float","size":[1,1]}},
           "passes":[{"depth_stencil":"d","draws":[{"depth":{"compare":"always","write":true},
               "depth_bias":{"slope":1.0},"shader":"uniform_color","mesh":{"kind":"vertices","units":"texels",
               "positions":[[0.5,1.75,0.0],[-0.75,0.5,0.57],[2.5,0.0,0.97]]}}]}],"read":["d"]}}"#,
    )
    .scene;
    let allows = |version: ApiVersion, depth: f32| {
        let limits = Limits {
            version,
            ..limits(Api::OpenGl)
        };
        let set = legal_set(&scene, &limits, &Rules::of(&limits));
        let sample = set.groups[0].sample(0, 0, 0);
        sample.allows(&[i64::from(depth.to_bits())])
    };
    // The depth of 0.63 at the texel and a slope of 0.5 add up to more than 1; the nearest vertex stays
    // below.
    for (version, at_vertices) in [
        ((3, 3), true),
        ((4, 1), true),
        ((4, 2), false),
        ((4, 6), false),
    ] {
        let version = ApiVersion::new(version.0, version.1);
        assert!(allows(version, 1.0), "{version}");
        assert_eq!(allows(version, 0.954_791_67), at_vertices, "{version}");
        assert!(!allows(version, 0.6), "{version}");
    }
}

#[test]
fn the_step_of_a_float_bias_is_that_of_the_clipped_primitive() {
    let allows = |positions: &str, depth: f32| {
        let scene = case(&format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
               "attachments":{{"d":{{"format":"depth32float","size":[1,1]}}}},
               "passes":[{{"depth_stencil":"d","draws":[{{"depth":{{"compare":"always","write":true}},
                   "depth_bias":{{"constant":1000000}},"shader":"uniform_color",
                   "mesh":{{"kind":"vertices","positions":[{positions}]}}}}]}}],"read":["d"]}}}}"#
        ))
        .scene;
        let limits = limits(Api::Vulkan);
        let set = legal_set(&scene, &limits, &Rules::of(&limits));
        let sample = set.groups[0].sample(0, 0, 0);
        sample.allows(&[i64::from(depth.to_bits())])
    };
    // The depth of 0.55 is far outside, and the drawn part is below 0.5.
    let beyond = "[-1,-1,0.45],[-1,6,0.45],[18,-1,0.55]";
    assert!(allows(beyond, 0.485_065_46) && allows(beyond, 0.514_867_8));
    assert!(!allows(beyond, 0.6));
    let within = "[-1,-1,0.45],[-1,1,0.45],[1,-1,0.55]";
    assert!(!allows(within, 0.529_8) && allows(within, 0.559_6));
}

#[test]
fn the_least_signed_code_is_resolved_to_itself_or_to_the_code_of_its_value() {
    let case = case(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"many":{"format":"rgba8snorm","samples":2,"size":[1,1]},"one":{"format":"rgba8snorm"}},
        "passes":[{"color":["many"],"resolve":["one"],"draws":[{"logic":"nor","mesh":{"kind":"full"},
        "params":{"color":1},"shader":"uniform_color"}]}],"read":["one"]}}"#,
    );
    let limits = limits(Api::Vulkan);
    let set = legal_set(&case.scene, &limits, &Rules::of(&limits));
    let sample = set.groups[0].sample(0, 0, 0);
    for (order, legal) in [(-128, true), (-127, true), (-126, false), (127, false)] {
        assert_eq!(sample.allows(&[order; 4]), legal, "{order}");
    }
}

/// Returns true if NaN is legal after a draw over a colour of 32-bit floats.
fn may_become_nan(stored: [f32; 4], draw: &str) -> bool {
    may_draws_become_nan(stored, &[draw])
}

/// Returns true if NaN is legal after draws over a colour of 32-bit floats.
fn may_draws_become_nan(stored: [f32; 4], draws: &[&str]) -> bool {
    let draws = draws
        .iter()
        .map(|draw| format!(r#"{{"mesh":{{"kind":"full"}},"shader":"uniform_color",{draw}}}"#));
    let draws = draws.collect::<Vec<_>>().join(",");
    let case = case(&format!(
        r#"{{"about":"t","spec":["t"],"scene":{{
        "attachments":{{"color":{{"format":"rgba32float","size":[1,1],"clear":{stored:?}}}}},
        "passes":[{{"color":["color"],"draws":[{draws}]}}],
        "read":["color"]}}}}"#
    ));
    let limits = limits(Api::Vulkan);
    let set = legal_set(&case.scene, &limits, &Rules::of(&limits));
    let nan = ChannelEncoding::Float32.order_of_code(f32::NAN.to_bits());
    set.groups[0].sample(0, 0, 0).allows(&[nan; 4])
}

#[test]
fn a_blend_that_can_overflow_on_the_way_may_become_nan() {
    let multiply = r#""advanced_blend":"multiply","params":{"color":[0,0,0,255]}"#;
    assert!(may_become_nan([0.0, 0.0, 0.0, 2e38], multiply));
    assert!(!may_become_nan([0.0, 0.0, 0.0, 1.0], multiply));
    let difference = |constant: f32| {
        format!(
            r#""params":{{"color":[2e38,2e38,2e38,2e38]}},"blend_constant":[{constant},{constant},{constant},{constant}],
            "blend":{{"color":{{"operation":"subtract","src_factor":"constant","dst_factor":"constant"}},
            "alpha":{{"operation":"subtract","src_factor":"constant-alpha","dst_factor":"constant-alpha"}}}}"#
        )
    };
    assert!(may_become_nan([2e38; 4], &difference(4.0)));
    assert!(!may_become_nan([2e38; 4], &difference(0.5)));
}

#[test]
fn a_factor_of_zero_may_multiply_an_infinity() {
    let twice = r#""params":{"color":[2e38,2e38,2e38,2e38]},
        "blend":{"color":{"operation":"add","src_factor":"one","dst_factor":"one"},
        "alpha":{"operation":"add","src_factor":"one","dst_factor":"one"}}"#;
    let replace = |factor: &str| {
        format!(
            r#""params":{{"color":[1,1,1,1]}},
            "blend":{{"color":{{"operation":"add","src_factor":"one","dst_factor":"{factor}"}},
            "alpha":{{"operation":"add","src_factor":"one","dst_factor":"{factor}"}}}}"#
        )
    };
    let (zero, one) = (replace("zero"), replace("one"));
    assert!(may_draws_become_nan([2e38; 4], &[twice, &zero]));
    assert!(!may_draws_become_nan([2e38; 4], &[twice, &one]));
    assert!(!may_draws_become_nan([1e38; 4], &[twice, &zero]));
}

#[test]
fn filtering_may_round_each_step_to_codes() {
    let case = case(
        r#"{"about":"t","spec":["t"],"scene":{
        "attachments":{"color":{"format":"rgba32float","size":[4,4]},
        "sampled":{"format":"rgba8unorm","size":[2,2],"texels":{"kind":"columns",
        "values":[[0,0,0,255],[3,0,0,255]]}}},
        "passes":[{"color":["color"],"draws":[{"mesh":{"kind":"cover","uv":[0.5,0.5,0.5,0.5]},
        "sampler":{"address":["clamp-to-edge","clamp-to-edge"],"filter":"linear"},
        "shader":"sampled_color","textures":["sampled"]}]}],"read":["color"]}}"#,
    );
    let limits = limits(Api::Vulkan);
    let order = |v: f32| ChannelEncoding::Float32.order_of_code(v.to_bits());
    let allows = |rules: &Rules, red: f32, alpha: f32| {
        let set = legal_set(&case.scene, &limits, rules);
        let value = [red / 255.0, 0.0, 0.0, alpha / 255.0].map(order);
        set.groups[0].sample(1, 1, 0).allows(&value)
    };
    let (text, yardstick) = (Rules::of(&limits), Rules::yardstick(&limits));
    // Between the codes 0 and 3.
    for (red, legal) in [
        (1.5, true),
        (1.0, true),
        (2.0, true),
        (0.0, false),
        (3.0, false),
    ] {
        assert_eq!(allows(&text, red, 255.0), legal, "{red}");
        assert_eq!(allows(&yardstick, red, 255.0), red == 1.5, "{red}");
    }
    // Equal texels give only one result.
    assert!(!allows(&text, 1.5, 254.0));
}

#[test]
fn an_index_that_may_be_no_restart_opens_every_texel_of_the_scissor_rectangle() {
    let scene = case(
        r#"{"about":"t","spec":["t"],"scene":{
           "attachments":{"c":{"format":"rgba8unorm","size":[4,4]}},
           "passes":[{"color":["c"],"draws":[{"shader":"uniform_color","scissor":[0,0,4,2],
               "mesh":{"kind":"vertices","units":"texels","positions":[[0,0,0],[2,0,0],[0,2,0]],
               "indices":[0,1,2,null,0,2,1]},
               "topology":"triangle-strip","fetch":{"index":"uint16","base_vertex":1}}]}],"read":["c"]}}"#,
    )
    .scene;
    let limits = limits(Api::WebGpu);
    let text = Rules::of(&limits);
    let proven = text.bound_by(Grade::Proven);
    let is_open = |rules: &Rules, y: u32| {
        let set = legal_set(&scene, &limits, rules);
        set.groups[0].sample(3, y, 0).is_open()
    };
    // No triangle of the mesh reaches the last column.
    assert!(!is_open(&text, 0));
    assert!(is_open(&proven, 0));
    assert!(!is_open(&proven, 3));
}

#[test]
fn states_of_coverage_act_on_one_sample_in_vulkan_and_are_skipped_in_opengl() {
    let drawn = |api: Api, state: &str| {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"scene":{{"attachments":{{"c":{{"format":"rgba8unorm","size":[2,2]}}}},
               "passes":[{{"color":["c"],"draws":[{{"mesh":{{"kind":"full"}},"shader":"uniform_color",
               "params":{{"color":[1,0,1,0]}},"early_tests":"forced","multisample":{{{state}}}}}]}}],
               "read":["c"]}}}}"#
        );
        let limits = limits(api);
        let set = legal_set(&case(&text).scene, &limits, &Rules::of(&limits));
        let worlds = &set.groups[0].sample(1, 1, 0).worlds;
        let codes = worlds.iter().map(|w| [0, 3].map(|c| w.channels[c].low));
        codes.collect::<Vec<_>>()
    };
    let masked = r#""mask":4294967294"#;
    let one = r#""alpha_to_one":true"#;
    assert_eq!(drawn(Api::Vulkan, masked), [[0, 0]]);
    assert_eq!(drawn(Api::WebGpu, masked), [[0, 0]]);
    assert_eq!(drawn(Api::Vulkan, one), [[255, 255]]);
    for api in [Api::OpenGl, Api::OpenGlEs] {
        assert_eq!(drawn(api, masked), [[255, 0]], "{api:?}");
        assert_eq!(drawn(api, one), [[255, 0]], "{api:?}");
    }
}

#[test]
fn a_plane_that_clips_leaves_samples_open_whose_positions_are_open() {
    // The sides of the viewport and the near plane cut through texels 14 and 5, beside most positions.
    let cut = |api: Api, mesh: &str, viewport: &str, x: u32| {
        let scene = case(&format!(
            r#"{{"about":"t","spec":["t"],"scene":{{
               "attachments":{{"c":{{"format":"rgba8unorm","size":[16,16],"samples":4}}}},
               "passes":[{{"color":["c"],"draws":[{{"mesh":{mesh},"shader":"uniform_color",
                 "params":{{"color":[1,1,1,1]}},"viewport":{{"rect":{viewport},"depth":[0,1]}}}}]}}],"read":["c"]}}}}"#
        ))
        .scene;
        let limits = limits(api);
        let set = legal_set(&scene, &limits, &Rules::of(&limits).bound_by(Grade::Proven));
        let sample = |i| set.groups[0].sample(x, 5, i).count(0);
        [0, 1, 2, 3].map(sample)
    };
    let full = r#"{"kind":"full"}"#;
    let near = r#"{"kind":"vertices","positions":[[-1,-1,-0.6],[3,-1,1.4],[-1,3,-0.6]]}"#;
    for api in [Api::OpenGl, Api::OpenGlEs] {
        assert_eq!(cut(api, full, "[2.25,1,12,12]", 14), [2; 4], "{api}");
        assert_eq!(cut(api, near, "[0.25,0,16,16]", 9), [2; 4], "{api}");
    }
    assert_eq!(cut(Api::Vulkan, full, "[2.25,1,12,12]", 14), [1; 4]);
}
