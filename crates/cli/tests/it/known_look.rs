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

fn drawn(folder: &Path, more: &[&str]) -> Assert {
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/blend/formats.json");
    let mine = folder.join("cases/mine");
    fs::create_dir_all(&mine).unwrap();
    fs::copy(&built_in, mine.join("over.json")).unwrap();
    let suite = folder.join("cases/blend");
    fs::create_dir_all(&suite).unwrap();
    fs::copy(built_in, suite.join("formats.json")).unwrap();
    etalon(&["run", CASE, "--adapter", "gl:softpipe", "--force"])
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
    let known = contains("1 record is known by its look").and(contains("like blend/"));
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
