//! Benches. No time is asserted.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Bench, FolderKind, ShaderCache, Verdict};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder of cases: one picture that comes out right, and one of which the judge believes otherwise.
fn cases() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let scene = json!({
        "attachments": { "color": { "format": "rgba8unorm", "size": [8, 8] } },
        "passes": [{ "color": ["color"], "draws": [{
            "mesh": { "kind": "cover" }, "shader": "uniform_color",
            "params": { "color": [1, 0, 0, 1] }
        }] }],
        "read": ["color"]
    });
    let mut file = json!({ "about": "A colour.", "spec": ["none"], "scene": scene });
    fs::create_dir(folder.path().join("perf")).unwrap();
    fs::write(folder.path().join("perf/right.json"), file.to_string()).unwrap();
    let pointer = "/passes/0/draws/0/params/color";
    file["judged_as"] = json!({ pointer: [0, 1, 0, 1] });
    fs::write(folder.path().join("perf/wrong.json"), file.to_string()).unwrap();
    folder
}

fn bench(cases: &Path, out: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = etalon(&["bench", "--seconds", "0.001", "--rounds", "2"]);
    command.arg("--cases").arg(cases).arg("--out").arg(out);
    command.args(arguments).assert()
}

#[test]
fn what_is_right_is_timed_and_what_is_wrong_is_not() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    // A selftest's Fail is due, so nothing speaks against the bench.
    bench(cases.path(), out.path(), &["--adapter", "cpu"])
        .code(0)
        .stdout(contains("perf/right").and(contains("index.html")))
        .stderr(is_empty());
    assert_eq!(FolderKind::of(out.path()), Some(FolderKind::Bench));
    let bench = Bench::read(out.path()).unwrap();
    assert_eq!(bench.header.cases, 2);
    assert_eq!(bench.header.rounds, 2);
    assert_eq!(bench.header.profile, "quick");
    assert_eq!(bench.missing(), 0);
    let right = bench.record("perf/right", "cpu").unwrap();
    assert_eq!(right.picture.verdict, Verdict::Pass);
    assert_eq!(right.rounds.len(), 2);
    let wrong = bench.record("perf/wrong", "cpu").unwrap();
    assert_eq!(wrong.picture.verdict, Verdict::Fail);
    assert!(wrong.rounds.is_empty());
    for name in ["index.html", "bencher.json", "benchmark-action.json"] {
        assert!(out.path().join(name).is_file(), "{name}");
    }
}

#[test]
fn programs_are_told_in_json() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    let arguments = ["perf/right", "--adapter", "cpu", "--format", "json"];
    let assert = bench(cases.path(), out.path(), &arguments).code(0);
    let output: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    assert_eq!(output["pictures"], 1);
    assert_eq!(output["timed"], 1);
    assert_eq!(output["unexpected"], 0);
    assert_eq!(output["adapters"], json!(["cpu"]));
    assert_eq!(output["folder"], json!(out.path()));
}

#[test]
fn a_slower_rasterizer_answers_as_cpu_and_is_not_listed() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    let slower = ["perf/right", "--adapter", "cpu:slower=50%", "--cold"];
    bench(cases.path(), out.path(), &slower).code(0);
    let bench_of = Bench::read(out.path()).unwrap();
    let adapter = &bench_of.header.adapters[0];
    assert_eq!(adapter.name, "cpu");
    assert!(
        adapter.driver_version.ends_with("slower by 50 %"),
        "{adapter:?}"
    );
    assert_eq!(bench_of.header.shader_cache, ShaderCache::Cold);
    let both = ["--adapter", "cpu", "--adapter", "cpu:slower=5%"];
    bench(cases.path(), out.path(), &both)
        .code(64)
        .stderr(contains("report the name cpu"));
    etalon(&["adapters"])
        .assert()
        .stdout(contains("slower").not());
}

#[test]
fn wrong_usage_is_64_and_nothing_chosen_is_4() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["--rounds", "0"][..], "rounds"),
        (&["--rounds", "many"], "rounds"),
        (&["--seconds", "0"], "expected a number of seconds"),
        (&["--seconds", "nan"], "expected a number of seconds"),
        (&["--adapter", "nothing"], "there is no adapter `nothing`"),
        (
            &["--adapter", "cpu:slower=x%"],
            "there is no adapter `cpu:slower=x%`",
        ),
        (&["perf/["], "is not a glob"),
    ] {
        etalon(&["bench", "--out"])
            .arg(out.path())
            .arg("--cases")
            .arg(cases.path())
            .args(arguments)
            .assert()
            .code(64)
            .stderr(contains(words));
    }
    bench(cases.path(), out.path(), &["nothing/*"]).code(4);
    let run = tempfile::tempdir().unwrap();
    fs::write(run.path().join("run.jsonl"), "{}").unwrap();
    bench(cases.path(), run.path(), &["--adapter", "cpu"]).code(64);
    assert_eq!(
        fs::read_to_string(run.path().join("run.jsonl")).unwrap(),
        "{}"
    );
}
