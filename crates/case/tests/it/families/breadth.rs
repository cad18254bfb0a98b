//! Properties of the families that the plain simulation cannot draw: the states that they cover.

use etalon_case::{Case, Library, Profile};
use etalon_frame::{ChannelEncoding, Feature, Requirement};
use etalon_scene::{
    AdvancedBlend, AttachmentContents, LogicOperation, PrimitiveTopology, ProvokingVertex, Shader,
};
use std::collections::{BTreeMap, BTreeSet};

/// All built-in cases below a path.
pub(super) fn all_cases(prefix: &str) -> Vec<Case> {
    let library = Library::built_in();
    let named = library
        .cases(Profile::Full)
        .filter(|c| c.id().starts_with(prefix));
    named
        .map(|c| c.build().expect("built-in cases build"))
        .collect()
}

#[test]
fn every_selftest_is_judged_as_something_else() {
    // A relation fails because of what is drawn, whatever scene is judged.
    let has_no_relation = |case: &Case| case.relation.is_none();
    for case in all_cases("selftest/").into_iter().filter(has_no_relation) {
        assert!(&case.scene != case.judged_scene(), "{}", case.id);
    }
}

#[test]
fn families_over_formats_leave_none_out() {
    let families = [
        ("blend/formats-clear/", 13),
        ("blend/formats-store/", 13),
        ("multisample/formats/", 13),
        // Existing families blend and mask rgba8unorm.
        ("blend/formats/", 12),
        ("blend/write-mask-formats/", 12),
        ("blend/factors-formats/", 12),
        ("blend/order-formats/", 12),
        ("selftest/format-clear/", 12),
    ];
    for (family, expected) in families {
        let mut formats = BTreeSet::new();
        for case in all_cases(family) {
            let target = case.scene.passes[0].color[0];
            formats.insert(case.scene.attachments[target].format);
        }
        assert_eq!(formats.len(), expected, "{family}");
    }
}

#[test]
fn multisample_cases_read_every_sample_of_every_count() {
    let mut seen: BTreeMap<String, BTreeSet<u32>> = BTreeMap::new();
    // Only resolved integers can be read on every API.
    let read_whole = |case: &Case| !case.id.starts_with("multisample/resolve-integer/");
    for case in all_cases("multisample/").into_iter().filter(read_whole) {
        let read = case.scene.read.iter().map(|i| &case.scene.attachments[*i]);
        let most = read.map(|a| a.samples).max().unwrap_or(1);
        assert!(most > 1, "{} reads no samples", case.id);
        let family = case.id.split('/').nth(1).expect("an id has a family");
        seen.entry(family.to_owned()).or_default().insert(most);
    }
    for (family, counts) in seen {
        let expected: &[u32] = match family.as_str() {
            "formats" | "input-mask-tests" => &[4, 8],
            "input-mask" => &[4, 8, 16],
            _ => &[2, 4, 8, 16],
        };
        assert!(counts.iter().eq(expected), "{family}: {counts:?}");
    }
}

#[test]
fn the_second_source_weighs_alpha_by_other_factors_than_colour() {
    let mut cases = all_cases("blend/dual-source/");
    // Second-source factors on both sides of the equation, and on each side with all other factors.
    let source = all_cases("blend/dual-source-weighs-source/");
    let destination = all_cases("blend/dual-source-weighs-destination/");
    assert_eq!((source.len(), destination.len()), (4 * 19 * 5, 15 * 4 * 5));
    cases.extend(source.into_iter().chain(destination));
    let mut factors = BTreeSet::new();
    for case in &cases {
        let draw = &case.scene.passes[0].draws[0];
        let blend = draw.targets[0].blend.expect("the family blends");
        let (color, alpha) = (blend.color, blend.alpha);
        assert_ne!(color.operation, alpha.operation, "{}", case.id);
        assert_ne!(color.src_factor, alpha.src_factor, "{}", case.id);
        assert_ne!(color.dst_factor, alpha.dst_factor, "{}", case.id);
        factors.extend([color.src_factor, color.dst_factor]);
    }
    let second = factors.iter().filter(|f| f.is_second_source()).count();
    assert_eq!(second, 4);
}

