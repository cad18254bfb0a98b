//! Sharded runs: selection of shards, and merging.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use assert_cmd::Command;
use assert_cmd::assert::Assert;
use etalon_record::{Record, Run, Verdict};
use etalon_report::message;
use predicates::str::contains;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

const RUN: [&str; 5] = ["run", "cull/*", "selftest/*", "--adapter", "cpu"];

fn shard(folder: &Path, index: u32, count: u32) -> PathBuf {
    let out = folder.join(format!("shard-{index}"));
    let mut command = etalon(&RUN);
    command.args(["--shard", &format!("{index}/{count}"), "--out"]);
    command.arg(&out).assert().code(0);
    out
}

fn merge(parts: &[PathBuf], out: &Path) -> Command {
    let mut command = etalon(&["merge"]);
    command.args(parts).arg("--out").arg(out);
    command
}

/// Returns a message without the paths below a folder.
fn said(assert: &Assert, folder: &Path) -> String {
    let text = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    text.replace(&format!("{}/", folder.display()), "")
}

fn keys(records: &[Record]) -> BTreeSet<(String, String, Verdict)> {
    let key = |r: &Record| (r.case.clone(), r.adapter.clone(), r.verdict);
    records.iter().map(key).collect()
}

#[test]
fn shards_merge_into_the_undivided_run() {
    let work = tempfile::tempdir().unwrap();
    let undivided_folder = work.path().join("whole");
    etalon(&RUN)
        .arg("--out")
        .arg(&undivided_folder)
        .assert()
        .code(0);
    let undivided = Run::read(&undivided_folder).unwrap();
    let parts: Vec<PathBuf> = (1..=4).map(|i| shard(work.path(), i, 4)).collect();
    let mut sizes = 0;
    for part in &parts {
        let run = Run::read(part).unwrap();
        assert_eq!(run.missing(), 0);
        assert_eq!(
            run.header.settings.selection,
            undivided.header.settings.selection
        );
        sizes += run.records.len();
    }
    assert_eq!(sizes, undivided.records.len());
    let out = work.path().join("merged");
    merge(&parts, &out).assert().code(0);
    let merged = Run::read(&out).unwrap();
    assert_eq!(merged.missing(), 0);
    assert_eq!(merged.header.settings.shard, None);
    assert_eq!(keys(&merged.records), keys(&undivided.records));
    assert_eq!(merged.records.len(), undivided.records.len());
    // In the order of the list, with every frame.
    let order: Vec<&String> = merged.records.iter().map(|r| &r.case).collect();
    let listed = fs::read_to_string(out.join("cases.txt")).unwrap();
    assert!(order.into_iter().eq(listed.lines()));
    let frames = merged.records.iter().filter_map(|r| r.frame.as_ref());
    assert!(frames.clone().count() > 0);
    for frame in frames {
        Run::read_frame(&out, frame).unwrap();
    }
    let again = said(&merge(&parts, &out).assert().code(64), work.path());
    let count = undivided.records.len().to_string();
    insta::assert_snapshot!("merge-again", again.replace(&count, "[count]"));
    merge(&parts, &out).arg("--force").assert().code(0);
    // A merged run can be merged again.
    let again = work.path().join("again");
    merge(&[out], &again).assert().code(0);
}

#[test]
fn a_merge_with_holes_names_them() {
    let work = tempfile::tempdir().unwrap();
    let one = shard(work.path(), 1, 3);
    let three = shard(work.path(), 3, 3);
    // A part that was cut off.
    let path = three.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    let lost: Vec<&str> = text.lines().skip(1).take(2).collect();
    let lost: Vec<Record> = lost
        .iter()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let kept: Vec<&str> = text.lines().take(1).chain(text.lines().skip(3)).collect();
    fs::write(&path, kept.join("\n") + "\n{\"case\":\"cu").unwrap();
    let two = work.path().join("shard-2");
    fs::create_dir(&two).unwrap();
    let out = work.path().join("merged");
    let assert = merge(&[one, two, three], &out)
        .args(["--format", "json"])
        .assert()
        .code(3);
    let printed: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let run = Run::read(&out).unwrap();
    let missing = printed["missing"].as_array().unwrap();
    assert_eq!(missing.len() as u64, run.missing());
    for record in &lost {
        assert!(missing.iter().any(|m| m["case"] == record.case.as_str()));
    }
    let listed = fs::read_to_string(out.join("missing.txt")).unwrap();
    assert_eq!(listed.lines().count(), missing.len());
    let stderr = said(&assert, work.path());
    let is_case = |line: &&str| line.starts_with("missing: cpu cull/");
    let (cases, other): (Vec<_>, Vec<_>) = stderr.lines().partition(is_case);
    let more = format!("and {} more", missing.len() - cases.len());
    let other = other.join("\n").replace(&more, "and [count] more");
    let count = format!("{} records", missing.len());
    insta::assert_snapshot!("merge-holes", other.replace(&count, "[count] records"));
}

