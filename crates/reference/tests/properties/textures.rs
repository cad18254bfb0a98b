//! Shaders that compute, and passes that read earlier ones: the twins' plain results are inside the judging
//! ones, and the rasterizer's frames are legal.

use crate::common::{APIS, all_rules, config, draw, limits, scene};
use etalon_case::{Library, Profile};
use etalon_frame::{Comparison, Frame, LegalSet, compare};
use etalon_pipeline::Plain;
use etalon_pipeline::shader::{FragmentInput, FragmentOutput, InputMask, List, Taps, fragment};
use etalon_reference::{Interval, Judging, Range, Texels, judgements, judgements_of};
use etalon_scene::{Params, Scene, Shader};
use proptest::prelude::*;
use proptest::sample::select;

/// A number, and the width of its interval to either side.
type Known = (f32, [f64; 2]);

fn known() -> impl Strategy<Value = Known> {
    let value = prop_oneof![
        3 => select(vec![0.0_f32, 1.0, 0.5, 0.25, -0.25, -1.0, 2.0, 100.0, 0.01]),
        2 => 0.0_f32..=1.0,
        1 => -3.0_f32..=3.0,
    ];
    let reach = || select(vec![0.0, 0.0, 1e-7, 1e-3, 0.5]);
    (value, [reach(), reach()])
}

fn four() -> impl Strategy<Value = [Known; 4]> {
    [known(), known(), known(), known()]
}

fn judged((value, [below, above]): Known) -> Range {
    let value = f64::from(value);
    Range::same(Interval::between(value - below, value + above))
}

/// A fragment's inputs.
#[derive(Clone, Debug)]
struct Inputs {
    color: [Known; 4],
    depth: Known,
    position: [Known; 2],
    uv: [Known; 2],
    texels: [[Known; 4]; 2],
    params: Params,
    sample: u32,
    front: bool,
}

fn inputs() -> impl Strategy<Value = Inputs> {
    let depth = (
        prop_oneof![select(vec![0.0_f32, 0.25, 0.5, 1.0]), 0.0_f32..=1.0],
        select(vec![[0.0, 0.0], [1e-6, 1e-6]]),
    );
    (
        four(),
        depth,
        [known(), known()],
        [four(), four()],
        [four(), four()],
        (0_u32..8, any::<bool>(), [known(), known()]),
    )
        .prop_map(
            |(color, depth, uv, texels, params, (sample, front, position))| {
                let [color_of_params, back_color] = params.map(|p| p.map(|(v, _)| v));
                Inputs {
                    color,
                    depth,
                    position,
                    uv,
                    texels,
                    params: Params {
                        color: color_of_params,
                        back_color,
                    },
                    sample,
                    front,
                }
            },
        )
}

fn plain(shader: Shader, inputs: &Inputs) -> FragmentOutput<[f32; 1]> {
    let input = FragmentInput {
        color: inputs.color.map(|(v, _)| [v]),
        front: inputs.front,
        depth: [inputs.depth.0],
        sample: inputs.sample,
        mask: InputMask::NONE,
        position: inputs.position.map(|(v, _)| [v]),
        texels: inputs.texels.map(|texel| texel.map(|(v, _)| [v])),
        neighbours: None,
        taps: Taps::NONE,
        list: List::Unknown,
        reciprocal_w: [inputs.depth.0],
        uv: inputs.uv.map(|(v, _)| [v]),
        params: &inputs.params,
    };
    fragment(&mut Plain::<1>, shader, &input)
}

/// True if a judging result allows a plain one; NaN requires that it allows all values.
fn holds(range: Range, [value]: [f32; 1]) -> bool {
    let range = range.hull();
    if value.is_nan() {
        range.may_be_nan()
    } else {
        range.contains(f64::from(value))
    }
}

/// The values that both outputs have.
fn pairs(
    plain: &FragmentOutput<[f32; 1]>,
    judged: &FragmentOutput<Range>,
) -> Vec<(String, Range, [f32; 1])> {
    let mut comparisons = Vec::new();
    for location in 0..3 {
        let (p, j) = (plain.at_location(location), judged.at_location(location));
        for c in 0..4 {
            comparisons.push((format!("location {location}, channel {c}"), j[c], p[c]));
        }
    }
    if let (Some(p), Some(j)) = (plain.depth, judged.depth) {
        comparisons.push(("depth".to_owned(), j, p));
    }
    if let (Some(p), Some(j)) = (&plain.reference, &judged.reference) {
        comparisons.push(("stencil reference".to_owned(), j.number, p.number));
    }
    if let (Some(p), Some(j)) = (&plain.mask, &judged.mask) {
        comparisons.push(("sample mask".to_owned(), j.bits, p.bits));
    }
    if let (Some(p), Some(j)) = (&plain.kept, &judged.kept) {
        comparisons.push(("kept value".to_owned(), j.value, p.value));
        comparisons.push(("kept limit".to_owned(), j.limit, p.limit));
    }
    comparisons
}