#[test]
fn every_logic_operation_is_distinguished_from_every_other() {
    for family in ["rgba8unorm", "rgb10a2unorm"] {
        let cases = all_cases(&format!("blend/logic/format={family}/"));
        let operations: BTreeSet<_> = cases.iter().filter_map(target_logic).collect();
        assert_eq!(operations.len(), LogicOperation::ALL.len());
        for case in cases {
            // Two operations differ in some bit of source and destination: each pair of bits occurs.
            let codes = |name: &str| {
                let attachment = case.scene.attachments.iter().find(|a| a.name == name);
                match &attachment.expect("it is there").contents {
                    AttachmentContents::Texels(codes) => codes.clone(),
                    other => panic!("{other:?}"),
                }
            };
            let (color, source) = (codes("color"), codes("source"));
            let mut pairs = BTreeSet::new();
            for (i, code) in color.iter().enumerate() {
                pairs.insert((source[i], code & 1));
            }
            let expected = [0, 1.0_f32.to_bits()].map(|s| [(s, 0), (s, 1)]);
            assert!(pairs.iter().eq(expected.iter().flatten()), "{}", case.id);
        }
    }
}

#[test]
fn advanced_blends_meet_premultiplied_colours_of_every_kind() {
    let cases = all_cases("blend/advanced");
    let mode = |case: &Case| {
        let mut draws = case.scene.passes.iter().flat_map(|p| &p.draws);
        draws.find_map(|d| d.targets[0].advanced)
    };
    let modes: BTreeSet<_> = all_cases("blend/advanced/")
        .iter()
        .filter_map(mode)
        .collect();
    assert_eq!(modes.len(), AdvancedBlend::ALL.len());
    for case in cases {
        let mut uploads = 0;
        for attachment in &case.scene.attachments {
            let AttachmentContents::Texels(codes) = &attachment.contents else {
                continue;
            };
            uploads += 1;
            let encodings = attachment.format.color_channels();
            let value =
                |(code, e): (&u32, &ChannelEncoding)| e.value_of_order(e.order_of_code(*code));
            let mut alphas = BTreeSet::new();
            for texel in codes.chunks(encodings.len()) {
                let color: Vec<f64> = texel.iter().zip(encodings).map(value).collect();
                let alpha = color.get(3).copied().unwrap_or(1.0);
                assert!(color.iter().all(|v| *v <= alpha), "{}: {color:?}", case.id);
                alphas.insert((alpha * 100.0) as u32);
            }
            let expected: &[u32] = if encodings.len() == 4 {
                &[0, 100]
            } else {
                &[100]
            };
            assert!(expected.iter().all(|a| alphas.contains(a)), "{}", case.id);
        }
        let samples = case.scene.attachments[0].samples;
        assert!(uploads > 0 || samples > 1, "{}", case.id);
    }
}

#[test]
fn only_one_case_needs_coherent_advanced_blending() {
    let coherent = Requirement::Feature(Feature::AdvancedBlendCoherent);
    let needs = |case: &Case| case.requirements().contains(&coherent);
    let cases = all_cases("blend/advanced").into_iter().filter(needs);
    let ids: Vec<String> = cases.map(|c| c.id).collect();
    assert_eq!(ids, ["blend/advanced-order/over=primitive"]);
}

fn target_logic(case: &Case) -> Option<LogicOperation> {
    case.scene.passes[0].draws[0].logic
}

#[test]
fn every_family_of_biases_has_positive_and_negative_ones() {
    for family in all_families("depth/bias-") {
        let biases = all_cases(&family).into_iter().map(|c| {
            let draws = c.scene.passes.into_iter().flat_map(|p| p.draws);
            draws.map(|d| f64::from(d.depth_bias.constant) + f64::from(d.depth_bias.slope))
        });
        let biases: Vec<f64> = biases.flatten().collect();
        assert!(biases.iter().any(|b| *b > 0.0), "{family}");
        assert!(biases.iter().any(|b| *b < 0.0), "{family}");
    }
}

/// The files below a path, as prefixes of their cases' ids.
fn all_families(prefix: &str) -> Vec<String> {
    let library = Library::built_in();
    let names = library.files().map(|f| f.name());
    let stems = names.filter_map(|n| n.strip_suffix(".json"));
    let found: Vec<String> = stems
        .filter(|s| s.starts_with(prefix))
        .map(|s| format!("{s}/"))
        .collect();
    assert!(!found.is_empty(), "{prefix}");
    found
}

