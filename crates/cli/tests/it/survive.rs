//! Robustness of runs: failing workers, killed runs, folders in use.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use crate::sample;
use etalon_diagnose::Symptom;
use etalon_record::{LossKind, Reason, Record, Run, Verdict};
use etalon_report::message;
use predicates::prelude::*;
use predicates::str::contains;
use rustix::process::{Pid, Signal, kill_process};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Runs cases on one adapter with a planted fault. Some must have this verdict, all others pass.
fn with_fault(cases: &str, fault: &str, verdict: Verdict, more: &[&str]) -> Vec<Record> {
    let out = folder();
    let adapter = format!("cpu:fault={fault}");
    etalon(&["run", cases, "--adapter", &adapter, "--out"])
        .arg(out.path())
        .args(more)
        .assert()
        .code(1);
    let run = Run::read(out.path()).unwrap();
    assert_eq!(run.missing(), 0);
    let (bad, fine): (Vec<Record>, Vec<Record>) =
        run.records.into_iter().partition(|r| r.verdict.is_bad());
    for record in &fine {
        assert_eq!(record.verdict, Verdict::Pass, "{fault}: {record:?}");
    }
    assert!(fine.len() > 20 && !bad.is_empty(), "{fault}");
    for record in &bad {
        assert_eq!(record.verdict, verdict, "{fault}: {record:?}");
        assert!(record.unexpected());
    }
    bad
}

/// The same for processes that are lost, with the way in which they ended.
fn lost(fault: &str, verdict: Verdict, kind: LossKind, more: &[&str]) -> Vec<Record> {
    let records = with_fault("cull/*", fault, verdict, more);
    assert_lost(&records, kind);
    records
}

fn assert_lost(records: &[Record], kind: LossKind) {
    for record in records {
        let end = record.process.as_ref().unwrap();
        assert_eq!(end.kind, kind, "{record:?}");
        assert!(end.seconds > 0.0 && end.seconds < 60.0, "{record:?}");
    }
}

#[test]
fn a_crash_records_its_signal_and_its_last_words() {
    for record in lost("abort", Verdict::Crash, LossKind::Died, &[]) {
        let end = record.process.as_ref().unwrap();
        assert_eq!((end.signal, end.exit), (Some(6), None));
        assert_eq!(end.stderr, "about to abort, as planted");
        assert!(
            record.repeats.is_empty(),
            "a recheck that agrees is not recorded"
        );
    }
    for record in lost("segv", Verdict::Crash, LossKind::Died, &[]) {
        assert_eq!(record.process.unwrap().signal, Some(11));
    }
    for record in lost("exit", Verdict::Crash, LossKind::Died, &[]) {
        let end = record.process.as_ref().unwrap();
        assert_eq!((end.signal, end.exit), (None, Some(7)));
    }
    for record in lost("chatter", Verdict::Crash, LossKind::Died, &[]) {
        let end = record.process.as_ref().unwrap();
        assert!(end.stderr.len() <= 4096 && end.stderr.contains("line 99999"));
    }
}

#[test]
fn a_driver_that_leaves_a_child_with_its_pipe_has_crashed() {
    let begun = Instant::now();
    for record in lost(
        "child",
        Verdict::Crash,
        LossKind::Died,
        &["--timeout", "20"],
    ) {
        let end = record.process.as_ref().unwrap();
        assert_eq!((end.signal, end.exit), (Some(6), None));
        assert!(end.seconds < 10.0, "the child is not waited for");
        assert_eq!(end.stderr, "planted");
    }
    assert!(begun.elapsed() < Duration::from_secs(60));
}

