//! The ids and the number of method cases.

use etalon_case::{CaseFile, Library, Profile};
use etalon_methods::{at_size, claims, lessons};
use etalon_scene::Shader;
use std::collections::BTreeSet;

#[test]
fn ids_name_question_scene_and_method_and_are_not_too_many() {
    let library = Library::built_in();
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
    assert!((100..=163).contains(&quick), "{quick}");
    assert!((300..=704).contains(&full), "{full}");
}

/// A chart of methods at different parameters would compare nothing.
#[test]
fn the_quick_profile_draws_whole_scenes() {
    let library = Library::built_in();
    let mut quick = 0;
    for file in library.files_where(|stem| stem.starts_with("methods/")) {
        let split = |id: String| -> (String, String) {
            let (before, rest) = id.split_once("/method=").expect("an axis of methods");
            let (method, setting) = rest.split_once('/').unwrap_or((rest, ""));
            (method.to_owned(), format!("{before}/{setting}"))
        };
        let combinations = |profile| -> BTreeSet<(String, String)> {
            file.cases(profile).map(|c| split(c.id())).collect()
        };
        let (some, full) = (combinations(Profile::Quick), combinations(Profile::Full));
        let methods: BTreeSet<&String> = full.iter().map(|(method, _)| method).collect();
        let settings: BTreeSet<&String> = some.iter().map(|(_, setting)| setting).collect();
        for (method, setting) in methods
            .iter()
            .flat_map(|m| settings.iter().map(move |s| (m, s)))
        {
            let pair = ((*method).clone(), (*setting).clone());
            assert!(some.contains(&pair), "{}: {pair:?}", file.name());
        }
        quick += some.len();
    }
    assert!((160..=239).contains(&quick), "{quick}");
}

#[test]
fn a_covering_array_of_methods_is_refused() {
    let file = |quick: &str| {
        let text = format!(
            r#"{{"about":"t","spec":["t"],"quick":{quick},"axes":{{"method":["a","b"],"k":[1,2]}},
            "method":{{"question":"transparency"}}}}"#
        );
        CaseFile::parse("methods/transparency/t.json", &text)
    };
    for bad in [
        r#""pairwise""#,
        r#"{"each":1}"#,
        r#"{"first":2}"#,
        r#"{"where":{"method":"a"}}"#,
        r#"{"any":[{"k":"1"},{"k":"2","method":"b"}]}"#,
    ] {
        let error = file(bad).expect_err(bad);
        assert_eq!((error.key.as_str(), error.line), ("quick", 1), "{error}");
    }
    let good = file(r#"{"any":[{"k":"1"},{"k":"2"}]}"#).expect("parses");
    assert_eq!(good.cases(Profile::Quick).count(), 4);
}

#[test]
fn ids_begin_with_the_method_and_files_name_a_parameter() {
    let library = Library::built_in();
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
    let expected = [
        "accumulation",
        "culling",
        "depth-precision",
        "depth-shown",
        "stencil-effects",
        "visibility-cost",
    ];
    assert!(expected.iter().all(|q| seen.contains(*q)), "{seen:?}");
}

#[test]
fn every_method_is_explained_and_every_claim_names_existing_methods() {
    let library = Library::built_in();
    let mut methods: BTreeSet<(String, String)> = BTreeSet::new();
    let mut families: BTreeSet<(String, String)> = BTreeSet::new();
    for case in library.cases(Profile::Full) {
        let id = case.id();
        let parts: Vec<&str> = id.split('/').collect();
        let ["methods", question, family, method, ..] = parts[..] else {
            continue;
        };
        let method = method.trim_start_matches("method=");
        methods.insert((question.to_owned(), method.to_owned()));
        families.insert((question.to_owned(), family.to_owned()));
    }
    for (question, method) in &methods {
        let found = lessons(question).iter().filter(|l| l.method == method);
        assert_eq!(found.count(), 1, "{question}/{method}");
    }
    let questions: BTreeSet<&String> = methods.iter().map(|(q, _)| q).collect();
    for lesson in questions.iter().flat_map(|q| lessons(q)) {
        assert!(
            methods.iter().any(|(_, m)| m == lesson.method),
            "{}",
            lesson.method
        );
        assert!(
            lesson.works.ends_with('.') && lesson.fails.ends_with('.'),
            "{}",
            lesson.method
        );
    }
    for claim in claims() {
        for family in claim.families {
            let named = (claim.question.to_owned(), (*family).to_owned());
            assert!(families.contains(&named), "{}: {family}", claim.title);
        }
        let text = format!("{:?}", claim.test);
        let quoted: Vec<&str> = text.split('"').skip(1).step_by(2).collect();
        assert!(!quoted.is_empty(), "{text}");
        for method in quoted {
            let named = (claim.question.to_owned(), method.to_owned());
            assert!(methods.contains(&named), "{}: {method}", claim.title);
        }
    }
}

#[test]
fn every_method_can_be_drawn_at_the_sizes_of_frames() {
    let library = Library::built_in();
    for file in library.files_where(|stem| stem.starts_with("methods/")) {
        for case in file.cases(Profile::Quick) {
            let id = case.id();
            let case = case.build().expect("built-in cases build");
            let method = case.method.expect("a method case has a method");
            let same = at_size(&case.scene, &method.truth, method.truth.size);
            assert_eq!(same.truth, method.truth, "{id}");
            if !id.contains("method=coverage-to-alpha") {
                assert_eq!(same.scene, case.scene, "{id}");
            }
            let size = [1280, 720];
            let sized = at_size(&case.scene, &method.truth, size);
            let picture = &sized.scene.attachments[sized.scene.read[0]];
            assert_eq!((picture.size, sized.truth.size), (size, size), "{id}");
            if let Some(pool) = sized.scene.pool {
                assert_eq!(pool.size, size, "{id}");
            }
            for pass in &sized.scene.passes {
                let drawn = sized.scene.pass_size(pass);
                assert_eq!(drawn[0] * 9, drawn[1] * 16, "{id}");
                for draw in &pass.draws {
                    // Nothing else is meant in texels.
                    assert_eq!(draw.scissor, None, "{id}");
                    // Only the vertices of jittered frames move.
                    let at_home = draw.mesh.vertices.iter().all(|v| v.uv == [0.0; 2]);
                    let is_flat = draw.shader == Shader::FlatColor;
                    assert!(
                        !is_flat || at_home || id.contains("method=jittered"),
                        "{id}"
                    );
                    let [_, _, width, height] = draw.viewport.rect;
                    assert_eq!([width, height], drawn.map(|side| side as f32), "{id}");
                    let fetched = draw
                        .textures
                        .iter()
                        .filter(|_| !draw.shader.samples_texture());
                    for texture in fetched {
                        assert_eq!(sized.scene.attachments[*texture].size, drawn, "{id}");
                    }
                }
            }
        }
    }
}