proptest! {
    #![proptest_config(config(3000))]

    #[test]
    fn a_plain_fragment_is_inside_every_judged_one(inputs in inputs()) {
        for shader in Shader::ALL.iter().copied() {
            let plain = plain(shader, &inputs);
            for rules in all_rules() {
                let input = FragmentInput {
                    color: inputs.color.map(judged),
                    front: inputs.front,
                    depth: judged(inputs.depth),
                    sample: inputs.sample,
                    mask: InputMask::NONE,
                    position: inputs.position.map(judged),
                    texels: inputs.texels.map(|texel| texel.map(judged)),
                    neighbours: None,
                    taps: Taps::NONE,
        list: List::Unknown,
                    reciprocal_w: judged(inputs.depth),
                    uv: inputs.uv.map(judged),
                    params: &inputs.params,
                };
                let judged = fragment(&mut Judging::new(&rules), shader, &input);
                prop_assert_eq!(plain.others.is_some(), judged.others.is_some());
                prop_assert_eq!(plain.depth.is_some(), shader.writes_depth());
                prop_assert_eq!(plain.kept.is_some(), shader.discards());
                prop_assert_eq!(plain.mask.is_some(), shader.writes_mask());
                prop_assert_eq!(plain.reference.is_some(), shader.writes_reference());
                for (what, range, value) in pairs(&plain, &judged) {
                    prop_assert!(
                        holds(range, value),
                        "{}, {}, {what}: {value:?} is not in {:?}", shader.name(), rules.name, range.hull()
                    );
                }
            }
        }
    }
}

/// Compares the rasterizer's frame with both bands of every API. Returns the frame and its judgement by
/// Vulkan's rules.
fn legal(scene: &Scene) -> (Frame, Comparison) {
    let frame = draw(scene);
    let mut first = None;
    for api in APIS {
        for judgement in judgements(scene, &limits(api)) {
            let found = compare(&frame, &judgement.legal, &judgement.yardstick, 3);
            let found = found.unwrap_or_else(|e| panic!("{api:?}: {e}"));
            let counts = (found.texels.wrong, found.texels.imprecise);
            assert_eq!(counts, (0, 0), "{api:?}: {:?}", found.wrong);
            first.get_or_insert(found);
        }
    }
    (frame, first.expect("Vulkan has one alternative at least"))
}

/// True if a set holds exactly one value at every sample.
fn is_exact(set: &LegalSet) -> bool {
    set.statistics().iter().all(|(_, s)| s.exact == s.channels)
}

#[test]
fn output_of_an_earlier_pass_is_read_exactly() {
    for (format, samples) in [("rgba8unorm", 1), ("rgb10a2unorm", 4), ("rgba16float", 1)] {
        let scene = scene(&format!(
            r#"{{"attachments":{{
            "left":{{"format":"{format}","size":[8,8],"clear":[0,1,0,1]}},
            "target":{{"format":"{format}","size":[8,8],"samples":{samples}}},
            "single":{{"format":"{format}","size":[8,8]}}}},
            "passes":[
            {{"color":["left"],"draws":[{{"mesh":{{"kind":"columns","values":[[1,0,0,1],[0,0,1,0],[1,1,1,1]]}},
              "shader":"flat_color","scissor":[0,0,8,4]}}]}},
            {{"color":["target"],"resolve":[{resolve}],"draws":[{{"mesh":{{"kind":"cover"}},
              "shader":"texel_color","textures":["left"]}}]}}],
            "read":["target","single"]}}"#,
            resolve = if samples > 1 { "\"single\"" } else { "null" },
        ));
        let (_, found) = legal(&scene);
        assert_eq!(found.texels.open, 0, "{format}");
        for judgement in judgements(&scene, &limits(etalon_frame::Api::Vulkan)) {
            assert!(is_exact(&judgement.yardstick), "{format}");
        }
    }
}

