//! Rules, limits, and scenes from JSON.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Api, Frame, Limits};
use etalon_reference::Rules;
use etalon_scene::Scene;
use proptest::test_runner::{Config, RngSeed};

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
