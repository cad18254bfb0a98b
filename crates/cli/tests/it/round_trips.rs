//! A driver whose read-back of a format is wrong: no case that depends on it is green, and all others are
//! drawn.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Record, Run, Verdict};
use etalon_report::message;
use std::fs;
use std::path::{Path, PathBuf};

/// An adapter that reads codes of rgb10a2unorm one too high.
const ADAPTER: &str = "cpu:fault=misread";
const TRIP: &str = "capabilities/round-trip/format=rgb10a2unorm";
/// Cases with that format and with others, without the round trips.
const DEPENDENTS: [&str; 5] = [
    "blend/factors-formats",
    "blend/formats-clear",
    "blend/formats-low-bits",
    "blend/write-mask-formats",
    "texture/formats",
];

fn run(out: &Path, globs: &[&str], more: &[&str], code: i32) -> Run {
    etalon(&["run"])
        .args(globs)
        .args(["--profile", "full", "--adapter", ADAPTER, "--out"])
        .arg(out)
        .args(more)
        .assert()
        .code(code);
    let run = Run::read(out).unwrap();
    assert_eq!(run.missing(), 0);
    run
}

fn leans(record: &Record) -> bool {
    record.case.contains("formats-low-bits") || record.case.contains("format=rgb10a2unorm")
}

/// Returns the records in order, without what differs between runs.
fn plain(run: &Run) -> Vec<String> {
    let records = run.records.iter().cloned();
    let mut texts: Vec<String> = records
        .map(|mut record| {
            record.seconds = Default::default();
            serde_json::to_string(&record).unwrap()
        })
        .collect();
    texts.sort_unstable();
    texts
}

/// Globs of the dependents and of all round trips.
fn with_trips() -> Vec<&'static str> {
    let mut globs = DEPENDENTS.to_vec();
    globs.push("capabilities/round-trip");
    globs
}

#[test]
fn cases_behind_a_failed_round_trip_are_blocked_and_the_rest_are_drawn() {
    let work = tempfile::tempdir().unwrap();
    let alone = run(&work.path().join("alone"), &DEPENDENTS, &[], 1);
    let full = run(&work.path().join("whole"), &with_trips(), &[], 1);
    let blocked = |run: &Run| run.records.iter().filter(|r| leans(r)).count();
    assert!(blocked(&alone) > 2 && alone.records.len() > blocked(&alone) + 20);
    for record in alone.records.iter().chain(&full.records) {
        if record.case == TRIP {
            assert_eq!(record.verdict, Verdict::Fail, "{record:?}");
            // A recheck that confirms the verdict leaves no trace in the record.
            assert!(record.repeats.is_empty(), "{record:?}");
        } else if leans(record) {
            assert_eq!(record.verdict, Verdict::Blocked, "{record:?}");
            assert_eq!(record.blocked_by, [TRIP]);
            let begin = format!("not drawn: {TRIP} is fail: texel 0,0 of color: channel 0 holds 1");
            assert!(message(record).starts_with(&begin), "{record:?}");
            assert!(record.unexpected());
            assert_eq!(record.texels.total, 0, "it was not drawn");
        } else {
            assert!(!record.verdict.is_bad(), "{record:?}");
            assert!(record.texels.total > 0, "{record:?}");
        }
    }
    // A selected round trip has one record, an unselected one has none.
    let trips = |run: &Run| {
        run.records
            .iter()
            .filter(|r| r.parts().area() == "capabilities")
            .count()
    };
    assert_eq!((trips(&alone), trips(&full)), (0, 29));
}

#[test]
fn parts_of_a_run_hold_the_same_records_as_the_whole() {
    let work = tempfile::tempdir().unwrap();
    let undivided = run(&work.path().join("whole"), &with_trips(), &[], 1);
    let trip = |run: &Run| run.records.iter().any(|r| r.case == TRIP);
    let mut holders = 0;
    let parts: Vec<PathBuf> = (1..=3)
        .map(|index| {
            let out = work.path().join(index.to_string());
            let shard = format!("{index}/3");
            let part = run(&out, &with_trips(), &["--shard", &shard, "--jobs", "3"], 1);
            holders += usize::from(trip(&part));
            let blocked = part
                .records
                .iter()
                .filter(|r| r.verdict == Verdict::Blocked);
            assert!(blocked.count() > 0, "shard {index} knows of the failure");
            out
        })
        .collect();
    assert_eq!(holders, 1);
    let out = work.path().join("merged");
    let mut merge = etalon(&["merge"]);
    merge.args(&parts).arg("--out").arg(&out).assert().code(1);
    assert_eq!(plain(&Run::read(&out).unwrap()), plain(&undivided));
}

#[test]
fn a_stopped_run_resumes_with_the_same_records() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    let expected = plain(&run(&out, &with_trips(), &[], 1));
    let text = fs::read_to_string(out.join("run.jsonl")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    // Before, between and after the round trips, and with nothing left to draw.
    for kept in [0, 1, 6, 14, 15, 40, lines.len() - 1] {
        fs::write(out.join("run.jsonl"), lines[..=kept].join("\n") + "\n").unwrap();
        let resumed = run(&out, &with_trips(), &["--resume"], 1);
        assert_eq!(plain(&resumed), expected, "after {kept} records");
    }
}

#[test]
fn cases_that_a_known_failure_blocks_are_expected_too() {
    let work = tempfile::tempdir().unwrap();
    let file = work.path().join("expect.json");
    let expect = |verdict: &str| {
        let text = format!(
            r#"{{ "entries": [ {{ "adapter": "{ADAPTER}", "driver": "*", "case": "{TRIP}",
                "verdict": "{verdict}", "reason": "bug 12", "evidence": "a log" }} ] }}"#
        );
        fs::write(&file, text).unwrap();
        ["--expect", file.to_str().unwrap()].map(str::to_owned)
    };
    let known = expect("fail");
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    for (name, globs) in [("alone", DEPENDENTS.to_vec()), ("whole", with_trips())] {
        let run = run(&work.path().join(name), &globs, &known, 0);
        for record in run.records.iter().filter(|r| leans(r)) {
            let reason = &record.expected.as_ref().unwrap().reason;
            if record.case == TRIP {
                assert_eq!(record.verdict, Verdict::Fail);
                assert_eq!(reason, "bug 12");
            } else {
                assert_eq!(record.verdict, Verdict::Blocked);
                assert_eq!(*reason, format!("{TRIP}: bug 12"));
            }
        }
    }
    // A skipped round trip was not checked: its cases are drawn, and say so.
    let skipped = expect("skipped");
    let skipped: Vec<&str> = skipped.iter().map(String::as_str).collect();
    let run = run(&work.path().join("skipped"), &with_trips(), &skipped, 1);
    for record in run.records.iter().filter(|r| leans(r)) {
        if record.case == TRIP {
            assert_eq!(record.verdict, Verdict::Skipped);
        } else {
            assert!(record.texels.total > 0, "{record:?}");
            let note = "the round trip of rgb10a2unorm was skipped and not checked (bug 12)";
            assert!(message(record).contains(note), "{record:?}");
        }
    }
}
