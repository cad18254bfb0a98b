//! The suite sees planted bugs: a fast part of what `etalon mutants` does whole.

#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use etalon_backend::Backend;
use etalon_case::{Case, Library, Profile};
use etalon_mutants::{MutantBackend, mutants};
use etalon_record::{Catch, Hunt, MutantInfo};
use etalon_runner::{HuntPlan, hunt, select};

/// Some of each class: real drivers' bugs, the smallest errors, and legal ones.
const FEW: [&str; 61] = [
    "bias/applied-to-lines",
    "bias/constant-doubled",
    "bias/d24-step-of-23-bits",
    "bias/slope-halved",
    "blend/alpha-factor-src-alpha-as-one-minus-src-alpha",
    "blend/color-operation-subtract-as-reverse-subtract",
    "blend/constant-in-5-bits",
    "blend/constant-in-7-bits",
    "blend/constant-plus-1-lsb",
    "blend/in-8-bits-truncated",
    "blend/min-max-apply-factors",
    "blend/store-in-7-bits",
    "bounds/rejected-as-failed-depth",
    "bounds/upper-excluded",
    "clear/color-in-7-bits",
    "clear/depth-in-16-bits",
    "clear/stencil-in-7-bits",
    "cull/front-face-inverted",
    "cull/odd-strip-triangles-reversed",
    "depth-range/reversed-held-to-near",
    "depth/compare-less-as-less-equal",
    "depth/d16-truncated",
    "depth/d24-in-22-bits",
    "depth/write-with-test-off",
    "dual-source/exchanged",
    "fetch/one-texel-down",
    "format/float-source-negatives-lost",
    "format/rgb10a2unorm-clear-red-blue-swapped",
    "format/snorm8-minus-one-as-lowest",
    "format/srgb8-stored-plus-1",
    "format/unorm5-destination-truncated",
    "geometry/last-column-missing",
    "logic/applied-to-float",
    "logic/xor-as-or",
    "read-only/depth-still-written",
    "readback/color-last-texel-off-by-one-lsb",
    "readback/depth-upside-down",
    "readback/stencil-neighbouring-samples-swapped",
    "readback/stencil-one-texel-right",
    "resolve/lost",
    "resolve/srgb-encoded",
    "samples/alpha-to-one-without-second-source",
    "samples/depth-of-the-first",
    "samples/rotated",
    "samples/second-missing",
    "scissor/ignored-for-stencil",
    "scissor/one-texel-wider",
    "stencil/back-overwrites-front",
    "stencil/fail-and-pass-op-both-applied",
    "stencil/increment-wrap-as-increment-clamp",
    "stencil/off-with-read-mask-zero",
    "sticky/blend-from-the-draw-before",
    "sticky/logic-from-the-draw-before",
    "sticky/scissor-from-the-case-before",
    "sticky/stencil-when-off-from-the-case-before",
    "targets/enables-inverted",
    "targets/second-from-the-first",
    "topology/restart-ignored",
    "upload/code-plus-1",
    "viewport/counted-from-the-bottom",
    "write-mask/zero-still-writes",
];

/// Several hundred cases that hold every kind.
const CASES: [&str; 34] = [
    "blend/changed-between-draws",
    "blend/clear",
    "blend/constant",
    "blend/dual-source/dst=src1/*",
    "blend/factors/dst=dst-alpha/*",
    "blend/fetch",
    "blend/float-range/*",
    "blend/formats-*/clear=between/*",
    "blend/formats-store/format=rgba8unorm-srgb/*",
    "blend/formats/*/format=bgr5a1unorm",
    "blend/independent",
    "blend/logic",
    "blend/logic-between-draws",
    "blend/operations",
    "blend/snorm",
    "blend/write-mask",
    "cull",
    "depth/bias-*",
    "depth/bounds*",
    "depth/clear",
    "depth/compare/*/format=depth*/write=true",
    "depth/read-only",
    "depth/test-off",
    "depth/viewport-range",
    "multisample/alpha-to-one-dual",
    "multisample/depth-stencil",
    "multisample/edges",
    "multisample/resolve*",
    "multisample/slanted",
    "scissor",
    "stencil/clear",
    "stencil/first-draw-off",
    "stencil/masks-zero",
    "stencil/{operations/depth_fail=invert/fail=z*,places/*,separate-faces/*}",
];

