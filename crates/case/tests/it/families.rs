//! Properties of the built-in families of cases, checked with a plain simulation of the pipeline
//! that shares nothing with the one that judges: single samples, one value per channel, codes
//! rounded to the nearest.

use etalon_case::{Case, Library, Profile};
use etalon_frame::TextureFormat;
use etalon_scene::{
    BlendComponent, BlendFactor, CompareFunction, CullMode, Draw, Shader, StencilFace,
    StencilOperation,
};
use std::collections::{BTreeMap, BTreeSet};

mod breadth;
mod combinations;
mod matrix;
mod methods;
mod simulation;
use simulation::{
    Path, Plain, distance_from_centres, draws, equation, factor, operate, plain, simulate,
    triangles,
};

/// The built-in cases below a path that the simulation can draw, without measured cases, whose meshes and
/// pictures are too large for it.
fn cases(prefix: &str) -> Vec<Case> {
    let library = Library::built_in();
    library
        .cases(Profile::Full)
        .filter(|c| c.id().starts_with(prefix))
        .filter(|c| {
            !["methods/", "perf/", "size/"]
                .iter()
                .any(|a| c.id().starts_with(a))
        })
        .map(|c| c.build().expect("built-in cases build"))
        .filter(|c| simulation::knows(&c.scene))
        .collect()
}

#[test]
fn every_area_holds_its_cases() {
    let library = Library::built_in();
    let mut counts = BTreeMap::new();
    for case in library.cases(Profile::Full) {
        let id = case.id();
        let area = id.split('/').next().expect("an id has an area").to_owned();
        *counts.entry(area).or_insert(0) += 1;
    }
    let minimums = [
        ("depth", 1000),
        ("stencil", 3300),
        ("blend", 2900),
        ("cull", 190),
        ("multisample", 1200),
        ("scissor", 130),
        ("selftest", 86),
        ("capabilities", 250),
        ("sequence", 3000),
        ("size", 500),
        ("paths", 1500),
    ];
    for (area, least) in minimums {
        let count = counts.get(area).copied().unwrap_or(0);
        assert!(
            count >= least,
            "{area}: {count} cases, {least} are promised"
        );
    }
    assert!(counts.values().sum::<i32>() >= 8900);
}

/// For every file except one, whose cases hang on SwiftShader until the time limit of a minute.
#[test]
fn the_quick_profile_takes_some_of_every_file() {
    let library = Library::built_in();
    let mut total = 0;
    for file in library.files() {
        let ids = |profile| file.cases(profile).map(|c| c.id());
        let full: BTreeSet<String> = ids(Profile::Full).collect();
        let quick: Vec<String> = ids(Profile::Quick).collect();
        let is_slow = file.name() == "sequence/spans-discarded.json";
        assert_eq!(quick.is_empty(), is_slow, "{}", file.name());
        assert!(quick.iter().all(|id| full.contains(id)), "{}", file.name());
        // Measured cases take as long as the machine needs, without the limit of judged ones; a benchmark's
        // larger sizes ask no new question, and methods have numeric axes.
        let measures = ["methods/", "perf/"];
        if measures.iter().any(|area| file.name().starts_with(area)) {
            continue;
        }
        total += quick.len();
        // One seed is as good as another, the other areas draw every format and feature too, and every
        // value of each state, and the largest sizes take too long.
        let partly = ["combined/", "capabilities/", "found/", "sequence/", "size/"];
        if partly.iter().any(|area| file.name().starts_with(area)) {
            continue;
        }
        // Each value of each axis is in a candidate.
        let parts = |id: &str| -> Vec<String> { id.split('/').map(str::to_owned).collect() };
        let expected: BTreeSet<String> = full.iter().flat_map(|id| parts(id)).collect();
        let met: BTreeSet<String> = ids(Profile::Candidates).flat_map(|id| parts(&id)).collect();
        assert_eq!(met, expected, "{}", file.name());
    }
    assert!(total <= 1800, "{total} cases are not quick");
}

