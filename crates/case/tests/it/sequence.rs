//! The states that `cases/sequence/state` changes between draws: every state of a draw has a file, and a case
//! changes one state. After a state is added to the model, this does not compile until the state is named.

mod states;

use etalon_case::{Case, Library, Profile};
use etalon_scene::Draw;
use states::{every_state, states};
use std::collections::BTreeSet;

/// The draws that alternate: the last three.
fn steps(case: &Case) -> [&Draw; 3] {
    let draws: Vec<&Draw> = case.scene.passes.iter().flat_map(|p| &p.draws).collect();
    let last = draws.last_chunk().expect("a sequence has three steps");
    *last
}

/// The state in which two draws differ: the common part of the names of all differences. `None` if nothing
/// differs.
fn differing(a: &Draw, b: &Draw) -> Option<String> {
    let (a, b) = (states(a), states(b));
    let names: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
    let differ = names
        .into_iter()
        .filter(|name| a.get(*name) != b.get(*name));
    let paths: Vec<Vec<&str>> = differ.map(|name| name.split('.').collect()).collect();
    let (first, others) = paths.split_first()?;
    let is_common = |n: &usize| others.iter().all(|path| path.get(*n) == first.get(*n));
    let common = (0..first.len()).take_while(is_common).count();
    Some(first[..common].join("."))
}

#[test]
fn every_state_of_a_draw_has_its_file() {
    let library = Library::built_in();
    let mut changed = BTreeSet::new();
    for file in library.files() {
        if !file.name().starts_with("sequence/state/") {
            continue;
        }
        let mut changing = BTreeSet::new();
        for case in file.cases(Profile::Full) {
            let id = case.id();
            let case = case.build().expect("built-in cases build");
            let [first, then, again] = steps(&case);
            assert_eq!(differing(first, again), None, "{id}");
            let value = |axis: &str| id.split('/').find_map(|part| part.strip_prefix(axis));
            let state = differing(first, then);
            let same = value("first=") == value("then=");
            assert_eq!(state.is_none(), same, "{id}");
            assert_ne!(state.as_deref(), Some(""), "{id} changes several states");
            changing.extend(state);
        }
        // A disabled test has no parts that could differ.
        let widest = changing.iter().min_by_key(|name| name.len());
        let widest = widest.unwrap_or_else(|| panic!("{} changes nothing", file.name()));
        let is_part = |name: &String| name.starts_with(widest.as_str());
        assert!(
            changing.iter().all(is_part),
            "{}: {changing:?}",
            file.name()
        );
        changed.insert(widest.clone());
    }
    let every = every_state();
    let missing: Vec<_> = every.difference(&changed).collect();
    assert!(missing.is_empty(), "no file changes {missing:?}");
    // State of separate targets shows if the first one's state stays.
    for name in ["targets.1.blend", "targets.1.write_mask"] {
        assert!(changed.contains(name), "no file changes {name}");
    }
}

#[test]
fn draws_take_turns_in_a_pass_over_passes_and_over_framebuffers() {
    let library = Library::built_in();
    let cases = library.cases(Profile::Full);
    for case in cases.filter(|c| c.id().starts_with("sequence/state/")) {
        let case = case.build().expect("built-in cases build");
        let passes = &case.scene.passes;
        let targets = |pass: &etalon_scene::Pass| (pass.color.clone(), pass.depth_stencil);
        let last = passes.last().map(targets);
        let before = passes.iter().rev().nth(1).map(targets);
        if case.id.contains("/across=draw/") {
            assert_eq!(passes.len(), 1, "{}", case.id);
        } else {
            assert!(passes.len() >= 3, "{}", case.id);
            let other = case.id.contains("/across=framebuffer/");
            assert_eq!(last != before, other, "{}", case.id);
        }
    }
}