#[test]
fn a_worker_that_dies_after_its_last_case_is_reported_and_counts() {
    let out = folder();
    let run = ["run", "cull/lines", "--adapter", "cpu:fault=close", "--out"];
    let told =
        contains("cpu:fault=close  worker/end: after its last case: the worker died of signal 11");
    etalon(&run)
        .arg(out.path())
        .args(["--jobs", "1"])
        .assert()
        .code(1)
        .stdout(told.clone());
    let read = Run::read(out.path()).unwrap();
    assert_eq!(read.missing(), 0);
    assert!(read.records.iter().all(|r| r.verdict == Verdict::Pass));
    let [end] = read.beside.as_slice() else {
        panic!("{:?}", read.beside);
    };
    assert_eq!(end.process.as_ref().unwrap().signal, Some(11));
    // It stays in the run.
    let merged = folder();
    etalon(&["merge"])
        .arg(out.path())
        .arg("--out")
        .arg(merged.path().join("merged"))
        .assert()
        .code(1)
        .stdout(told);
    etalon(&run)
        .arg(out.path())
        .arg("--resume")
        .assert()
        .code(1)
        .stdout(contains("after its last case"));
    // A run in its place does not have it.
    etalon(&["run", "cull/lines", "--adapter", "cpu", "--force", "--out"])
        .arg(out.path())
        .assert()
        .code(0);
    assert_eq!(Run::read(out.path()).unwrap().beside, []);
}

#[test]
fn an_expectation_of_a_crash_excuses_how_workers_end() {
    let out = folder();
    let list = out.path().join("known.json");
    let known = r#"[{ "adapter": "cpu:fault=close", "driver": "*", "case": "worker/end",
        "verdict": "crash", "reason": "it ends badly", "evidence": "planted" }]"#;
    fs::write(&list, known).unwrap();
    etalon(&[
        "run",
        "cull/lines",
        "--adapter",
        "cpu:fault=close",
        "--strict-expectations",
    ])
    .arg("--expect")
    .arg(&list)
    .arg("--out")
    .arg(out.path().join("run"))
    .assert()
    .code(0);
    let run = Run::read(&out.path().join("run")).unwrap();
    let reasons = run
        .beside
        .iter()
        .map(|r| &r.expected.as_ref().unwrap().reason);
    assert_eq!(reasons.collect::<Vec<_>>(), ["it ends badly"]);
}

#[test]
fn a_bench_counts_workers_that_fail_after_their_last_case() {
    let out = folder();
    let words = "bench cull/lines --adapter cpu:fault=close --rounds 1 --seconds 0.001 --out";
    let words: Vec<&str> = words.split(' ').collect();
    etalon(&words)
        .arg(out.path())
        .assert()
        .code(1)
        .stderr(contains(
            "crash cpu:fault=close worker/end: after its last case: the worker died",
        ));
    assert_eq!(etalon_record::beside::read(out.path()).unwrap().len(), 1);
}

#[test]
fn denied_requirements_are_reported_whatever_cases_run() {
    let out = folder();
    let run = |expect: &[&str], code: i32| {
        let words = [
            "run",
            "cull/points",
            "--adapter",
            "gl:softpipe",
            "--force",
            "--out",
        ];
        etalon(&words)
            .arg(out.path())
            .args(expect)
            .assert()
            .code(code)
    };
    const DENIED: &str = "capabilities/required/samples/format=rgba8unorm";
    run(&[], 0);
    let known = Run::read(out.path()).unwrap();
    assert_eq!(known.unexpected_beside(), 0);
    assert!(known.beside.iter().any(|r| r.case == DENIED));
    let page = fs::read_to_string(out.path().join("index.html")).unwrap();
    assert!(
        !page.contains("Beside the selected cases") && page.contains("softpipe offers one sample")
    );
    run(&["--expect-only"], 1).stdout(contains(DENIED));
    let page = fs::read_to_string(out.path().join("index.html")).unwrap();
    assert!(page.contains("Beside the selected cases") && page.contains(DENIED));
    let junit = fs::read_to_string(out.path().join("junit.xml")).unwrap();
    assert!(junit.contains(DENIED));
    // A selected case says it itself.
    etalon(&["run", "capabilities/required/*", "--profile", "full"])
        .args(["--adapter", "gl:softpipe", "--force", "--out"])
        .arg(out.path())
        .assert()
        .code(0);
    assert_eq!(Run::read(out.path()).unwrap().beside, []);
}

#[test]
fn a_hang_costs_its_time_and_nothing_else() {
    for fault in ["hang", "spin"] {
        // Few cases, each with time enough for those that do not hang, also on a busy machine.
        let more = ["--timeout", "3"];
        let records = with_fault("cull/clipping/*", fault, Verdict::Timeout, &more);
        assert_lost(&records, LossKind::Timeout);
        for record in records {
            let end = record.process.unwrap();
            assert_eq!(end.limit, Some(3.0));
            assert!(end.seconds >= 3.0);
        }
    }
}