/// Flat layers over the picture, farthest first, and a number of peeling passes.
fn peeled(steps: usize) -> Scene {
    let layers = [("[0,0,1,1]", 0.75), ("[0,1,0,1]", 0.5), ("[1,0,0,1]", 0.25)];
    let mut attachments =
        String::from(r#""before0":{"format":"rgba32float","size":[4,4],"clear":[-1,0,0,0]}"#);
    let mut passes = Vec::new();
    let mut read = Vec::new();
    for step in 1..=steps {
        attachments += &format!(
            r#","layer{step}":{{"format":"rgba8unorm","size":[4,4]}},
            "before{step}":{{"format":"rgba32float","size":[4,4],"clear":[2,0,0,0]}},
            "depth{step}":{{"format":"depth32float","size":[4,4],"clear":1}}"#
        );
        let draws = layers.map(|(color, z)| {
            format!(
                r#"{{"mesh":{{"kind":"full","value":{color},"z":{z}}},"shader":"peel","textures":["before{}"],
                "depth":{{"compare":"less","write":true}}}}"#,
                step - 1
            )
        });
        passes.push(format!(
            r#"{{"color":["layer{step}","before{step}"],"depth_stencil":"depth{step}","draws":[{}]}}"#,
            draws.join(",")
        ));
        read.push(format!("\"layer{step}\""));
    }
    scene(&format!(
        r#"{{"attachments":{{{attachments}}},"passes":[{}],"read":[{}]}}"#,
        passes.join(","),
        read.join(",")
    ))
}

#[test]
fn three_flat_layers_peel_one_by_one() {
    let scene = peeled(4);
    let (frame, found) = legal(&scene);
    assert_eq!(found.texels.open, 0);
    let layers = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [0; 4]];
    for (image, layer) in frame.images.iter().zip(layers) {
        assert_eq!(image.sample(1, 2, 0), layer, "{}", image.attachment);
    }
    // A picture with two layers exchanged is wrong.
    let mut swapped = frame.clone();
    swapped.images[0].codes = frame.images[2].codes.clone();
    for judgement in judgements(&scene, &limits(etalon_frame::Api::Vulkan)) {
        let found = compare(&swapped, &judgement.legal, &judgement.yardstick, 1);
        assert!(found.expect("the same images").texels.wrong > 0);
    }
}

#[test]
fn two_layers_peel_from_both_sides() {
    let max = r#"{"operation":"max","src_factor":"one","dst_factor":"one"}"#;
    let blend = format!(r#""blend":{{"color":{max},"alpha":{max}}}"#);
    let layer = |color: &str, z: f32, rest: &str| {
        format!(r#"{{"mesh":{{"kind":"full","value":{color},"z":{z}}},{rest},{blend}}}"#)
    };
    let both = |rest: &str| {
        [
            layer("[1,0,0,0.5]", 0.25, rest),
            layer("[0,1,0,0.25]", 0.75, rest),
        ]
        .join(",")
    };
    let scene = scene(&format!(
        r#"{{"attachments":{{
        "range":{{"format":"rgba32float","size":[4,4],"clear":[-1,-1,0,0]}},
        "nothing":{{"format":"rgba32float","size":[4,4]}},
        "next":{{"format":"rgba32float","size":[4,4],"clear":[-1,-1,0,0]}},
        "front":{{"format":"rgba32float","size":[4,4]}},
        "back":{{"format":"rgba32float","size":[4,4]}}}},
        "passes":[
        {{"color":["range"],"draws":[{}]}},
        {{"color":["next","front","back"],"draws":[{}]}}],
        "read":["range","next","front","back"]}}"#,
        both(r#""shader":"depth_range""#),
        both(r#""shader":"dual_peel","textures":["range","nothing"]"#),
    ));
    let (frame, found) = legal(&scene);
    assert_eq!(found.texels.open, 0);
    let floats = |image: usize| frame.images[image].sample(2, 2, 0).to_vec();
    let bits = |values: [f32; 4]| values.map(f32::to_bits).to_vec();
    assert_eq!(floats(0), bits([-0.25, 0.75, 0.0, 1.0]));
    assert_eq!(floats(1), bits([-1.0, -1.0, 0.0, 1.0]));
    assert_eq!(floats(2), bits([0.5, 0.0, 0.0, 0.5]));
    assert_eq!(floats(3), bits([0.0, 1.0, 0.0, 0.25]));
}

