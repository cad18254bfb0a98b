//! The ids of method cases, and how many there are.

use etalon_case::{Library, Profile};
use std::collections::BTreeSet;

#[test]
fn ids_name_question_scene_and_method_and_are_not_too_many() {
    let library = Library::built_in().expect("built-in files parse");
    let questions = ["transparency", "cut-outs", "anti-aliasing"];
    let (mut quick, mut full) = (0, 0);
    for file in library.files() {
        let place: Vec<&str> = file.name().split('/').collect();
        let ["methods", question, scene] = place[..] else {
            continue;
        };
        if !questions.contains(&question) {
            continue;
        }
        let scene = scene.trim_end_matches(".json");
        quick += file.cases(Profile::Quick).count();
        full += file.cases(Profile::Full).count();
        for case in file.cases(Profile::Full) {
            let id = case.id();
            let method = case.build().expect("built-in cases build").method;
            let method = method.expect("a method case has a method");
            let start = format!("methods/{question}/{scene}/method={}", method.name);
            let rest = id.strip_prefix(&start);
            assert!(
                rest.is_some_and(|r| r.is_empty() || r.starts_with('/')),
                "{id}"
            );
            assert_eq!(
                (method.question.as_str(), method.scene.as_str()),
                (question, scene)
            );
            if let Some(parameter) = method.parameter {
                let value = format!("/{}={}", parameter.name, parameter.value);
                assert!(id.contains(&value), "{id} without {value}");
            }
        }
    }
    assert!((40..=80).contains(&quick), "{quick}");
    assert!((300..=500).contains(&full), "{full}");
}

#[test]
fn ids_begin_with_the_method_and_files_name_a_parameter() {
    let library = Library::built_in().expect("built-in files parse");
    let mut seen = BTreeSet::new();
    for case in library.cases(Profile::Full) {
        let id = case.id();
        let parts: Vec<&str> = id.split('/').collect();
        let ["methods", question, scene, method, ..] = parts[..] else {
            continue;
        };
        assert!(method.starts_with("method="), "{id}");
        let case = case.build().unwrap_or_else(|e| panic!("{e}"));
        let built = case.method.expect("a method case has a method");
        assert_eq!(
            (built.question.as_str(), built.scene.as_str()),
            (question, scene)
        );
        assert_eq!(format!("method={}", built.name), method);
        seen.insert(question.to_owned());
    }
    let due = [
        "accumulation",
        "culling",
        "depth-precision",
        "depth-shown",
        "stencil-effects",
        "visibility-cost",
    ];
    assert!(due.iter().all(|q| seen.contains(*q)), "{seen:?}");
}
