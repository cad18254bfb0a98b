//! `etalon diff` of runs and of benches, and `etalon report` of benches.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use etalon_record::{
    AdapterRecord, BENCH_FORMAT, BenchHeader, BenchLine, BenchWriter, Expectations, Header,
    Picture, Provenance, Record, Round, RunWriter, ShaderCache, Verdict,
};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::path::Path;

fn etalon() -> Command {
    Command::new(env!("CARGO_BIN_EXE_etalon"))
}

fn adapter(name: &str) -> AdapterRecord {
    let adapter = json!({
        "name": name, "backend": "cpu", "device": "d", "driver": "etalon", "driver_version": "1",
        "api_version": "1", "software": true,
        "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
            "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
    });
    serde_json::from_value(adapter).unwrap()
}

/// Writes a bench of one case on `cpu` with nine rounds of about `seconds` per frame.
fn bench(folder: &Path, seconds: f64) {
    let header = BenchHeader {
        format: BENCH_FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            started: "2026-01-01T00:00:00Z".to_owned(),
            command: vec!["etalon".to_owned(), "bench".to_owned()],
            ..Provenance::default()
        },
        profile: "quick".to_owned(),
        cases: 1,
        rounds: 9,
        shader_cache: ShaderCache::Warm,
        ruler: "counting".to_owned(),
        limits: Vec::new(),
        settings: Default::default(),
        adapters: vec![adapter("cpu")],
        absent: Vec::new(),
    };
    let mut writer = BenchWriter::create(folder, &header).unwrap();
    let picture = Picture {
        case: "perf/clear".to_owned(),
        adapter: "cpu".to_owned(),
        verdict: Verdict::Pass,
        asserted: 1.0,
        reasons: Vec::new(),
        work: None,
        accuracy: Vec::new(),
    };
    writer.append(&BenchLine::Picture(picture)).unwrap();
    for round in 0..9 {
        let jitter = 1.0 + f64::from(round * 5 % 9) / 2000.0;
        let line = BenchLine::Round(Round {
            case: "perf/clear".to_owned(),
            adapter: "cpu".to_owned(),
            round,
            at: f64::from(round),
            ruler: [0.002, 0.002],
            prepare: 0.1,
            first: 0.1,
            warm_up: 1,
            wall: vec![seconds * jitter; 3],
            cpu: vec![seconds * jitter; 3],
            gpu: Vec::new(),
            clock: None,
            read_back: Vec::new(),
        });
        writer.append(&line).unwrap();
    }
}

#[test]
fn a_slower_bench_exits_with_one_and_any_other_with_zero() {
    let folder = tempfile::tempdir().unwrap();
    let (fast, slow) = (folder.path().join("fast"), folder.path().join("slow"));
    bench(&fast, 0.001);
    bench(&slow, 0.00105);
    diff(&fast, &slow)
        .assert()
        .code(1)
        .stdout(contains("1 slower, 0 faster"));
    diff(&slow, &fast)
        .assert()
        .code(0)
        .stdout(contains("0 slower, 1 faster"));
    let page = folder.path().join("diff.html");
    let output = diff(&fast, &fast)
        .args(["--format", "json", "--time", "cpu", "--out"])
        .arg(&page)
        .assert()
        .code(0)
        .get_output()
        .stdout
        .clone();
    let json: Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(json["changes"][0]["outcome"], "cannot tell");
    assert_eq!(json["time"], "cpu");
    assert!(page.is_file());
    diff(&fast, &slow)
        .args(["--time", "gpu"])
        .assert()
        .code(4)
        .stderr(contains("gpu time"));
}

/// Writes a run of one adapter with one case per verdict.
fn run(folder: &Path, name: &str, verdicts: &[Verdict]) {
    let header = Header {
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            started: "2026-01-01T00:00:00Z".to_owned(),
            command: vec!["etalon".to_owned(), "run".to_owned()],
            ..Provenance::default()
        },
        ..Header::new(vec![adapter(name)], verdicts.len() as u64)
    };
    let mut writer = RunWriter::create(folder, &header).unwrap();
    for (i, verdict) in verdicts.iter().enumerate() {
        let mut record = Record::new(format!("depth/f/case={i}"), name, *verdict);
        record.expect(&Expectations::default(), &header.adapters[0]);
        writer.append(&record).unwrap();
    }
}

fn diff(before: &Path, after: &Path) -> Command {
    let mut command = etalon();
    command.arg("diff").arg(before).arg(after);
    command
}

#[test]
fn worse_runs_exit_with_one_better_ones_with_two_and_others_with_zero() {
    use Verdict::{Fail, Imprecise, Pass};
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, verdicts: &[Verdict]| {
        let path = folder.path().join(name);
        run(&path, "cpu", verdicts);
        path
    };
    let bad = made("bad", &[Pass, Fail, Pass]);
    let good = made("good", &[Pass, Pass, Pass]);
    let other = made("other", &[Pass, Pass, Imprecise]);
    let printed = |before: &Path, after: &Path, code: i32| {
        let assert = diff(before, after).assert().code(code);
        String::from_utf8(assert.get_output().stdout.clone()).unwrap()
    };
    insta::assert_snapshot!("diff-same", printed(&good, &good, 0));
    insta::assert_snapshot!("diff-worse", printed(&good, &bad, 1));
    insta::assert_snapshot!("diff-better", printed(&bad, &good, 2));
    insta::assert_snapshot!("diff-other", printed(&good, &other, 0));
    // One worse case outweighs improvements.
    let both = made("both", &[Fail, Pass, Pass]);
    diff(&bad, &both).assert().code(1);
}