#[test]
fn a_weighted_composite_over_earlier_passes_is_legal() {
    let part = |src: &str, dst: &str| {
        let component =
            format!(r#"{{"operation":"add","src_factor":"{src}","dst_factor":"{dst}"}}"#);
        format!(r#"{{"blend":{{"color":{component},"alpha":{component}}}}}"#)
    };
    let targets = format!("[{},{}]", part("one", "one"), part("zero", "one-minus-src"));
    let layers = [
        ("[1,0,0,0.5]", 0.8),
        ("[0,1,0,0.25]", 0.4),
        ("[0,0,1,0.75]", 0.6),
    ]
    .map(|(color, z)| {
        format!(
            r#"{{"mesh":{{"kind":"rect","texels":[0,0,6,8],"value":{color},"z":{z}}},
                "shader":"weighted_accumulate","targets":{targets}}}"#
        )
    });
    for (sum, left, samples) in [
        ("rgba16float", "r8unorm", 1),
        ("rgba32float", "rgba8unorm", 4),
    ] {
        let scene = scene(&format!(
            r#"{{"attachments":{{
            "color":{{"format":"rgba8unorm","size":[8,8],"samples":{samples},"clear":[0.25,0.5,0.75,1]}},
            "left":{{"format":"{left}","size":[8,8],"clear":[1,1,1,1]}},
            "sum":{{"format":"{sum}","size":[8,8]}}}},
            "passes":[{{"color":["sum","left"],"draws":[{}]}},
            {{"color":["color"],"draws":[{{"mesh":{{"kind":"cover"}},"shader":"weighted_resolve",
            "textures":["sum","left"],"blend":{{
            "color":{{"operation":"add","src_factor":"one-minus-src-alpha","dst_factor":"src-alpha"}},
            "alpha":{{"operation":"add","src_factor":"one-minus-src-alpha","dst_factor":"src-alpha"}}}}}}]}}],
            "read":["color"]}}"#,
            layers.join(",")
        ));
        let (frame, found) = legal(&scene);
        assert_eq!(found.texels.open, 0);
        // The background stays where nothing was drawn.
        assert_eq!(frame.images[0].sample(7, 7, 0), [64, 128, 191, 255]);
        assert_ne!(frame.images[0].sample(1, 1, 0), [64, 128, 191, 255]);
    }
}

#[test]
fn coordinates_of_several_samples_may_be_those_of_any_point_of_the_texel() {
    let scene = scene(
        r#"{"attachments":{"color":{"format":"rgba8unorm","size":[8,8],"samples":4}},
        "passes":[{"color":["color"],"draws":[{"mesh":{"kind":"vertices","positions":[[-1,-1,0],[0.9,-1,0],[-1,0.8,0]],
        "values":[[1,1,1,1]],"uv":[[4,0],[-4,0],[-4,0]]},"shader":"edge_alpha"}]}],"read":["color"]}"#,
    );
    let (frame, found) = legal(&scene);
    assert_eq!(found.texels.open, 0);
    let alphas: std::collections::BTreeSet<u32> =
        (0..8).map(|x| frame.images[0].sample(x, 7, 0)[3]).collect();
    assert!(alphas.len() > 2, "the edge is no ramp: {alphas:?}");
}

#[test]
fn sampling_a_drawn_texture_asserts_nothing_false() {
    for format in ["rgba8unorm", "rgba16float"] {
        let scene = scene(&format!(
            r#"{{"attachments":{{
            "color":{{"format":"{format}","size":[8,8]}},
            "large":{{"format":"{format}","size":[16,16],"clear":[0,1,0,1]}}}},
            "passes":[
            {{"color":["large"],"draws":[{{"mesh":{{"kind":"columns","values":[[1,0,0,1],[0,0,1,1]]}},"shader":"flat_color"}}]}},
            {{"color":["color"],"draws":[{{"mesh":{{"kind":"cover","uv":[0,0,1,1]}},"shader":"sampled_color",
              "textures":["large"],"sampler":{{"filter":"linear","address":["clamp-to-edge","clamp-to-edge"]}}}}]}}],
            "read":["color"]}}"#
        ));
        let (frame, _) = legal(&scene);
        let red = frame.images[0].sample(0, 0, 0)[0];
        assert_eq!(red, if format == "rgba8unorm" { 255 } else { 0x3c00 });
    }
}