#[test]
fn a_worker_that_allocates_without_end_is_stopped() {
    let more = ["--memory", "192"];
    for record in lost("memory", Verdict::ResourceError, LossKind::Memory, &more) {
        let end = record.process.unwrap();
        assert_eq!(end.limit, Some(192.0));
        assert!(end.held > Some(192), "{end:?}");
    }
}

#[test]
fn garbage_in_place_of_a_frame_is_a_crash() {
    for fault in ["garbage", "half"] {
        lost(fault, Verdict::Crash, LossKind::Garbage, &[]);
    }
}

#[test]
fn an_error_that_a_backend_reports_is_the_verdict_of_its_case() {
    with_fault("cull/*", "lost", Verdict::DeviceLost, &[]);
    with_fault("cull/*", "refused", Verdict::ResourceError, &[]);
    let panics = with_fault("cull/*", "panic", Verdict::InternalError, &[]);
    assert!(message(&panics[0]).contains("a planted panic"));
}

#[test]
fn validation_messages_fail_the_case_and_not_the_driver() {
    for record in with_fault("cull/*", "validation", Verdict::InternalError, &[]) {
        assert_eq!(
            record.validation,
            ["VUID-planted: a call that breaks the rules"]
        );
        let planted = Reason::Validation {
            messages: 1,
            otherwise: Verdict::Pass,
            first: record.validation[0].clone(),
        };
        assert_eq!(record.reasons, [planted]);
    }
}

#[test]
fn a_driver_that_does_not_start_has_a_record_for_every_case() {
    let out = folder();
    etalon(&["run", "cull/lines", "--adapter", "cpu:fault=start", "--out"])
        .arg(out.path())
        .assert()
        .code(1)
        .stderr(contains("exit status 9"));
    let run = Run::read(out.path()).unwrap();
    assert!(run.missing() == 0 && !run.records.is_empty());
    for record in &run.records {
        assert_eq!(record.verdict, Verdict::Crash, "{record:?}");
        let end = record.process.as_ref().unwrap();
        assert_eq!(end.kind, LossKind::NotStarted);
        assert_eq!(
            end.error,
            "the driver did not start: the worker ended with exit status 9; \
             stderr ends with: the planted driver does not start"
        );
    }
}

#[test]
fn a_verdict_that_changes_is_flaky_and_never_a_pass() {
    let out = folder();
    // Each process is wrong at random. Of many repetitions some differ from the first; the odds against this
    // are 1 to 10^11.
    etalon(&[
        "run",
        "cull/*",
        "--adapter",
        "cpu:fault=flaky",
        "--repeat",
        "5",
        "--out",
    ])
    .arg(out.path())
    .assert()
    .code(1);
    let run = Run::read(out.path()).unwrap();
    assert_eq!(run.missing(), 0);
    let mut flaky = 0;
    for record in &run.records {
        if record.verdict == Verdict::NotSupported {
            continue;
        }
        assert_eq!(record.repeats.len(), 4);
        let all_pass = record.repeats.iter().all(|v| *v == Verdict::Pass);
        match record.verdict {
            Verdict::Flaky => {
                flaky += 1;
                let [Reason::Flaky { verdicts, .. }] = &record.reasons[..] else {
                    panic!("{record:?}");
                };
                assert_eq!(verdicts[1..], record.repeats);
                assert!(record.frame.is_some(), "the wrong frame is kept");
            }
            Verdict::Pass => assert!(all_pass, "{record:?}"),
            _ => assert!(record.repeats.iter().all(|v| *v == record.verdict)),
        }
    }
    assert!(flaky > 0);
}

