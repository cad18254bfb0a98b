//! A legal set depends only on what the judge asks of rules and limits.

use crate::common::{APIS, limits};
use etalon_case::{Library, Profile};
use etalon_frame::{ApiVersion, Limits, ReadPath};
use etalon_reference::{
    Geometries, KnownSets, Rules, SceneKey, Texels, judgements_by, legal_set_of_texels,
};
use etalon_scene::{Fetch, Path, Scene, SharedMesh, Vertex};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Limits of every API, with two grids of sub-pixels and both ways of reading.
fn all_limits() -> Vec<Limits> {
    let versions = [(1, 3), (4, 5), (3, 1), (0, 0)];
    let mut result = Vec::new();
    for (api, (major, minor)) in APIS.into_iter().zip(versions) {
        for (bits, read) in [
            (8, ReadPath::Copy),
            (4, ReadPath::Copy),
            (8, ReadPath::Shader),
        ] {
            let mut variant = limits(api);
            variant.version = ApiVersion::new(major, minor);
            variant.sub_pixel_bits = bits;
            for support in variant.formats.values_mut() {
                support.read = read;
            }
            result.push(variant);
        }
    }
    result
}

#[test]
fn rules_that_agree_on_the_recorded_questions_give_the_same_sets() {
    let library = Library::built_in();
    let quick = library.cases(Profile::Quick);
    let is_small = |id: &str| {
        !["methods/", "perf/", "size/"]
            .iter()
            .any(|a| id.starts_with(a))
    };
    let cases = quick.filter(|case| is_small(&case.id())).step_by(23);
    let geometries = Geometries::default();
    let (mut sets, computed) = (0, Cell::new(0));
    for case in cases {
        let case = case.build().expect("a built-in case builds");
        let known: RefCell<HashMap<Limits, KnownSets>> = RefCell::default();
        for limits in all_limits() {
            let given = |basis: &Limits, rules: &Rules| {
                let mut known = known.borrow_mut();
                let sets = known.entry(basis.clone()).or_default();
                sets.get(rules, |rules| {
                    computed.set(computed.get() + 1);
                    legal_set_of_texels(&case.scene, basis, rules, Texels::All, &geometries)
                })
            };
            for judgement in judgements_by(&case.scene, &limits, Texels::All, &given) {
                let legal_by = |rules: &Rules| {
                    legal_set_of_texels(
                        &case.scene,
                        &judgement.limits,
                        rules,
                        Texels::All,
                        &Geometries::default(),
                    )
                };
                let yardstick = Rules::yardstick(&judgement.limits);
                assert_eq!(
                    *judgement.legal,
                    legal_by(&judgement.rules),
                    "{} {}",
                    case.id,
                    limits.api
                );
                assert_eq!(
                    *judgement.yardstick,
                    legal_by(&yardstick),
                    "{} {}",
                    case.id,
                    limits.api
                );
                sets += 2;
            }
        }
    }
    // Otherwise nothing is shared, and the test shows nothing.
    let computed = computed.get();
    assert!(
        computed * 2 < sets,
        "{computed} of {sets} sets were computed"
    );
}

#[test]
fn a_clone_of_rules_records_no_questions() {
    let rules = Rules::of(&limits(APIS[0]));
    assert_eq!(rules.asked().len(), 0);
    let _ = rules.store.value();
    assert_eq!(rules.asked(), ["store"]);
    assert_eq!(rules.clone().asked().len(), 0);
    assert_eq!(rules.clone(), rules);
}

/// The built-in files whose cases differ in their paths or in the route of their vertices.
const ROUTES: [&str; 4] = ["paths/", "size/indices/", "sequence/state/", "cull/"];

