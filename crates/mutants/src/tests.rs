use super::*;
use etalon_backend::Backend;
use etalon_case::{Case, Library, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::Frame;
use std::collections::HashSet;

fn draw(backend: &dyn Backend, case: &Case) -> Frame {
    let mut prepared = backend.prepare(&case.scene).expect("prepares");
    prepared.submit().expect("draws");
    prepared.read_back().expect("reads")
}

#[test]
fn every_mutant_is_named_explained_and_sourced() {
    let areas = [
        "depth",
        "stencil",
        "blend",
        "cull",
        "multisample",
        "scissor",
        "early-z",
        "texture",
        "order",
    ];
    let mut names = HashSet::new();
    assert!(mutants().len() >= 1000, "{}", mutants().len());
    for mutant in mutants() {
        assert!(names.insert(&mutant.name), "{} stands twice", mutant.name);
        let fine = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-/".contains(c);
        assert!(mutant.name.chars().all(fine), "{}", mutant.name);
        assert_eq!(mutant.name.split('/').count(), 2, "{}", mutant.name);
        assert!(mutant.about.ends_with('.'), "{}", mutant.name);
        assert!(!mutant.source.is_empty(), "{}", mutant.name);
        assert!(areas.contains(&mutant.area), "{}", mutant.name);
        let cites = |why: &str| why.contains(": ");
        assert!(mutant.legal.is_none_or(cites), "{}", mutant.name);
    }
}

#[test]
fn every_mutant_changes_the_frame_of_some_case() {
    let library = Library::built_in().expect("built-in files parse");
    // What `etalon mutants` draws: pictures that are timed or measured against the truth are no part.
    let cases: Vec<Case> = library
        .cases(Profile::Quick)
        .filter(|c| {
            !["perf/", "methods/"]
                .iter()
                .any(|area| c.id().starts_with(area))
        })
        .map(|c| c.build().expect("built-in cases build"))
        .filter(|c| c.judged_as.is_none())
        .collect();
    let faithful = CpuBackend::new("cpu");
    let frames: Vec<Frame> = cases.iter().map(|c| draw(&faithful, c)).collect();
    let mut idle = Vec::new();
    for mutant in mutants() {
        let backend = MutantBackend::new(&mutant.name).expect("is registered");
        // Its own area first: most show there at once.
        let own = |case: &Case| case.area() == mutant.area;
        let pairs = || cases.iter().zip(&frames);
        let mut ordered = pairs()
            .filter(|(c, _)| own(c))
            .chain(pairs().filter(|(c, _)| !own(c)));
        if !ordered.any(|(case, right)| draw(&backend, case) != *right) {
            idle.push(&mutant.name);
        }
    }
    // What the quick cases leave idle, all cases of its own area must not.
    idle.retain(|name| {
        let mutant = mutants().iter().find(|m| &m.name == *name);
        let area = mutant.map_or("", |m| m.area);
        let own = library
            .cases(Profile::Full)
            .filter(|c| c.id().starts_with(area));
        let backend = MutantBackend::new(name).expect("is registered");
        let mut own = own.map(|c| c.build().expect("built-in cases build"));
        !own.any(|case| draw(&backend, &case) != draw(&faithful, &case))
    });
    assert!(idle.is_empty(), "these change nothing anywhere: {idle:#?}");
}
