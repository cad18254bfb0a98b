//! The texts of the mutants.

use etalon_mutants::mutants;
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
        "combined",
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
    }
}