#[test]
fn every_file_says_what_it_proves_and_by_which_clauses() {
    let library = Library::built_in();
    let apis = [
        "Vulkan",
        "OpenGL 3.3",
        "OpenGL ES 3.0",
        "OpenGL 4.6",
        "OpenGL ES 3.2",
        "WebGPU",
    ];
    for file in library.files() {
        let first = file
            .cases(Profile::Full)
            .next()
            .expect("a file holds a case");
        let case = first.build().expect("built-in cases build");
        assert!(case.about.ends_with('.'), "{}: {}", file.name(), case.about);
        assert!(!case.spec.is_empty(), "{} names no clause", file.name());
        for clause in &case.spec {
            let (api, section) = clause.split_once(": ").unwrap_or_default();
            // Methods come from papers and books, by author and year.
            let is_method = file.name().starts_with("methods/");
            let known = apis.contains(&api) || is_method && api.ends_with(char::is_numeric);
            assert!(known, "{}: {clause}", file.name());
            assert!(!section.is_empty(), "{}: {clause}", file.name());
        }
    }
}

#[test]
fn a_case_needs_few_pipelines() {
    for case in cases("") {
        let mut pipelines: Vec<Draw> = Vec::new();
        for draw in case.scene.passes.iter().flat_map(|p| &p.draws) {
            let mut state = draw.clone();
            state.mesh.vertices.clear();
            state.params = Default::default();
            state.blend_constant = [0.0; 4];
            if let Some(stencil) = &mut state.stencil {
                stencil.front.reference = 0;
                stencil.back.reference = 0;
            }
            if !pipelines.contains(&state) {
                pipelines.push(state);
            }
        }
        // If the case tests the order of draws, or all state differs, it has more.
        let most = match case.parts().area() {
            // Passes that depend on each other need many draws.
            "sequence" if !case.id.starts_with("sequence/state/") => continue,
            "early-z" | "order" | "combined" | "sequence" | "paths" => 5,
            _ => 2,
        };
        assert!(pipelines.len() <= most, "{}: {}", case.id, pipelines.len());
    }
}

#[test]
fn no_edge_comes_near_a_texel_centre() {
    let mut seen = BTreeSet::new();
    // Frames of the area `order` are compared with each other, so their edges can be anywhere. The same holds
    // if indices, offsets, topology or polygon mode alternate: other triangles are drawn then.
    let geometry = [
        "order/",
        "sequence/state/fetch/",
        "sequence/state/indices/",
        "sequence/state/topology/",
        "sequence/state/polygon-mode/",
        "sequence/shared/polygon-mode/",
    ];
    let may_lie_anywhere = |c: &Case| geometry.iter().any(|family| c.id.starts_with(family));
    for case in cases("").into_iter().filter(|c| !may_lie_anywhere(c)) {
        for (pass, draw) in draws(&case.scene) {
            let size = case.scene.attachments[pass.color[0]].size;
            if !seen.insert((size, draw.mesh.bytes().to_vec())) {
                continue;
            }
            for corners in triangles(draw, size) {
                for i in 0..3 {
                    let least = distance_from_centres(corners[i], corners[(i + 1) % 3], size);
                    assert!(
                        least > 0.17,
                        "{}: an edge passes at {least} texels",
                        case.id
                    );
                }
            }
        }
    }
}

