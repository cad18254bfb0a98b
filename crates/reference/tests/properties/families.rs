//! The built-in cases, area by area: each asserts something under every API, and the rasterizer's frames of
//! it are legal under every API. A case with only legal frames would prove nothing.
//!
//! The first, middle and last case of each file's quick profile represent it; the middle one alone in
//! `methods` and `perf`, whose pictures are large. With `ETALON_TESTS=all` all of them are judged.

use crate::common::{APIS, draw, limits};
use etalon_case::{Case, CaseFile, Library, Profile};
use etalon_frame::{Api, AspectStatistics, compare};
use etalon_reference::{Texels, judgements_of};
use std::collections::BTreeSet;

/// Declares a test for each area, and the list of them.
macro_rules! areas {
    ($($test:ident = $area:literal),+ $(,)?) => {
        const AREAS: &[&str] = &[$($area),+];
        mod some_cases_of_each_file_assert_and_are_legal_under_every_api {
            $(#[test]
            fn $test() {
                super::assert_area($area);
            })+
        }
    };
}

areas! {
    blend = "blend",
    capabilities = "capabilities",
    combined = "combined",
    cull = "cull",
    depth = "depth",
    early_z = "early-z",
    found = "found",
    methods = "methods",
    multisample = "multisample",
    order = "order",
    paths = "paths",
    perf = "perf",
    scissor = "scissor",
    selftest = "selftest",
    sequence = "sequence",
    size = "size",
    stencil = "stencil",
    texture = "texture",
}

fn area_of(file: &CaseFile) -> &str {
    file.name().split('/').next().unwrap_or_default()
}

/// Returns true if tests leave nothing out.
fn all_cases() -> bool {
    std::env::var_os("ETALON_TESTS").is_some_and(|v| v == "all")
}

/// Returns the cases that represent a file, or all of its candidates for quick, or of the full profile if there are
/// none.
fn representatives(file: &CaseFile) -> Vec<Case> {
    let mut cases: Vec<_> = file.cases(Profile::Candidates).collect();
    if cases.is_empty() {
        cases.extend(file.cases(Profile::Full));
    }
    assert!(!cases.is_empty(), "{} has no case", file.name());
    let mut places = if all_cases() {
        (0..cases.len()).collect()
    } else if file.is_measured() {
        vec![cases.len() / 2]
    } else {
        vec![0, cases.len() / 2, cases.len() - 1]
    };
    places.dedup();
    let built = places.into_iter().map(|i| cases[i].build());
    built.map(|c| c.expect("built-in cases build")).collect()
}

/// A lattice of the large pictures of measured cases, all texels of others.
fn texels(case: &Case) -> Texels {
    if case.measured {
        Texels::AtMost(1024)
    } else {
        Texels::All
    }
}

/// Returns true if an API defines what a case draws, and defines it as the rasterizer draws it. Programs of
/// OpenGL ES need fragment shaders, and OpenGL ignores shaders' masks in single-sampled texels and keeps written depths
/// beyond the viewport's range.
fn is_defined_by(api: Api, case: &Case) -> bool {
    let opengl = matches!(api, Api::OpenGl | Api::OpenGlEs);
    case.scene.passes.iter().all(|pass| {
        let samples = case.scene.pass_samples(pass);
        pass.draws.iter().all(|draw| {
            let state = &draw.multisample;
            let covers = draw.shader.writes_mask()
                || state.mask != u32::MAX
                || state.alpha_to_coverage
                || state.alpha_to_one;
            let masked = covers && samples == 1;
            let ranged = draw.viewport.depth != [0.0, 1.0] && !draw.depth_clamp;
            let beyond = draw.shader.writes_depth() && ranged;
            (draw.shader.has_fragment() || api != Api::OpenGlEs) && !((masked || beyond) && opengl)
        })
    })
}

/// Returns the APIs under which a case is judged: all that define what it draws, or one of them if its
/// picture is large.
fn apis(case: &Case) -> Vec<Api> {
    let mut apis = APIS.to_vec();
    apis.retain(|api| is_defined_by(*api, case));
    if case.measured && !all_cases() {
        apis = vec![apis[case.id.len() % apis.len()]];
    }
    apis
}

/// Asserts that a case asserts something, and that its frames are legal, under each API that defines it.
/// Returns the sum of its assertions.
fn assert_legal(case: &Case) -> AspectStatistics {
    // A selftest is judged as another scene, of which no frame is drawn here: only its assertions are counted.
    let scenes: Vec<_> = match &case.judged_as {
        Some(scene) => vec![(scene, None)],
        None => case.scenes().map(|s| (s, Some(draw(s)))).collect(),
    };
    let mut sum = AspectStatistics::default();
    for api in apis(case) {
        let limits = limits(api);
        let mut asserted = AspectStatistics::default();
        for (index, (scene, frame)) in scenes.iter().enumerate() {
            let judgements = judgements_of(scene, &limits, texels(case));
            // Counts the case once, not its variants.
            if index == 0 {
                for judgement in &judgements {
                    for (_, aspect) in judgement.legal.statistics() {
                        asserted.add(*aspect);
                    }
                }
            }
            if let Some(frame) = frame {
                // If a format's encoding is open, one of the encodings must fit.
                let worst = judgements
                    .iter()
                    .filter_map(|j| compare(frame, &j.legal, &j.yardstick, 1).ok())
                    .map(|comparison| comparison.worst())
                    .min();
                assert_eq!(worst, Some(None), "{} by {api:?}", case.id);
            }
        }
        // A method can leave everything open: its distance from the truth is measured.
        let asserts = asserted.asserted > 0 || case.method.is_some();
        assert!(asserts, "{}: nothing by {api:?}", case.id);
        sum.add(asserted);
    }
    sum
}

/// Asserts that the cases of an area are legal, and that most of their channels are asserted.
fn assert_area(area: &str) {
    let library = Library::built_in();
    let files = || library.files().filter(|f| area_of(f) == area);
    // Values beside all codes are many, and most may be stored as either neighbour: they have a share of their own.
    let (codes, others): (Vec<_>, Vec<_>) =
        files().partition(|f| f.stem().starts_with("blend/codes/"));
    for (part, files) in [(area, others), ("blend/codes", codes)] {
        let mut sum = AspectStatistics::default();
        for case in files.iter().copied().flat_map(representatives) {
            sum.add(assert_legal(&case));
        }
        // Most texels of large pictures are not judged, and methods leave much open.
        if !files.iter().copied().all(CaseFile::is_measured) {
            assert_shares(part, sum);
        }
    }
}

/// Asserts that most channels are asserted, and many of them exactly.
fn assert_shares(area: &str, sum: AspectStatistics) {
    assert!(sum.asserted > 0, "{area} asserts nothing");
    let share = sum.asserted as f64 / sum.channels as f64;
    assert!(share > 0.9, "{area}: {share:.3} is asserted");
    let exact = sum.exact as f64 / sum.asserted as f64;
    let least = match area {
        // There, relations assert what the rules leave open; a texture can move a code by one.
        "order" | "texture" => 0.3,
        // Random scenes blend several times over.
        "combined" => 0.4,
        // A value a fiftieth of a step beside a code may be stored as either neighbour.
        "blend/codes" => 0.07,
        // One scene, for whose advanced blending the texts allow a code or two.
        "found" => 0.2,
        _ => 0.5,
    };
    assert!(exact > least, "{area}: {exact:.3} is exact");
}

#[test]
fn every_area_has_its_test() {
    let library = Library::built_in();
    let areas: BTreeSet<&str> = library.files().map(area_of).collect();
    assert_eq!(areas, AREAS.iter().copied().collect());
}
