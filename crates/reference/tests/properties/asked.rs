//! A legal set depends only on what the judge asks of rules and limits.

use crate::common::{APIS, limits};
use etalon_case::{Library, Profile};
use etalon_frame::{ApiVersion, Limits, ReadPath};
use etalon_reference::{Geometries, KnownSets, Rules, Texels, judgements_by, legal_set_of_texels};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;

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
fn rules_that_agree_on_what_was_asked_give_the_same_sets() {
    let library = Library::built_in().expect("built-in cases parse");
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
fn a_clone_was_asked_for_nothing() {
    let rules = Rules::of(&limits(APIS[0]));
    assert_eq!(rules.asked().len(), 0);
    let _ = rules.store.value();
    assert_eq!(rules.asked(), ["store"]);
    assert_eq!(rules.clone().asked().len(), 0);
    assert_eq!(rules.clone(), rules);
}
