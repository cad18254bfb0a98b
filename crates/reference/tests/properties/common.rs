//! Rules, limits, and scenes from JSON.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, CodeInterval, Frame, Limits};
use etalon_reference::Rules;
use etalon_scene::Scene;
use proptest::prop_assert;
use proptest::test_runner::{Config, RngSeed, TestCaseError};

/// Every API.
pub(crate) const APIS: [Api; 4] = [Api::Vulkan, Api::OpenGl, Api::OpenGlEs, Api::WebGpu];

/// The rasterizer's limits under another API's rules.
pub(crate) fn limits(api: Api) -> Limits {
    let mut limits = CpuBackend::new("cpu").limits().clone();
    limits.api = api;
    limits
}

/// Every API's rules, and the yardstick.
pub(crate) fn all_rules() -> Vec<Rules> {
    let mut rules: Vec<Rules> = APIS
        .into_iter()
        .map(|api| Rules::of(&limits(api)))
        .collect();
    rules.push(Rules::yardstick(&limits(Api::Vulkan)));
    rules
}

/// The scene of a case file, from its attachments, passes and read list.
pub(crate) fn scene(body: &str) -> Scene {
    let text = format!(r#"{{"about":"t","spec":["t"],"scene":{body}}}"#);
    let file = CaseFile::parse("t.json", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let case = file.cases(Profile::Full).next().expect("one case");
    case.build().unwrap_or_else(|e| panic!("{e}\n{text}")).scene
}

/// Returns the rasterizer's frame.
pub(crate) fn draw(scene: &Scene) -> Frame {
    let backend = CpuBackend::new("cpu");
    let mut prepared = backend.prepare(scene).expect("the rasterizer prepares");
    prepared.submit().expect("the rasterizer draws");
    prepared.read_back().expect("the rasterizer reads back")
}

/// A number of cases, the same ones in every run, so that a commit is green or red once and for all.
/// `PROPTEST_RNG_SEED` and `PROPTEST_CASES` choose others.
pub(crate) fn config(cases: u32) -> Config {
    let given = |name: &str| std::env::var(name).ok().and_then(|v| v.parse::<u64>().ok());
    Config {
        cases: given("PROPTEST_CASES").map_or(cases, |n| n as u32),
        rng_seed: RngSeed::Fixed(given("PROPTEST_RNG_SEED").unwrap_or(1)),
        failure_persistence: None,
        ..Config::default()
    }
}

/// Asserts that the codes of a colour are inside intervals, by some rules.
pub(crate) fn assert_inside(
    rules: &str,
    codes: [i64; 4],
    intervals: [CodeInterval; 4],
) -> Result<(), TestCaseError> {
    for c in 0..4 {
        prop_assert!(
            intervals[c].contains(codes[c]),
            "{rules}, channel {c}: {} is not in {:?}",
            codes[c],
            intervals[c]
        );
    }
    Ok(())
}

/// Asserts that the intervals of a colour are within those of wider rules.
pub(crate) fn assert_within(
    inner: [CodeInterval; 4],
    outer: [CodeInterval; 4],
    wide: &Rules,
) -> Result<(), TestCaseError> {
    for c in 0..4 {
        prop_assert!(
            outer[c].low <= inner[c].low && inner[c].high <= outer[c].high,
            "channel {c}: {:?} is not in {:?} of {wide:?}",
            inner[c],
            outer[c]
        );
    }
    Ok(())
}