#[test]
fn a_case_that_fails_only_after_another_names_it() {
    let mut culprits: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for seed in ["1", "2"] {
        let out = folder();
        etalon(&[
            "run",
            "cull/triangle-*",
            "cull/stencil-faces*",
            "cull/needles/*",
            "--profile",
            "full",
            "--adapter",
            "cpu:fault=after",
            "--jobs",
            "1",
        ])
        .args(["--shuffle", seed, "--out"])
        .arg(out.path())
        .assert()
        .code(1);
        let run = Run::read(out.path()).unwrap();
        assert_eq!(
            run.header.settings.shuffle.map(|s| s.to_string()),
            Some(seed.to_owned())
        );
        for record in run.records.iter().filter(|r| r.verdict.is_bad()) {
            // A run searches for some causes only; other cases are flaky for all that it knows.
            if record.verdict == Verdict::Flaky {
                assert!(record.after.is_empty(), "{record:?}");
                continue;
            }
            assert_eq!(record.verdict, Verdict::Fail, "{record:?}");
            assert_eq!(record.after.len(), 1, "{record:?}");
            assert_eq!(record.repeats, [Verdict::Pass]);
            assert_eq!(record.reasons[0], Reason::AfterOthers(1), "{record:?}");
            let sentence = record
                .story
                .as_ref()
                .and_then(etalon_report::sentence)
                .unwrap();
            let chain = format!("; only when drawn after {}", record.after[0]);
            assert!(sentence.ends_with(&chain), "{sentence}");
            let by = culprits.entry(record.after[0].clone()).or_default();
            by.push(record.case.clone());
        }
    }
    // Cases that spoil others pass when drawn alone; drawing just the pair shows that they spoil.
    let (culprit, spoilt) = culprits.first_key_value().unwrap();
    let both = folder();
    etalon(&[
        "run",
        culprit,
        &spoilt[0],
        "--adapter",
        "cpu:fault=after",
        "--out",
    ])
    .arg(both.path())
    .args(["--jobs", "1"])
    .assert()
    .code(predicates::ord::lt(2));
    let run = Run::read(both.path()).unwrap();
    let drawn: Vec<(&String, bool)> = run
        .records
        .iter()
        .map(|r| (&r.case, r.verdict.is_bad()))
        .collect();
    let culprit_first = drawn[0].0 == culprit;
    assert_eq!(
        drawn,
        if culprit_first {
            vec![(culprit, false), (&spoilt[0], true)]
        } else {
            vec![(&spoilt[0], false), (culprit, false)]
        }
    );
}

/// Returns the records of a run in order, without what can differ between runs.
fn plain(folder: &Path) -> Vec<String> {
    let run = Run::read(folder).unwrap();
    assert!(!run.truncated);
    assert_eq!(run.missing(), 0);
    let mut texts: Vec<String> = run
        .records
        .into_iter()
        .map(|mut record| {
            record.seconds = etalon_record::Seconds::default();
            if let Some(end) = &mut record.process {
                end.seconds = 0.0;
            }
            serde_json::to_string(&record).unwrap()
        })
        .collect();
    texts.sort_unstable();
    texts
}

/// Returns all files below a folder with their contents.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    found
}

/// A run that takes some time and has records of all kinds. It keeps all frames: otherwise the first case to be
/// drawn shows a known failure in full, and with several jobs that can be another case each time.
const RUN: [&str; 10] = [
    "run",
    "selftest/depth*",
    "selftest/stencil-compare",
    "cull/lines",
    "--adapter",
    "cpu",
    "--adapter",
    "cpu:fault=abort",
    "--keep-frames",
    "all",
];