#[test]
fn alpha_is_never_blended_as_colour_is() {
    let cases = cases("blend/factors/");
    assert_eq!(cases.len(), 5 * 15 * 15);
    let mut color = BTreeSet::new();
    let mut alpha = BTreeSet::new();
    let key = |c: BlendComponent| (c.operation, c.src_factor, c.dst_factor);
    for case in &cases {
        let draw = &case.scene.passes[0].draws[0];
        let blend = draw.targets[0].blend.expect("the family blends");
        assert_ne!(blend.color.operation, blend.alpha.operation, "{}", case.id);
        let pairs = [
            (blend.color.src_factor, blend.alpha.src_factor),
            (blend.color.dst_factor, blend.alpha.dst_factor),
        ];
        for (c, a) in pairs {
            assert_ne!(c, a, "{}", case.id);
            let texel = [0.2, 0.4, 0.6, 0.8];
            let other = [0.3, 0.7, 0.1, 0.45];
            let constant = [0.9, 0.35, 0.15, 0.65];
            let [c, a] = [c, a].map(|f| factor(f, texel, other, constant, 3));
            assert_ne!(c, a, "{}: both mean the same for alpha", case.id);
        }
        color.insert(key(blend.color));
        alpha.insert(key(blend.alpha));
        let constant = draw.blend_constant;
        assert!(constant.iter().all(|v| *v > 0.0 && *v < 1.0));
        let distinct: BTreeSet<_> = constant.iter().map(|v| v.to_bits()).collect();
        assert_eq!(distinct.len(), 4, "{}", case.id);
    }
    assert_eq!(color.len(), 1125);
    assert_eq!(alpha.len(), 1125);
}

#[test]
fn stencil_operations_take_every_path_from_every_stored_value() {
    every_triple_takes_every_path(&cases("stencil/operations/"), 512);
    let both = cases("stencil/two-sided/");
    for winding in ["ccw", "cw"] {
        let part = format!("/front_face={winding}/");
        let half: Vec<Case> = both
            .iter()
            .filter(|c| c.id.contains(&part))
            .cloned()
            .collect();
        every_triple_takes_every_path(&half, 512);
    }
}

fn every_triple_takes_every_path(cases: &[Case], expected: usize) {
    assert_eq!(cases.len(), expected);
    let key = |f: &StencilFace| (f.fail_op, f.depth_fail_op, f.pass_op);
    let mut front = BTreeSet::new();
    let mut back = BTreeSet::new();
    for case in cases {
        let tested = case.scene.passes[0].draws.last().expect("draws");
        let stencil = tested.stencil.expect("the family tests stencil");
        let (f, b) = (key(&stencil.front), key(&stencil.back));
        assert!(f.0 != b.0 && f.1 != b.1 && f.2 != b.2, "{}", case.id);
        let mask = stencil.front.write_mask;
        assert!(mask != 0 && mask != 0xff, "{}", case.id);
        front.insert(f);
        back.insert(b);

        let mut inputs: BTreeMap<(bool, Path), Vec<(u8, u8)>> = BTreeMap::new();
        simulate(&case.scene, &mut |event| {
            if event.draw.depth.is_some() {
                let face = event.face.expect("the family tests stencil");
                let list = inputs.entry((event.front, event.path)).or_default();
                list.push((event.stored, face.reference));
            }
        });
        for is_front in [true, false] {
            for path in [Path::Fail, Path::DepthFail, Path::Pass] {
                let list = inputs.remove(&(is_front, path)).unwrap_or_default();
                let stored: BTreeSet<u8> = list.iter().map(|(stored, _)| *stored).collect();
                let expected = BTreeSet::from([0, 1, 90, 127, 128, 165, 254, 255]);
                assert_eq!(stored, expected, "{}: {is_front} {path:?}", case.id);
                // Whichever two operations are confused, some texel distinguishes them.
                for a in StencilOperation::ALL {
                    for b in StencilOperation::ALL.iter().filter(|b| *b != a) {
                        let distinguished = list.iter().any(|(stored, reference)| {
                            let [a, b] = [a, b].map(|op| operate(*op, *stored, *reference, mask));
                            a != b
                        });
                        assert!(distinguished, "{}: {a:?} and {b:?} look the same", case.id);
                    }
                }
            }
        }
    }
    assert_eq!(front.len(), expected);
    assert_eq!(back.len(), expected);
}

