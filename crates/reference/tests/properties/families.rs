//! What the built-in cases assert: a case of which every picture would be legal proves nothing.

use crate::common::{APIS, limits};
use etalon_case::{Case, Library, Profile};
use etalon_frame::{AspectStatistics, Limits};
use etalon_reference::judgements;
use std::collections::BTreeMap;

/// First, middle and last case of a file's quick profile.
fn some(file: &etalon_case::CaseFile) -> Vec<Case> {
    let quick: Vec<_> = file.cases(Profile::Quick).collect();
    let mut places = vec![0, quick.len() / 2, quick.len() - 1];
    places.dedup();
    let built = places.into_iter().map(|i| quick[i].build());
    built.map(|c| c.expect("built-in cases build")).collect()
}

/// What is asserted of everything that the case reads back.
fn figures(case: &Case, limits: &Limits) -> AspectStatistics {
    let mut sum = AspectStatistics::default();
    for judgement in judgements(case.judged_scene(), limits) {
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
                assert!(figures.asserted > 0, "{}: nothing by {api:?}", case.id);
                let area = areas.entry(case.area().to_owned()).or_default();
                area.add(figures);
            }
        }
    }
    for (area, figures) in areas {
        let share = figures.asserted as f64 / figures.channels as f64;
        assert!(share > 0.9, "{area}: {share:.3} is asserted");
        let exact = figures.exact as f64 / figures.asserted as f64;
        assert!(exact > 0.5, "{area}: {exact:.3} is exact");
    }
}
