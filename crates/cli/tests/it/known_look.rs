//! Failures of a user's own cases that findings recognize by their look.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use assert_cmd::assert::Assert;
use etalon_record::Run;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;

/// A case that softpipe fails by a finding, under another name: it blends floats below 2^-14 as 0.
const CASE: &str = "mine/over/equation=over/format=rg11b10ufloat";
/// The same case under the name that the finding has.
const NAMED: &str = "blend/formats/equation=over/format=rg11b10ufloat";

/// Copies a case file of the suite into a folder of cases, under its own path and others.
fn copy_case(folder: &Path, name: &str, others: &[&str]) {
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for to in others.iter().chain([&name]) {
        let to = folder.join("cases").join(to);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(built_in.join(name), to).unwrap();
    }
}

fn drawn(folder: &Path, more: &[&str]) -> Assert {
    copy_case(folder, "blend/formats.json", &["mine/over.json"]);
    run(folder, "gl:softpipe", &[&[CASE], more].concat())
}

/// Runs cases of a folder on an adapter.
fn run(folder: &Path, adapter: &str, more: &[&str]) -> Assert {
    etalon(&["run", "--adapter", adapter, "--force"])
        .arg("--cases")
        .arg(folder.join("cases"))
        .arg("--out")
        .arg(folder.join("out"))
        .args(["--profile", "full"])
        .args(more)
        .assert()
}

#[test]
fn a_failure_of_a_users_own_case_is_known_by_its_look() {
    let folder = tempfile::tempdir().unwrap();
    drawn(folder.path(), &[]).code(1);
    let known = contains("1 failure looks like a known bug").and(contains("like blend/"));
    drawn(folder.path(), &[NAMED, "--known-by-look"])
        .code(0)
        .stdout(known);
    let run = Run::read(&folder.path().join("out")).unwrap();
    let record = run.records.iter().find(|r| r.case == CASE).unwrap();
    assert!(!record.unexpected() && record.verdict.is_bad());
    assert!(record.look.as_ref().unwrap().starts_with("blend/"));
    // A finding that the run does not show excuses nothing.
    drawn(folder.path(), &["--known-by-look"])
        .code(1)
        .stderr(contains("no record of this run shows its finding"));
    let run = Run::read(&folder.path().join("out")).unwrap();
    assert!(run.records.iter().all(|record| record.look.is_none()));
    // Without findings no failure is known.
    fs::write(folder.path().join("none.json"), "[]").unwrap();
    let none = folder.path().join("none.json");
    let only = ["--known-by-look", "--expect", none.to_str().unwrap()];
    drawn(folder.path(), &[&only[..], &["--expect-only"]].concat()).code(1);
    let run = Run::read(&folder.path().join("out")).unwrap();
    assert!(run.records.iter().all(|record| record.look.is_none()));
}

/// Counts the samples of two per texel, without a scissor rectangle; virgl's host makes four of them.
const TWO_SAMPLES: &str = r#"{ "about": "Counted samples.", "spec": ["OpenGL 4.6: 17.3.5"], "scene": {
    "attachments": { "color": { "format": "rgba8unorm", "size": [4, 4], "clear": [0, 0, 0, 1], "samples": 2 } },
    "counters": { "passed": "samples-passed" },
    "passes": [{ "color": ["color"], "draws": [{ "mesh": { "kind": "full" }, "shader": "uniform_color",
        "params": { "color": [1, 0, 0, 1] }, "counters": ["passed"] }] }],
    "read": ["color"] } }"#;

#[test]
fn a_finding_does_not_excuse_a_scene_without_the_facts_that_it_needs() {
    let folder = tempfile::tempdir().unwrap();
    copy_case(folder.path(), "found/fuzzed.json", &[]);
    let mine = folder.path().join("cases/mine");
    fs::create_dir_all(&mine).unwrap();
    fs::write(mine.join("two-samples.json"), TWO_SAMPLES).unwrap();
    // The finding is about a scissor rectangle, which its case loses when it is reduced on virgl.
    let named = "found/fuzzed/bug=counted-beside-scissor";
    let cases = [named, "mine/two-samples", "--known-by-look"];
    run(folder.path(), "gl:virgl", &cases).code(1);
    let run = Run::read(&folder.path().join("out")).unwrap();
    let record = |case: &str| run.records.iter().find(|r| r.case == case).unwrap();
    assert!(record(named).verdict.is_bad() && !record(named).unexpected());
    assert!(record("mine/two-samples").unexpected());
}

#[test]
fn a_shader_that_does_not_compile_is_known_by_its_look() {
    let folder = tempfile::tempdir().unwrap();
    copy_case(
        folder.path(),
        "early-z/shader-mask.json",
        &["mine/mask.json"],
    );
    let point =
        "compare=less/early=*/format=depth32float-stencil8/mask=all/occlusion=any-*/stencil=off";
    let cases = ["early-z/shader-mask", "mine/mask"].map(|file| format!("{file}/{point}"));
    let known = contains("look like known bugs").and(contains("like early-z/"));
    let arguments = [&cases[0], &cases[1], "--known-by-look"];
    run(folder.path(), "wgpu:gl:llvmpipe", &arguments)
        .code(0)
        .stdout(known);
}
