//! `etalon mutants`, and its hunt. `mutants/tests/hunt` hunts with the whole library.

#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use etalon_backend::Backend;
use etalon_case::{Case, Library, Profile, select};
use etalon_mutants::{MutantBackend, innocents, mutants};
use etalon_record::{Catch, Hunt, InnocentTally, MutantInfo, Verdict};
use etalon_runner::{HuntPlan, Hunted, hunt};

/// Mutants in scenes, steps and frames, and two with state that persists.
const FEW: [&str; 8] = [
    "blend/constant-plus-1-lsb",
    "clear/stencil-in-7-bits",
    "depth/compare-never-as-equal",
    "readback/color-last-texel-off-by-one-lsb",
    "scissor/one-texel-wider",
    "stencil/back-overwrites-front",
    "sticky/blend-from-the-draw-before",
    "sticky/scissor-from-the-case-before",
];

/// Cases that catch them.
const CASES: [&str; 7] = [
    "blend/changed-between-draws",
    "blend/constant",
    "depth/bias-*",
    "depth/compare/*/format=depth*/write=true",
    "scissor",
    "stencil/clear",
    "stencil/separate-faces/*",
];

fn info(name: &str) -> MutantInfo {
    let mutant = mutants().iter().find(|m| m.name == name);
    let mutant = mutant.unwrap_or_else(|| panic!("there is no mutant {name}"));
    MutantInfo {
        name: mutant.name.clone(),
        about: mutant.about.clone(),
        source: mutant.source.to_owned(),
        area: mutant.area.to_owned(),
    }
}

fn cases(globs: &[&str]) -> Vec<Case> {
    let library = Library::built_in();
    let globs: Vec<String> = globs.iter().map(|g| (*g).to_owned()).collect();
    let chosen = select(library, Profile::Candidates, &globs).unwrap().cases;
    chosen.iter().map(|c| c.build().unwrap()).collect()
}

#[test]
fn a_hunt_catches_what_must_be_caught_and_no_more() {
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
    assert_eq!(found.records.len(), FEW.len());
    for record in found.records {
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
    let Hunted {
        records: found,
        catches,
    } = hunt(plan, &open, &|| {});
    assert_eq!(found[0].outcome, Catch::Broken);
    assert!(found[0].complaint().is_some());
    assert_eq!(found[1].outcome, Catch::Caught);
    let tally = &found[1].areas[0];
    let judged = tally.pass + tally.imprecise + tally.fail + tally.broken;
    assert_eq!(judged, cases.len() as u64);
    let failing = catches.iter().filter(|c| c.bugs == [1]);
    assert_eq!(failing.count() as u64, tally.fail);
    assert!(catches.iter().all(|c| !c.cost.is_zero()));
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
fn no_innocent_is_accused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let cases = [
        "blend/formats/*",
        "blend/snorm/*",
        "blend/advanced*",
        "cull/clipping/lines/*",
        "cull/points*",
        "depth/bias-*",
        "depth/frag-coord/*",
        "depth/clamp-written/*",
        "early-z/colorless-mask/*",
        "early-z/shader-mask*",
        "multisample/input-mask/*",
        "multisample/sample-shading-edges/*",
        "multisample/slanted/*",
        "texture/interpolation/*",
        "scissor/viewport*",
    ];
    let mut arguments = vec!["mutants", "--innocents", "--format", "json", "--out", out];
    arguments.extend(cases.iter().flat_map(|glob| ["--case", *glob]));
    let output = etalon(&arguments).success();
    let hunt: Hunt = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert!(hunt.mutants.is_empty());
    assert_eq!(hunt.innocents.len(), innocents().len());
    let changed = hunt.innocents.iter().filter(|i| i.changed > 0);
    assert!(changed.count() > 60, "the cases show too little");
    // What a specification forbids is seen with the grade of the evidence.
    let tallies = || hunt.innocents.iter().flat_map(|i| &i.specifications);
    for verdict in [Verdict::Disputed, Verdict::RequiredByCts, Verdict::Fail] {
        let is_due = |t: &&InnocentTally| t.due() == Some(verdict) && !t.is_missed();
        assert!(tallies().any(|t| is_due(&t)), "{verdict}");
    }
}

#[test]
fn a_survivor_is_a_failure_and_the_report_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let hunt = ["mutants", "blend/never", "--out", out, "--case"];
    etalon(&[&hunt[..], &["depth/clear"]].concat())
        .code(1)
        .stdout(predicates::str::contains("blend/never: nothing noticed it"));
    let again = [&hunt[..], &["blend/operations", "--force"]].concat();
    etalon(&again).success();
    let text = std::fs::read(folder.path().join("mutants.json")).unwrap();
    let written: Hunt = serde_json::from_slice(&text).unwrap();
    assert_eq!(written.count(Catch::Caught), 1);
    let page = std::fs::read_to_string(folder.path().join("mutants.html")).unwrap();
    assert!(page.contains("id=\"blend/never\""));
    assert!(!page.contains("http://") && !page.contains("https://"));
}

#[test]
fn a_glob_without_a_match_selects_nothing() {
    etalon(&["mutants", "no/such/bug"]).code(4);
    etalon(&["mutants", "--case", "no/such/case"]).code(4);
    etalon(&["mutants", "--case", "selftest"]).code(4);
    etalon(&["mutants", "a["]).code(64);
}