fn start(out: &Path, more: &[&str]) -> Child {
    let mut command = std::process::Command::new(BINARY);
    for name in REMOVED {
        command.env_remove(name);
    }
    command
        .args(RUN)
        .arg("--out")
        .arg(out)
        .args(more)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Returns the number of records of the run in a folder.
fn records_in(folder: &Path) -> usize {
    let text = fs::read_to_string(folder.join("run.jsonl")).unwrap_or_default();
    text.matches("{\"case\":").count()
}

/// Waits until a run has written more than `before` records, or has ended.
fn wait_for_progress(child: &mut Child, out: &Path, before: usize) {
    let start = Instant::now();
    while records_in(out) <= before && child.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "no records come");
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn killed_at_random_moments_a_run_ends_as_if_nothing_had_happened() {
    let undisturbed = folder();
    let began = Instant::now();
    let mut child = start(undisturbed.path(), &[]);
    wait_for_progress(&mut child, undisturbed.path(), 0);
    let first = began.elapsed();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let all_records = records_in(undisturbed.path());
    let expected = plain(undisturbed.path());
    let due_frames: Vec<Vec<u8>> = files(&undisturbed.path().join("frames"))
        .into_values()
        .collect();
    assert!(!due_frames.is_empty());

    let planned = sample::count("kills", 32, 200);
    let mut random = 1_u64;
    let mut share = || {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f64 / (1_u64 << 24) as f64
    };
    let (mut kills, mut ended, mut inside) = (0, 0, 0);
    while kills < planned {
        let out = folder();
        loop {
            let before = records_in(out.path());
            let mut child = start(out.path(), &["--resume"]);
            // Every second kill waits for records of this process, so that it falls between records on a busy
            // machine too.
            if kills % 2 == 0 {
                sleep(first.mul_f64(share()));
            } else {
                let left = all_records.saturating_sub(before);
                wait_for_progress(
                    &mut child,
                    out.path(),
                    before + (left as f64 * share() / 2.0) as usize,
                );
            }
            if let Some(status) = child.try_wait().unwrap() {
                let mut said = String::new();
                let mut errors = child.stderr.take().unwrap();
                errors.read_to_string(&mut said).unwrap();
                assert_eq!(status.code(), Some(1), "{said}");
                ended += 1;
                break;
            }
            if kills >= planned {
                assert_eq!(child.wait().unwrap().code(), Some(1));
                break;
            }
            child.kill().unwrap();
            child.wait().unwrap();
            kills += 1;
            // The folder must be readable at any moment.
            if out.path().join("run.jsonl").exists() {
                let run = Run::read(out.path()).unwrap();
                inside += usize::from(!run.records.is_empty() && run.missing() > 0);
            }
        }
        assert!(plain(out.path()) == expected, "after {kills} kills");
        let frames: Vec<Vec<u8>> = files(&out.path().join("frames")).into_values().collect();
        assert!(frames == due_frames, "after {kills} kills");
    }
    println!("{kills} kills, {inside} of them between records, {ended} runs that ended before");
    assert!(inside >= planned / 4, "{inside}");
}

/// Waits until a run has written some records.
fn wait_for_records(child: &mut Child, out: &Path) {
    wait_for_progress(child, out, 4);
    assert!(records_in(out) > 4, "it ended too early");
}

#[test]
fn an_interrupted_run_says_how_to_go_on_and_does() {
    for signal in [Signal::INT, Signal::TERM] {
        let out = folder();
        let mut command = std::process::Command::new(BINARY);
        for name in REMOVED {
            command.env_remove(name);
        }
        let run = ["run", "stencil/*", "--adapter", "cpu", "--out"];
        let mut child = command
            .args(run)
            .arg(out.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_records(&mut child, out.path());
        kill_process(Pid::from_child(&child), signal).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(3));
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            said.contains("interrupted") && said.contains("--resume"),
            "{said}"
        );
        let cut = Run::read(out.path()).unwrap();
        assert!(cut.missing() > 0 && !cut.truncated);
        assert!(
            cut.records.iter().all(|r| !r.unexpected()),
            "nothing is blamed"
        );
        // The printed words are a command, and the folder alone is enough.
        let command = said.rsplit("resume with: etalon ").next().unwrap();
        let words = shlex::split(command).unwrap();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match signal {
            Signal::INT => etalon(&words).assert().code(0),
            _ => {
                let mut alone = etalon(&["run", "--resume", "--out"]);
                alone.arg(out.path()).assert().code(0)
            }
        };
        let run = Run::read(out.path()).unwrap();
        assert_eq!(run.missing(), 0);
        assert_eq!(run.records[..cut.records.len()], cut.records[..]);
    }
}

