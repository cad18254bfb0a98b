#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::hierarchy::faithful;
use crate::mutants;
use crate::plant::Plant;
use etalon_backend::Prepared;
use etalon_cpu::PreparedScene;
use etalon_cpu::steps::Faithful;
use std::collections::HashSet;

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
        "capabilities",
        "size",
        "sequence",
        "paths",
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

/// A coarse depth buffer without a bug rejects only fragments that fail the depth test.
#[test]
fn a_right_coarse_depth_changes_no_frame() {
    let library = etalon_case::Library::built_in();
    let areas = ["depth/", "stencil/", "multisample/depth", "size/hierarchy"];
    let cases: Vec<_> = library
        .cases(etalon_case::Profile::Quick)
        .filter(|case| areas.iter().any(|area| case.id().starts_with(area)))
        .map(|case| case.build().unwrap())
        .collect();
    let Plant::Memory(coarse) = faithful() else {
        panic!("a coarse depth is a bug of memory");
    };
    let draw = |mut prepared: Box<dyn Prepared>| {
        prepared.submit().unwrap();
        prepared.read_back().unwrap()
    };
    for scene in cases.iter().flat_map(|case| case.scenes()) {
        let expected = PreparedScene::new(scene.clone(), Faithful);
        let found = PreparedScene::new(scene.clone(), coarse());
        assert_eq!(draw(Box::new(expected)), draw(Box::new(found)));
    }
}