#[test]
fn a_wrong_compare_function_shows() {
    for family in [
        "depth/compare/",
        "depth/depth32float-exact/",
        "depth/fixed-function/",
    ] {
        for case in cases(family) {
            every_other_compare_shows(&case, |draw| {
                &mut draw.depth.as_mut().expect("the family tests depth").compare
            });
        }
    }
    for case in cases("stencil/compare/") {
        // With an empty read mask 0 is compared with 0, and some functions agree.
        if !case.id.ends_with("read_mask=0x00") {
            every_other_compare_shows(&case, |draw| {
                let stencil = draw.stencil.as_mut().expect("the family tests stencil");
                &mut stencil.front.compare
            });
        }
    }
}

/// The tested draws of these families are red, the ones before them blue.
fn every_other_compare_shows(case: &Case, compare: fn(&mut Draw) -> &mut CompareFunction) {
    let right = plain(&case.scene);
    for other in CompareFunction::ALL {
        let mut wrong = case.scene.clone();
        let tested = wrong.passes[0].draws.iter_mut();
        for draw in tested.filter(|d| d.params.color[0] == 1.0) {
            *compare(draw) = *other;
        }
        if wrong != case.scene {
            assert!(
                right != plain(&wrong),
                "{}: {other:?} looks the same",
                case.id
            );
        }
    }
}

#[test]
fn a_wrong_bit_of_a_stencil_write_mask_shows() {
    let families = ["stencil/write-mask/", "stencil/two-sided/"];
    for case in families.into_iter().flat_map(cases) {
        if case.id.starts_with("stencil/two-sided/") && case.id.contains("keep") {
            continue;
        }
        let right = plain(&case.scene);
        for bit in 0..8 {
            let mut wrong = case.scene.clone();
            for draw in &mut wrong.passes[0].draws {
                let stencil = draw.stencil.as_mut().expect("the family tests stencil");
                if stencil.front.compare != CompareFunction::Always {
                    stencil.front.write_mask ^= 1 << bit;
                }
            }
            assert!(right != plain(&wrong), "{}: bit {bit}", case.id);
        }
    }
}

#[test]
fn a_wrong_blend_factor_shows() {
    let mut shown = 0;
    for case in cases("blend/factors/") {
        let right = plain(&case.scene);
        let draw = &case.scene.passes[0].draws[0];
        let state = draw.targets[0].blend.expect("the family blends");
        let constant = draw.blend_constant.map(f64::from);
        for (channel, used) in [(0, state.color), (3, state.alpha)] {
            let factors = BlendFactor::ALL.iter().filter(|f| !f.is_second_source());
            let others = factors.flat_map(|f| {
                let (mut src, mut dst) = (used, used);
                (src.src_factor, dst.dst_factor) = (*f, *f);
                [src, dst]
            });
            for other in others.filter(|o| !agree(*o, used, constant, channel)) {
                let mut wrong = case.scene.clone();
                let blend = wrong.passes[0].draws[0].targets[0].blend.as_mut();
                let blend = blend.expect("the family blends");
                *(if channel == 3 {
                    &mut blend.alpha
                } else {
                    &mut blend.color
                }) = other;
                let most = most_codes(&right[0], &plain(&wrong)[0]);
                assert!(most > 7.5, "{}: {other:?} shows by {most} codes", case.id);
                shown += 1;
            }
        }
    }
    assert!(shown > 30_000, "{shown} wrong factors were tried");
}

/// True if two equations give the same for any source and destination.
fn agree(a: BlendComponent, b: BlendComponent, constant: [f64; 4], channel: usize) -> bool {
    let steps = [0.0, 0.25, 0.5, 1.0];
    let each = (0..256).map(|i| [i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6].map(|n| steps[n]));
    each.into_iter().all(|[s, s_alpha, d, d_alpha]| {
        let (s, d) = ([s, s, s, s_alpha], [d, d, d, d_alpha]);
        let [a, b] = [a, b].map(|c| equation(c, s, d, constant, channel).clamp(0.0, 1.0));
        a == b
    })
}

/// The largest difference of any colour channel in codes of 8 bits.
fn most_codes(a: &Plain, b: &Plain) -> f64 {
    let channels = a.color.iter().flatten().zip(b.color.iter().flatten());
    let differences = channels.map(|(a, b)| (a - b).abs() * 255.0);
    differences.fold(0.0, f64::max)
}