#[test]
fn a_failure_that_becomes_a_crash_is_worse_and_the_reverse_better() {
    use Verdict::{Crash, DeviceLost, Fail, NotSupported, Open, Timeout};
    let folder = tempfile::tempdir().unwrap();
    let made = |verdict: Verdict| {
        let path = folder.path().join(verdict.name());
        run(&path, "cpu", &[verdict]);
        path
    };
    let fail = made(Fail);
    for lost in [Crash, Timeout, DeviceLost] {
        let lost = made(lost);
        diff(&fail, &lost).assert().code(1);
        diff(&lost, &fail).assert().code(2);
    }
    // Nothing is known about the driver any more.
    for unknown in [Open, NotSupported] {
        diff(&fail, &made(unknown)).assert().code(0);
    }
}

#[test]
fn an_incomplete_run_is_no_basis_of_a_comparison() {
    let folder = tempfile::tempdir().unwrap();
    let made = |name: &str, verdicts: &[Verdict]| {
        let path = folder.path().join(name);
        run(&path, "cpu", verdicts);
        path
    };
    let whole = made("whole", &[Verdict::Pass; 2]);
    let empty = made("empty", &[]);
    let part = made("part", &[Verdict::Pass; 2]);
    let records = part.join("run.jsonl");
    let text = std::fs::read_to_string(&records).unwrap();
    let first: Vec<&str> = text.split_inclusive('\n').take(2).collect();
    std::fs::write(&records, first.concat()).unwrap();
    for (before, words) in [
        (&part, "1 of 2 records are missing"),
        (&empty, "no case was run"),
    ] {
        diff(before, &whole)
            .assert()
            .code(3)
            .stderr(contains("the first run is incomplete: ").and(contains(words)));
    }
    // What is lost is worse.
    diff(&whole, &part).assert().code(1);
}

#[test]
fn runs_are_written_as_json_and_as_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    run(&a, "gl:x", &[Verdict::Pass, Verdict::Pass]);
    run(&b, "gl:y", &[Verdict::Pass, Verdict::Crash]);
    let page = folder.path().join("diff.html");
    let output = diff(&a, &b)
        .args(["--format", "json", "--out"])
        .arg(&page)
        .assert()
        .code(1)
        .get_output()
        .stdout
        .clone();
    let json: Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(json["kind"], "runs");
    assert_eq!(json["pairs"][0]["adapter"], json!(["gl:x", "gl:y"]));
    assert_eq!(json["changes"][0]["verdict"], json!(["pass", "crash"]));
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("depth/f/case=1") && html.contains("1 worse"));
    diff(&a, &b)
        .args([
            "--adapter-before",
            "gl:x",
            "--adapter-after",
            "gl:y",
            "--out",
        ])
        .arg(&page)
        .assert()
        .code(1)
        .stdout(contains("Report: ").and(contains("gl:x → gl:y")));
}

#[test]
fn inputs_that_cannot_be_compared_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let fast = folder.path().join("fast");
    bench(&fast, 0.001);
    let good = folder.path().join("good");
    run(&good, "cpu", &[Verdict::Pass; 2]);
    let damaged = folder.path().join("damaged");
    run(&damaged, "cpu", &[Verdict::Pass; 2]);
    let path = damaged.join("run.jsonl");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen("\"verdict\"", "\"verdct\"", 1)).unwrap();
    let empty = folder.path().join("empty");
    run(&empty, "cpu", &[]);
    let nothing = folder.path().join("nothing");
    for (before, after, arguments, code, words) in [
        (&fast, &good, vec![], 64, "two runs or two benches"),
        (&good, &fast, vec![], 64, "two runs or two benches"),
        (&fast, &nothing, vec![], 64, "nothing holds neither"),
        (&nothing, &good, vec![], 64, "nothing holds neither"),
        (&good, &damaged, vec![], 64, "run.jsonl:2: "),
        (
            &good,
            &good,
            vec!["--time", "gpu"],
            64,
            "--time is for two benches",
        ),
        (
            &good,
            &good,
            vec!["--adapter-before", "cpu"],
            64,
            "--adapter-after",
        ),
        (
            &good,
            &good,
            vec!["--adapter-before", "cpu", "--adapter-after", "gl:z"],
            64,
            "has no adapter gl:z; it has cpu",
        ),
        (
            &fast,
            &fast,
            vec!["--adapter-before", "cpu", "--adapter-after", "cpu"],
            64,
            "are for two runs",
        ),
        (
            &good,
            &good,
            vec!["--out", "/nowhere/diff.html"],
            64,
            "is no folder; make it",
        ),
        (&empty, &empty, vec![], 4, "neither run holds a record"),
    ] {
        diff(before, after)
            .args(arguments)
            .assert()
            .code(code)
            .stderr(contains(words));
    }
}

#[test]
fn reports_of_a_bench_are_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    bench(folder.path(), 0.001);
    etalon()
        .arg("report")
        .arg(folder.path())
        .assert()
        .code(0)
        .stdout(contains("perf/clear").and(contains("bencher.json")));
    for name in ["index.html", "bencher.json", "benchmark-action.json"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}