/// Compares a sampled judgement with a full one.
fn check_sampled(id: &str, scene: &Scene, most: u64) {
    let texels = Texels::AtMost(most);
    let limits = limits(etalon_frame::Api::Vulkan);
    let complete = judgements(scene, &limits);
    let some = judgements_of(scene, &limits, texels);
    assert_eq!(complete.len(), some.len());
    for (complete, some) in complete.iter().zip(&some) {
        let mut looked_at = 0;
        for (full, part) in [
            (&complete.legal, &some.legal),
            (&complete.yardstick, &some.yardstick),
        ] {
            looked_at = 0;
            assert_eq!(full.images, part.images, "{id}");
            for (full, part) in full.groups.iter().zip(&part.groups) {
                for y in 0..full.size[1] {
                    for x in 0..full.size[0] {
                        for sample in 0..full.samples {
                            let set = part.sample(x, y, sample);
                            if texels.contains(full.size, x, y) {
                                looked_at += 1;
                                assert_eq!(full.sample(x, y, sample), set, "{id} ({x}, {y})");
                            } else {
                                assert!(set.is_open(), "{id} ({x}, {y})");
                            }
                        }
                    }
                }
            }
            // A lattice over a small picture contains all of it.
            assert!(
                part.counters == full.counters
                    || part.counters.iter().all(|c| c.range.is_open(c.kind)),
                "{id}"
            );
        }
        assert_eq!(some.looked_at, looked_at, "{id}");
        assert!(looked_at > 0, "{id}");
    }
}

#[test]
fn a_judgement_of_some_texels_agrees_with_the_full_one_on_them() {
    check_sampled("peeled", &peeled(3), 5);
    let library = Library::built_in();
    // The large pictures of these are judged only on a lattice, since whole ones would take long.
    let left_out = ["selftest/", "perf/", "methods/"];
    let files = library.files();
    for file in files.filter(|f| !left_out.iter().any(|area| f.name().starts_with(area))) {
        if let Some(case) = file.cases(Profile::Quick).next() {
            let case = case.build().expect("built-in cases build");
            check_sampled(&case.id, case.judged_scene(), 40);
        }
    }
}

#[test]
fn the_nearest_texel_of_a_drawn_texture_is_followed() {
    let scene = scene(
        r#"{"attachments":{
            "texture":{"format":"rgba8unorm","size":[4,4],"clear":[0,0,0,1]},
            "color":{"format":"rgba8unorm","size":[8,8],"clear":[0,0,0,0]}},
            "passes":[
            {"color":["texture"],"draws":[{"mesh":{"kind":"columns","values":[[1,0,0,1],[0,1,0,1],[0,0,1,1],[1,1,1,0]]},
              "shader":"flat_color"}]},
            {"color":["color"],"draws":[{"mesh":{"kind":"cover","uv":[0,0,2,1]},"shader":"sampled_color",
              "textures":["texture"],"sampler":{"filter":"nearest","address":["repeat","clamp-to-edge"]}}]}],
            "read":["color"]}"#,
    );
    legal(&scene);
    for api in APIS {
        for judgement in judgements(&scene, &limits(api)) {
            assert!(is_exact(&judgement.legal), "{api:?}");
            assert!(is_exact(&judgement.yardstick), "{api:?}");
        }
    }
}

#[test]
fn a_coordinate_between_two_drawn_texels_may_select_either() {
    // The coordinate of the middle columns is the border of two texels.
    let scene = scene(
        r#"{"attachments":{
            "texture":{"format":"rgba8unorm","size":[2,2],"clear":[0,0,0,1]},
            "color":{"format":"rgba8unorm","size":[1,1],"clear":[0,0,0,0]}},
            "passes":[
            {"color":["texture"],"draws":[{"mesh":{"kind":"columns","values":[[1,0,0,1],[0,1,0,1]]},"shader":"flat_color"}]},
            {"color":["color"],"draws":[{"mesh":{"kind":"cover"},"shader":"sampled_color",
              "textures":["texture"],"sampler":{"filter":"nearest","address":["repeat","repeat"]}}]}],
            "read":["color"]}"#,
    );
    for judgement in judgements(&scene, &limits(etalon_frame::Api::Vulkan)) {
        let set = judgement.legal.groups[0].sample(0, 0, 0);
        assert!(set.allows(&[255, 0, 0, 255]) && set.allows(&[0, 255, 0, 255]));
        assert!(!set.allows(&[0, 0, 255, 255]));
    }
}
