//! What a run folder keeps of failures that the findings name: one record of each finding in full, and the others
//! with a reference to it.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::bundling::bundle;
use crate::etalon::etalon;
use etalon_record::{Record, Run, Verdict};
use predicates::str::contains;
use std::fs;
use std::path::Path;

/// Eight cases of one finding about softpipe.
const CASES: &str = "cull/points/*";
const ADAPTER: &str = "gl:softpipe";

/// Draws the cases, which are expected to fail, and returns their records.
fn run(out: &Path, more: &[&str]) -> Vec<Record> {
    let mut command = etalon(&[
        "run",
        CASES,
        "--profile",
        "full",
        "--adapter",
        ADAPTER,
        "--out",
    ]);
    command.arg(out).args(more).assert().success();
    let run = Run::read(out).unwrap();
    assert_eq!(run.records.len(), 8);
    for record in &run.records {
        assert_eq!(record.verdict, Verdict::Fail);
        assert!(record.expected.is_some() && record.texels.wrong > 1);
    }
    run.records
}

/// Returns the only record in full, and the others.
fn split(records: &[Record]) -> (&Record, Vec<&Record>) {
    let (examples, others): (Vec<_>, Vec<_>) = records.iter().partition(|r| r.example.is_none());
    assert_eq!(examples.len(), 1);
    (examples[0], others)
}

#[test]
fn one_record_of_a_finding_is_kept_in_full_and_the_others_name_it() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    let records = run(&out, &[]);
    let (example, others) = split(&records);
    assert!(example.story.is_some() && example.wrong.len() > 1);
    Run::read_frame(&out, example.frame.as_ref().unwrap()).unwrap();
    for other in others {
        assert_eq!(other.example.as_ref(), Some(&example.case));
        assert_eq!(other.wrong.len(), 1);
        assert!(other.story.is_none() && other.frame.is_none());
    }
    // The page has the pictures of one case, and links to it from the others.
    let read = |name: &str| fs::read_to_string(out.join("records").join(name)).unwrap();
    assert_eq!(read("0-pictures.js").matches("<ol class=").count(), 1);
    assert!(read("0.js").contains("Shown in full by"));
    let again = work.path().join("again");
    run(&again, &["--jobs", "2"]);
    etalon(&["diff"]).arg(&out).arg(&again).assert().success();
}

#[test]
fn all_frames_and_stories_are_kept_on_request() {
    let work = tempfile::tempdir().unwrap();
    let [all, new, none] = ["all", "new", "none"].map(|kept| {
        let out = work.path().join(kept);
        run(&out, &["--keep-frames", kept])
    });
    for record in &all {
        assert!(record.example.is_none() && record.story.is_some() && record.frame.is_some());
        assert!(record.wrong.len() as u64 >= record.texels.wrong.min(64));
    }
    for records in [new, none] {
        let (example, _) = split(&records);
        assert!(example.story.is_some());
        assert!(records.iter().all(|r| r.frame.is_none()));
    }
}

#[test]
fn a_resumed_run_goes_on_with_the_same_example() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    run(&out, &[]);
    let path = out.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    // The header and every record but the one in full.
    let left = text
        .lines()
        .filter(|line| line.contains("\"example\":") || line.contains("\"format\":"));
    let left: Vec<&str> = left.collect();
    assert_eq!(left.len(), 8);
    fs::write(&path, left.join("\n") + "\n").unwrap();
    let records = run(&out, &["--resume"]);
    let (example, others) = split(&records);
    assert!(example.story.is_some() && example.frame.is_some());
    assert!(
        others
            .iter()
            .all(|r| r.example.as_ref() == Some(&example.case))
    );
}

#[test]
fn shards_each_keep_an_example_and_merge() {
    let work = tempfile::tempdir().unwrap();
    let parts = ["1/2", "2/2"].map(|shard| {
        let out = work.path().join(shard.replace('/', "-"));
        let mut command = etalon(&[
            "run",
            CASES,
            "--adapter",
            ADAPTER,
            "--shard",
            shard,
            "--out",
        ]);
        command.arg(&out).assert().success();
        out
    });
    let out = work.path().join("merged");
    let mut command = etalon(&["merge", "--out"]);
    command.arg(&out).args(&parts).assert().success();
    let records = Run::read(&out).unwrap().records;
    for record in &records {
        let case = record.example.as_ref().unwrap_or(&record.case);
        let example = records.iter().find(|r| r.case == *case).unwrap();
        Run::read_frame(&out, example.frame.as_ref().unwrap()).unwrap();
    }
}

#[test]
fn a_failure_without_its_story_is_explained_and_bundled() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    let records = run(&out, &[]);
    let (_, others) = split(&records);
    let (case, wrong) = (&others[0].case, &others[0].wrong[0]);
    let texel = format!("{},{}", wrong.x, wrong.y);
    etalon(&["explain", case, "--texel", &texel, "--adapter", ADAPTER])
        .assert()
        .code(1)
        .stdout(contains("the driver wrote"));
    let (code, summary, error) = bundle(case, ADAPTER, &work.path().join("bundle"), &[]);
    assert_eq!(code, 0, "{summary} {error}");
    etalon(&["report"]).arg(&out).assert().success();
    let db = work.path().join("history.db");
    let mut command = etalon(&["history", "add"]);
    command.arg(&out).arg("--db").arg(&db).assert().success();
    etalon(&["history", "show", case, "--db"])
        .arg(&db)
        .assert()
        .success()
        .stdout(contains("fail"));
}