#[test]
fn exchanged_stencil_faces_show() {
    for family in [
        "operations",
        "operations-without-depth",
        "two-sided",
        "faces",
        "separate-faces",
    ] {
        for case in cases(&format!("stencil/{family}/")) {
            let mut exchanged = case.scene.clone();
            for draw in &mut exchanged.passes[0].draws {
                if let Some(stencil) = &mut draw.stencil {
                    std::mem::swap(&mut stencil.front, &mut stencil.back);
                }
            }
            let (a, b) = (plain(&case.scene), plain(&exchanged));
            assert!(a != b, "{} does not tell the faces apart", case.id);
        }
    }
}

#[test]
fn textbook_values_are_what_the_equations_give() {
    let textbook = cases("blend/textbook/");
    assert!(textbook.len() >= 20);
    for case in textbook {
        assert!(!case.expect.is_empty(), "{} expects nothing", case.id);
        let frame = plain(&case.scene);
        for expect in &case.expect {
            let width = case.scene.attachments[expect.attachment].size[0];
            let index = (expect.texel[1] * width + expect.texel[0]) as usize;
            let found = frame[expect.attachment].color[index];
            for (found, value) in found.iter().zip(&expect.value) {
                let expected = (value * 255.0).round() / 255.0;
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{}: {found} for {expected}",
                    case.id
                );
            }
        }
    }
}

#[test]
fn culling_shows_each_face_alone() {
    // Flat colours of provoking vertices show no face, patches and single triangles of one winding do not
    // show both, and coverage cases show none.
    let other = [
        "cull/provoking/",
        "cull/tessellation/",
        "cull/clipping/guard-band-slanted/",
        "cull/clipping/layers/",
        "cull/shared-edges/",
        "cull/lines-outside/",
    ];
    let other = |case: &Case| other.iter().any(|f| case.id.starts_with(f));
    for case in cases("cull/").into_iter().filter(|c| !other(c)) {
        let drawn = case.scene.passes[0].draws.iter();
        let mut tested = drawn.filter(|d| d.shader == Shader::FrontFacing);
        let draw = tested.next().expect("the area shows faces");
        let frame = plain(&case.scene);
        let colors = &frame[case.scene.passes[0].color[0]].color;
        let shows = |color: [f32; 4]| colors.contains(&color.map(f64::from));
        let (front, back) = (shows(draw.params.color), shows(draw.params.back_color));
        let expected = match draw.cull {
            CullMode::None => (true, true),
            CullMode::Front => (false, true),
            CullMode::Back => (true, false),
            CullMode::FrontAndBack => (false, false),
        };
        // Triangles without an area show no face.
        let expected = if case.id.starts_with("cull/slivers/") {
            (false, false)
        } else {
            expected
        };
        assert_eq!((front, back), expected, "{}", case.id);
    }
}

#[test]
fn every_selftest_differs_beyond_what_any_rule_allows() {
    let selftests = cases("selftest/");
    assert!(selftests.len() >= 20);
    for case in selftests
        .into_iter()
        .filter(|c| simulation::knows(&c.scene) && simulation::knows(c.judged_scene()))
        .filter(|c| c.scene.counters.is_empty() && c.relation.is_none())
    {
        let (drawn, judged) = (plain(&case.scene), plain(case.judged_scene()));
        let proven = case.scene.read.iter().any(|index| {
            let (a, b) = (&drawn[*index], &judged[*index]);
            let format = case.scene.attachments[*index].format;
            // A written depth is exact on a float format; elsewhere only 0 and 1 are.
            let depth = if format == TextureFormat::Depth32Float {
                0.0
            } else {
                0.5
            };
            a.stencil != b.stencil
                || a.depth
                    .iter()
                    .zip(&b.depth)
                    .any(|(a, b)| (a - b).abs() > depth)
                || most_codes(a, b) > 7.5
        });
        assert!(proven, "{} would not have to fail", case.id);
    }
}