fn info(name: &str) -> MutantInfo {
    let mutant = mutants().iter().find(|m| m.name == name);
    let mutant = mutant.unwrap_or_else(|| panic!("there is no mutant {name}"));
    MutantInfo {
        name: mutant.name.clone(),
        about: mutant.about.clone(),
        source: mutant.source.to_owned(),
        area: mutant.area.to_owned(),
        legal: mutant.legal.map(str::to_owned),
    }
}

fn cases(globs: &[&str]) -> Vec<Case> {
    let library = Library::built_in().unwrap();
    let globs: Vec<String> = globs.iter().map(|g| (*g).to_owned()).collect();
    let chosen = select(&library, Profile::Quick, &globs).unwrap().cases;
    chosen.iter().map(|c| c.build().unwrap()).collect()
}

#[test]
fn several_hundred_cases_catch_what_must_be_caught() {
    let cases = cases(&CASES);
    let few = FEW.map(info);
    let plan = HuntPlan {
        cases: &cases,
        mutants: &few,
        full: false,
        jobs: 2,
    };
    let open = |name: &str| MutantBackend::new(name).map(|b| Box::new(b) as Box<dyn Backend>);
    let found = hunt(plan, &open, &|| {});
    assert_eq!(found.len(), FEW.len());
    for record in found {
        let name = &record.mutant.name;
        assert_eq!(record.complaint(), None, "{name}: {:?}", record.areas);
        assert!(record.by_own_area(), "{name}: {:?}", record.areas);
        let first = record.first.unwrap();
        assert!(first.texel.is_some(), "{name}");
    }
}

#[test]
fn an_unknown_bug_is_broken_and_ends_nothing() {
    let cases = cases(&["depth/clear"]);
    let few = ["depth/write-ignored", "clear/depth-zero"].map(info);
    let plan = HuntPlan {
        cases: &cases,
        mutants: &few,
        full: true,
        jobs: 1,
    };
    let open = |name: &str| {
        let known = name == "clear/depth-zero";
        let backend = known.then(|| MutantBackend::new(name)).flatten();
        backend.map(|b| Box::new(b) as Box<dyn Backend>)
    };
    let found = hunt(plan, &open, &|| {});
    assert_eq!(found[0].outcome, Catch::Broken);
    assert!(found[0].complaint().is_some());
    assert_eq!(found[1].outcome, Catch::Caught);
    let tally = &found[1].areas[0];
    let all = tally.pass + tally.imprecise + tally.fail + tally.broken;
    assert_eq!(all, cases.len() as u64);
}

fn etalon(arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("etalon").unwrap();
    command.args(arguments).assert()
}

#[test]
fn the_list_names_every_bug_with_a_sentence() {
    let output = etalon(&["mutants", "--list"]).success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    assert_eq!(text.lines().count(), mutants().len());
    assert!(text.lines().all(|l| l.ends_with('.')), "{text}");
    let output = etalon(&["mutants", "--list", "stencil/back-*", "--format", "json"]).success();
    let some: Vec<MutantInfo> = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert!(some.iter().all(|m| m.name.starts_with("stencil/back-")));
}

#[test]
fn a_survivor_without_proof_is_a_failure_and_the_report_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let hunt = ["mutants", "blend/never", "--out", out, "--case"];
    etalon(&[&hunt[..], &["depth/clear"]].concat())
        .code(1)
        .stdout(predicates::str::contains("blend/never: nothing noticed it"));
    etalon(&[&hunt[..], &["blend/operations"]].concat()).success();
    let text = std::fs::read(folder.path().join("mutants.json")).unwrap();
    let written: Hunt = serde_json::from_slice(&text).unwrap();
    assert_eq!(written.count(Catch::Caught), 1);
    let page = std::fs::read_to_string(folder.path().join("mutants.html")).unwrap();
    assert!(page.contains("id=\"blend/never\""));
    assert!(!page.contains("http://") && !page.contains("https://"));
}

#[test]
fn a_glob_without_a_match_is_nothing_selected() {
    etalon(&["mutants", "no/such/bug"]).code(4);
    etalon(&["mutants", "--case", "no/such/case"]).code(4);
    etalon(&["mutants", "--case", "selftest"]).code(4);
    etalon(&["mutants", "a["]).code(64);
}