#[test]
fn a_folder_in_use_or_with_a_run_is_left_alone() {
    let out = folder();
    // A run that waits for a hanging driver.
    let mut first = std::process::Command::new(BINARY)
        .args([
            "run",
            "cull/*",
            "--adapter",
            "cpu:fault=hang",
            "--timeout",
            "90",
        ])
        .arg("--out")
        .arg(out.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for_progress(&mut first, out.path(), 0);
    let again = |more: &[&str]| {
        let mut command = etalon(&RUN);
        command.arg("--out").arg(out.path()).args(more).assert()
    };
    for more in [&[][..], &["--resume"], &["--force"]] {
        again(more)
            .code(64)
            .stderr(contains("another etalon is writing"));
    }
    first.kill().unwrap();
    first.wait().unwrap();
    again(&["--force"]).code(1);
    let before = fs::read(out.path().join("run.jsonl")).unwrap();
    again(&[]).code(64).stderr(
        contains("holds a run already")
            .and(contains("--resume"))
            .and(contains("--force")),
    );
    again(&["--resume"]).code(1);
    assert_eq!(fs::read(out.path().join("run.jsonl")).unwrap(), before);
    // Another run cannot continue there.
    let other = |arguments: &[&str]| {
        etalon(arguments)
            .arg("--out")
            .arg(out.path())
            .arg("--resume")
            .assert()
            .code(64)
    };
    other(&["run", "cull/lines", "--adapter", "cpu"]).stderr(contains("selection"));
    other(&["run", RUN[1], RUN[2], RUN[3], "--adapter", "cpu"])
        .stderr(contains("cpu:fault=abort was there and is not here"));
    assert_eq!(fs::read(out.path().join("run.jsonl")).unwrap(), before);
    again(&["--force", "--resume"]).code(64);
    again(&["--force"]).code(1);
    assert_eq!(plain(out.path()).len() as u64, {
        let run = Run::read(out.path()).unwrap();
        run.header.expected_records()
    });
}

#[test]
fn a_run_without_a_folder_keeps_a_few_earlier_ones() {
    let work = folder();
    let work = work.path();
    let draw = |case: &str, more: &[&str]| {
        let mut command = etalon(&["run", case, "--adapter", "cpu"]);
        command.args(more).current_dir(work).assert().code(0);
    };
    let cases = |folder: &str| {
        Run::read(&work.join("reports").join(folder))
            .unwrap()
            .header
            .cases
    };
    draw("stencil/compare", &[]);
    let first = cases("latest");
    fs::write(work.join("reports/latest/note.txt"), "mine").unwrap();
    draw("cull/points", &[]);
    assert_ne!(cases("latest"), first);
    assert_eq!(cases("earlier/run-1"), first);
    draw("cull/points", &["--force"]);
    assert!(!work.join("reports/earlier/run-2").exists());
    for _ in 0..5 {
        draw("cull/points", &[]);
    }
    let kept = |number: u32| {
        work.join(format!("reports/earlier/run-{number}/run.jsonl"))
            .exists()
    };
    assert_eq!(
        [1, 2, 3, 4, 5, 6].map(kept),
        [false, true, true, true, true, true]
    );
    let note = fs::read_to_string(work.join("reports/earlier/run-1/note.txt"));
    assert_eq!(note.unwrap(), "mine");
}

#[test]
fn results_do_not_depend_on_order_or_the_number_of_workers() {
    let verdicts = |more: &[&str]| {
        let out = folder();
        etalon(&[
            "run",
            // But for outlines, which softpipe gives the face of what was drawn before them.
            "cull/{changed,depth,lines,needles,points,slivers,stencil,topologies,two}*",
            "scissor/*",
            "--adapter",
            "cpu",
            "--adapter",
            "gl:softpipe",
        ])
        .arg("--out")
        .arg(out.path())
        .args(more)
        .assert()
        .code(0);
        plain(out.path())
    };
    let expected = verdicts(&["--jobs", "1"]);
    for more in [
        &["--jobs", "4"][..],
        &["--jobs", "3", "--shuffle", "5"],
        &["--jobs", "1", "--shuffle", "6", "--shader-cache", "cold"],
    ] {
        // Of imprecise pictures the first few keep their frames, and which those are is order.
        let bare = |texts: &[String]| -> Vec<(String, String, String)> {
            let mut bare: Vec<_> = texts
                .iter()
                .map(|text| {
                    let r: Record = serde_json::from_str(text).unwrap();
                    (
                        r.case,
                        r.adapter,
                        format!("{:?} {:?} {:?}", r.verdict, r.texels, r.counters),
                    )
                })
                .collect();
            bare.sort();
            bare
        };
        assert_eq!(bare(&verdicts(more)), bare(&expected), "{more:?}");
    }
}

#[test]
fn a_limited_number_of_each_kind_is_rechecked_and_the_output_says_so() {
    let run = |recheck: &str, fault: &str| -> (serde_json::Value, Run) {
        let out = folder();
        let adapter = format!("cpu:fault={fault}");
        let arguments = [
            "run",
            "depth/*",
            "--adapter",
            &adapter,
            "--recheck",
            recheck,
            "--format",
            "json",
            "--jobs",
            "1",
            "--out",
        ];
        let output = etalon(&arguments).arg(out.path()).output().unwrap();
        (
            serde_json::from_slice(&output.stdout).unwrap(),
            Run::read(out.path()).unwrap(),
        )
    };
    let crashes = |run: &Run| {
        run.records
            .iter()
            .filter(|r| r.verdict == Verdict::Crash)
            .count() as u64
    };
    let (summary, rechecked) = run("2", "abort");
    let crashed = crashes(&rechecked);
    assert!(crashed > 8, "{crashed}");
    assert_eq!(
        (
            summary["rechecked"].as_u64(),
            summary["not_rechecked"].as_u64()
        ),
        (Some(2), Some(crashed - 2))
    );
    let (summary, unchecked) = run("off", "abort");
    assert_eq!(
        (
            summary["rechecked"].as_u64(),
            summary["not_rechecked"].as_u64()
        ),
        (Some(0), Some(crashed))
    );
    // The number changes no record.
    let plain = |run: Run| -> Vec<(String, Verdict, Vec<Verdict>)> {
        run.records
            .into_iter()
            .map(|r| (r.case, r.verdict, r.repeats))
            .collect()
    };
    assert_eq!(plain(rechecked), plain(unchecked));
    // What is refuted does not use the number up. A process goes wrong by chance, and the next one as well: that no run
    // of these holds both has a chance of 1 to 10^9.
    let records_of = |run: &Run, verdict| -> Vec<Record> {
        let records = run.records.iter().filter(|r| r.verdict == verdict);
        records.cloned().collect()
    };
    let (summary, flaky, failed) = (0..32)
        .map(|_| run("1", "flaky"))
        .map(|(summary, run)| {
            (
                summary,
                records_of(&run, Verdict::Flaky),
                records_of(&run, Verdict::Fail),
            )
        })
        .find(|(_, flaky, failed)| !flaky.is_empty() && !failed.is_empty())
        .unwrap();
    let kinds: BTreeSet<_> = failed.iter().map(|r| Symptom::of(r).broad()).collect();
    assert_eq!(
        summary["rechecked"].as_u64(),
        Some((flaky.len() + kinds.len()) as u64),
        "{summary}"
    );

    let text = etalon(&[
        "run",
        "depth/*",
        "--adapter",
        "cpu:fault=abort",
        "--recheck",
        "3",
        "--out",
    ])
    .arg(folder().path())
    .assert()
    .code(1);
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.contains("Rechecked: 3 of "), "{text}");
    etalon(&["run", "--recheck", "0"]).assert().code(64);
}