#[test]
fn parts_of_other_runs_are_refused() {
    let work = tempfile::tempdir().unwrap();
    let one = shard(work.path(), 1, 2);
    let other = work.path().join("other");
    etalon(&[
        "run",
        "cull/*",
        "--adapter",
        "cpu",
        "--shard",
        "2/2",
        "--out",
    ])
    .arg(&other)
    .assert()
    .code(0);
    let out = work.path().join("merged");
    let assert = merge(&[one.clone(), other], &out).assert().code(64);
    let mut messages = said(&assert, work.path());
    // The message has the globs that differ, not their digest.
    assert!(
        messages.contains("only shard-1 has selftest/*"),
        "{messages}"
    );
    let two = shard(work.path(), 2, 2);
    let path = two.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    // Records are in the order in which cases ended.
    let (_, first) = text.split_once("\"case\":\"cull/").unwrap();
    let (first, _) = first.split_once('"').unwrap();
    for (from, to) in [
        ("\"driver\":\"etalon\"", "\"driver\":\"étalon\""),
        ("\"case\":\"cull/", "\"case\":\"dull/"),
        ("\"sub_pixel_bits\":8", "\"sub_pixel_bits\":4"),
    ] {
        assert!(text.contains(from));
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        let assert = merge(&[one.clone(), two.clone()], &out).assert().code(64);
        messages += &said(&assert, work.path()).replace(first, "[case]");
    }
    let assert = merge(std::slice::from_ref(&one), &one).assert().code(64);
    messages += &said(&assert, work.path());
    let assert = merge(&[work.path().join("none")], &out).assert().code(64);
    messages += &said(&assert, work.path());
    let messages = messages.replace(env!("CARGO_PKG_VERSION"), "[version]");
    insta::assert_snapshot!("merge-refused", messages);
    assert!(!out.join("run.jsonl").exists());
}

#[test]
fn a_case_whose_shards_disagree_is_flaky() {
    let work = tempfile::tempdir().unwrap();
    let parts: Vec<PathBuf> = (1..=2).map(|i| shard(work.path(), i, 2)).collect();
    // A shard that was requeued and ran twice.
    let twice = work.path().join("twice");
    fs::create_dir(&twice).unwrap();
    for name in ["run.jsonl", "cases.txt"] {
        fs::copy(parts[1].join(name), twice.join(name)).unwrap();
    }
    let path = twice.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(
        &path,
        text.replacen("\"verdict\":\"pass\"", "\"verdict\":\"timeout\"", 1),
    )
    .unwrap();
    let out = work.path().join("merged");
    let folders = [parts[0].clone(), parts[1].clone(), twice];
    let assert = merge(&folders, &out).assert().code(1);
    let stderr = said(&assert, work.path());
    let count = Run::read(&parts[1]).unwrap().records.len() - 1;
    let stderr = stderr.replacen(&count.to_string(), "[count]", 1);
    let run = Run::read(&out).unwrap();
    assert_eq!(run.missing(), 0);
    let flaky: Vec<&Record> = run
        .records
        .iter()
        .filter(|r| r.verdict == Verdict::Flaky)
        .collect();
    assert_eq!(flaky.len(), 1);
    // The message does not depend on which case passes first.
    insta::assert_snapshot!("merge-flaky", stderr.replacen(&flaky[0].case, "[case]", 1));
    assert!(message(flaky[0]).contains("pass in one part, timeout in another"));
}

#[test]
fn the_variables_of_four_systems_choose_the_same_shard() {
    let work = tempfile::tempdir().unwrap();
    let expected = Run::read(&shard(work.path(), 2, 3)).unwrap();
    let status = work.path().join("bazel-status");
    let bazel = status.to_str().unwrap();
    for variables in [
        &[("CI_NODE_INDEX", "2"), ("CI_NODE_TOTAL", "3")][..],
        &[
            ("TEST_SHARD_INDEX", "1"),
            ("TEST_TOTAL_SHARDS", "3"),
            ("TEST_SHARD_STATUS_FILE", bazel),
        ],
        &[
            ("SLURM_ARRAY_TASK_ID", "8"),
            ("SLURM_ARRAY_TASK_MIN", "7"),
            ("SLURM_ARRAY_TASK_COUNT", "3"),
        ],
        &[("JOB_COMPLETION_INDEX", "1"), ("JOB_COMPLETIONS", "3")],
    ] {
        let out = tempfile::tempdir().unwrap();
        let mut command = etalon(&RUN);
        command
            .envs(variables.iter().copied())
            .arg("--out")
            .arg(out.path());
        command.assert().code(0).stderr(contains("shard 2/3"));
        let run = Run::read(out.path()).unwrap();
        assert_eq!(keys(&run.records), keys(&expected.records), "{variables:?}");
        // A flag overrides the variables.
        let mut unsharded = etalon(&["run", "cull/lines", "--adapter", "cpu", "--shard", "1/1"]);
        unsharded
            .envs(variables.iter().copied())
            .arg("--out")
            .arg(out.path());
        unsharded.arg("--force").assert().code(0);
        let listed = etalon(&["list", "cull/lines"]).assert();
        let lines = String::from_utf8_lossy(&listed.get_output().stdout)
            .lines()
            .count();
        assert_eq!(Run::read(out.path()).unwrap().records.len(), lines);
    }
    assert!(status.exists());
    let out = work.path().join("none");
    let assert = etalon(&["run", "cull/lines", "--adapter", "cpu", "--out"])
        .arg(&out)
        .env("JOB_COMPLETION_INDEX", "1")
        .env_remove("JOB_COMPLETIONS")
        .assert()
        .code(64);
    insta::assert_snapshot!("shard-variable-unset", said(&assert, work.path()));
    assert!(!out.exists());
    // A part without cases is not a failure: other parts have them.
    let empty = work.path().join("empty");
    etalon(&[
        "run",
        "depth/clear",
        "--adapter",
        "cpu",
        "--shard",
        "77/1000",
        "--out",
    ])
    .arg(&empty)
    .assert()
    .code(0);
    assert_eq!(Run::read(&empty).unwrap().records.len(), 0);
}
