//! What the built-in cases assert: a case of which every picture would be legal proves nothing.

use crate::common::{APIS, draw, limits};
use etalon_case::{Case, Library, Profile};
use etalon_frame::{AspectStatistics, Limits, compare};
use etalon_reference::{Texels, judgements_of};
use std::collections::BTreeMap;

/// First, middle and last case of a file's quick profile.
fn some(file: &etalon_case::CaseFile) -> Vec<Case> {
    let quick: Vec<_> = file.cases(Profile::Quick).collect();
    let mut places = vec![0, quick.len() / 2, quick.len() - 1];
    places.dedup();
    let built = places.into_iter().map(|i| quick[i].build());
    built.map(|c| c.expect("built-in cases build")).collect()
}

/// The large pictures of what is measured are looked at here and there, all others whole.
fn texels(case: &Case) -> Texels {
    match case.area() {
        "methods" | "perf" => Texels::AtMost(1024),
        _ => Texels::All,
    }
}

/// What is asserted of everything that the case reads back.
fn figures(case: &Case, limits: &Limits) -> AspectStatistics {
    let mut sum = AspectStatistics::default();
    for judgement in judgements_of(case.judged_scene(), limits, texels(case)) {
        for (_, aspect) in judgement.legal.statistics() {
            sum.add(aspect);
        }
    }
    sum
}

#[test]
fn every_file_asserts_something_under_every_api() {
    let library = Library::built_in().expect("built-in files parse");
    let every = APIS.map(|api| (api, limits(api)));
    let mut areas: BTreeMap<String, AspectStatistics> = BTreeMap::new();
    for file in library.files() {
        for case in some(file) {
            for (api, limits) in &every {
                let figures = figures(&case, limits);
                // A method may go so far that anything is legal: of that its distance from the truth is told.
                let some = figures.asserted > 0 || case.method.is_some();
                assert!(some, "{}: nothing by {api:?}", case.id);
                let area = areas.entry(case.area().to_owned()).or_default();
                area.add(figures);
            }
        }
    }
    // Of large pictures most is not looked at, and of methods much is open.
    let measured = |area: &str| matches!(area, "methods" | "perf");
    for (area, figures) in areas.into_iter().filter(|(area, _)| !measured(area)) {
        let share = figures.asserted as f64 / figures.channels as f64;
        assert!(share > 0.9, "{area}: {share:.3} is asserted");
        let exact = figures.exact as f64 / figures.asserted as f64;
        // Pictures that the rules leave open are held against each other in this area.
        // Random scenes blend several times over.
        let least = match area.as_str() {
            // A code that a texture hands on may move by one.
            "order" | "texture" => 0.3,
            "combined" => 0.4,
            _ => 0.5,
        };
        assert!(exact > least, "{area}: {exact:.3} is exact");
    }
}

#[test]
fn what_the_rasterizer_draws_of_them_is_legal_under_every_api() {
    let library = Library::built_in().expect("built-in files parse");
    let every = APIS.map(|api| (api, limits(api)));
    for file in library
        .files()
        .iter()
        .filter(|f| !f.name().starts_with("selftest/"))
    {
        for case in some(file) {
            for scene in case.scenes() {
                let frame = draw(scene);
                for (api, limits) in &every {
                    // Of a format whose encoding is open one reading has to fit.
                    let worst = judgements_of(scene, limits, texels(&case))
                        .iter()
                        .filter_map(|j| compare(&frame, &j.legal, &j.yardstick, 1).ok())
                        .map(|found| found.worst())
                        .min();
                    assert_eq!(worst, Some(None), "{} by {api:?}", case.id);
                }
            }
        }
    }
}