#[test]
fn a_bad_verdict_is_printed_once_with_its_reason() {
    let out = folder();
    let arguments = [
        "run",
        "depth/*",
        "--adapter",
        "cpu:fault=abort",
        "--recheck",
        "off",
        "--out",
    ];
    let output = etalon(&arguments).arg(out.path()).output().unwrap();
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    let run = Run::read(out.path()).unwrap();
    let crashed: Vec<&Record> = run
        .records
        .iter()
        .filter(|r| r.verdict == Verdict::Crash)
        .collect();
    assert!(!crashed.is_empty());
    let lines_of = |record: &&&Record| {
        let line = format!(
            "{}: the worker died of signal 6 (SIGABRT); stderr ends with: about to abort, as planted",
            record.case
        );
        text.matches(&line).count()
    };
    let counts: Vec<usize> = crashed.iter().map(|record| lines_of(&record)).collect();
    assert!(counts.iter().all(|n| *n <= 1), "{text}");
    assert_eq!(
        counts.iter().sum::<usize>(),
        crashed.len().min(20),
        "{text}"
    );
    assert!(!text.contains('…'), "{text}");
    let arguments = [
        "run",
        "depth/*",
        "--adapter",
        "cpu:fault=abort",
        "--format",
        "json",
        "--out",
    ];
    let output = etalon(&arguments).arg(folder().path()).output().unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let counts = &summary["verdicts"]["cpu:fault=abort"];
    assert_eq!(
        counts["crash"].as_u64(),
        Some(crashed.len() as u64),
        "{summary:#}"
    );
    assert_eq!(
        counts["pass"].as_u64(),
        Some((run.records.len() - crashed.len()) as u64)
    );
}