#[test]
fn scenes_with_equal_keys_have_equal_sets() {
    let library = Library::built_in();
    let mut first: HashMap<SceneKey, Scene> = HashMap::new();
    let geometries = Geometries::default();
    let all_limits = all_limits();
    let mut compared = 0;
    for start in ROUTES {
        for case in library.cases_that_begin(start).step_by(7) {
            let scene = case.build().expect("it builds").judged_scene().clone();
            let texels = scene.attachments.iter().map(|a| a.size[0] * a.size[1]);
            if texels.sum::<u32>() > 20_000 {
                continue;
            }
            let other = match first.entry(SceneKey::of(&scene)) {
                Entry::Vacant(free) => {
                    free.insert(scene);
                    continue;
                }
                Entry::Occupied(other) => other.into_mut(),
            };
            if *other == scene {
                continue;
            }
            let limits = &all_limits[compared % all_limits.len()];
            let rules = Rules::of(limits);
            let [a, b] = [&*other, &scene]
                .map(|scene| legal_set_of_texels(scene, limits, &rules, Texels::All, &geometries));
            assert_eq!(a, b, "{}", case.id());
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Large pictures of one geometry: one with few signatures, one with thousands, of which none is kept.
const LARGE: [(&str, &str); 2] = [
    (
        "size/hierarchy/cleared-in-part/",
        "format=depth24plus-stencil8",
    ),
    (
        "size/hierarchy/equal-redraw/",
        "format=depth16unorm/mesh=steep",
    ),
];

#[test]
fn large_pictures_of_one_geometry_have_the_sets_that_each_has_alone() {
    let library = Library::built_in();
    let limits = limits(APIS[0]);
    let rules = Rules::of(&limits);
    for (start, end) in LARGE {
        let shared = Geometries::default();
        let cases = library.cases_that_begin(start);
        let cases = cases.filter(|case| case.id().ends_with(end)).take(3);
        let mut count = 0;
        for case in cases {
            let scene = case.build().expect("it builds").judged_scene().clone();
            let [a, b] = [&shared, &Geometries::default()].map(|geometries| {
                legal_set_of_texels(&scene, &limits, &rules, Texels::All, geometries)
            });
            assert_eq!(a, b, "{}", case.id());
            count += 1;
        }
        // The third scene is the first one that uses what is kept.
        assert_eq!(count, 3, "{start}");
    }
}

#[test]
fn a_scene_key_depends_on_what_is_drawn_and_not_how() {
    let library = Library::built_in();
    let named = library
        .cases(Profile::Quick)
        .find(|case| case.id().starts_with("depth/"));
    let case = named.and_then(|case| case.build().ok()).expect("it builds");
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut scene = case.scene.clone();
        change(&mut scene);
        assert_ne!(scene, case.scene);
        SceneKey::of(&scene) == SceneKey::of(&case.scene)
    };
    fn mesh(scene: &mut Scene) -> &mut SharedMesh {
        &mut scene.passes[0].draws[0].mesh
    }
    assert!(changed(&|scene| {
        let vertices = &mut mesh(scene).vertices;
        vertices.reverse();
        let indices = (0..vertices.len() as u32).rev().collect();
        vertices.extend([Vertex {
            position: [9.0; 4],
            color: [9.0; 4],
            uv: [9.0; 2],
        }]);
        mesh(scene).indices = Some(indices);
    }));
    assert!(changed(&|scene| scene.passes[0].draws[0].fetch = Fetch {
        first_vertex: 5,
        ..Fetch::default()
    }));
    assert!(!changed(&|scene| mesh(scene).vertices.reverse()));
    assert!(!changed(&|scene| mesh(scene).vertices[0].uv[0] += 1.0));
    assert!(!changed(&|scene| {
        mesh(scene).vertices.pop();
    }));
    assert!(!changed(
        &|scene| scene.passes[0].draws[0].blend_constant[3] += 1.0
    ));
    assert!(!changed(&|scene| scene.read.clear()));
    let paths = library.cases_that_begin("paths/");
    let other = paths
        .map(|case| case.build().expect("it builds").scene.path)
        .find(|path| *path != Path::default());
    let other = other.expect("a path that is not the default");
    assert!(changed(&|scene| scene.path = other));
}