#[test]
fn tessellated_patches_have_every_order_under_every_face_and_culling() {
    let mut seen = BTreeSet::new();
    for case in all_cases("cull/tessellation/facing/") {
        let draw = &case.scene.passes[0].draws[0];
        let tessellation = draw.tessellation.expect("the family tessellates");
        seen.insert((
            draw.cull,
            draw.front_face,
            tessellation.order,
            tessellation.origin,
        ));
    }
    assert_eq!(seen.len(), 4 * 2 * 2 * 2);
}

#[test]
fn no_primitive_hides_which_vertex_provokes() {
    let families = ["cull/provoking/", "paths/provoking/"];
    for case in families.into_iter().flat_map(all_cases) {
        for draw in case.scene.passes.iter().flat_map(|p| &p.draws) {
            let colors = |vertex| {
                let mut draw = draw.clone();
                draw.provoking = Some(vertex);
                let provoking = draw.provoking_vertices().into_iter();
                provoking
                    .map(|i| draw.mesh.vertices[i].color)
                    .collect::<Vec<_>>()
            };
            let (first, last) = (
                colors(ProvokingVertex::First),
                colors(ProvokingVertex::Last),
            );
            let same = first.iter().zip(&last).any(|(a, b)| a == b);
            assert_eq!(
                same,
                draw.topology == PrimitiveTopology::PointList,
                "{}",
                case.id
            );
        }
    }
}

#[test]
fn clipping_meets_every_kind_of_w() {
    type Holds = fn(f32) -> bool;
    let kinds: [(&str, Holds); 6] = [
        ("one", |w| w == 1.0),
        ("another", |w| (2.0..=64.0).contains(&w)),
        ("tiny", |w| w > 0.0 && w < 1e-5),
        ("huge", |w| w > 1e5),
        ("none", |w| w == 0.0),
        ("behind", |w| w < 0.0),
    ];
    let cases = all_cases("cull/clipping/");
    let vertices = || {
        let draws = cases.iter().flat_map(|case| &case.scene.passes[0].draws);
        draws.flat_map(|draw| {
            draw.mesh
                .vertices
                .iter()
                .map(move |v| (draw.topology, v.position))
        })
    };
    for (kind, is_kind) in kinds {
        assert!(vertices().any(|(_, [.., w])| is_kind(w)), "{kind}");
    }
    use PrimitiveTopology::{LineList, PointList, TriangleList};
    for topology in [PointList, LineList, TriangleList] {
        let of_topology = || vertices().filter(|(t, _)| *t == topology);
        assert!(
            of_topology().any(|(_, [_, _, z, w])| w > 0.0 && z < 0.0),
            "{topology}: near"
        );
        assert!(
            of_topology().any(|(_, [_, _, z, w])| w > 0.0 && z > w),
            "{topology}: far"
        );
        assert!(
            of_topology().any(|(_, [.., w])| w < 0.0),
            "{topology}: behind"
        );
        assert!(
            of_topology().any(|(_, [x, _, _, w])| w > 0.0 && x.abs() > w),
            "{topology}: side"
        );
    }
    // 16 texels wide: half a million texels are 65,536 in clip space.
    let reach = |[x, _, _, w]: [f32; 4]| if w > 0.0 { (x / w).abs() } else { 0.0 };
    assert!(vertices().any(|(_, p)| reach(p) > 65_536.0));
}

#[test]
fn interpolation_is_tested_in_every_way() {
    let cases = all_cases("texture/interpolation/");
    let draws = || cases.iter().flat_map(|case| &case.scene.passes[0].draws);
    for shader in Shader::ALL {
        let stepped = shader.name().starts_with("stepped_") || shader.flat_from_either();
        let tried = draws().any(|draw| {
            let w = draw.mesh.vertices.iter().map(|v| v.position[3]);
            draw.shader == *shader && w.clone().any(|w| w != draw.mesh.vertices[0].position[3])
        });
        assert!(tried || !stepped, "{shader}");
    }
}
