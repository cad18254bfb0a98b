//! `etalon diff` and `etalon report` of bench folders, as a user meets them.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use assert_cmd::Command;
use etalon_record::{
    BENCH_FORMAT, BenchHeader, BenchLine, BenchWriter, Machine, Picture, Round, ShaderCache,
    Verdict,
};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::path::Path;

fn etalon() -> Command {
    Command::new(env!("CARGO_BIN_EXE_etalon"))
}

/// A bench of one case on `cpu` with nine rounds of about so many seconds a frame.
fn bench(folder: &Path, seconds: f64) {
    let adapter = json!({
        "name": "cpu", "backend": "cpu", "device": "d", "driver": "etalon", "driver_version": "1",
        "api_version": "1", "software": true,
        "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
            "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
    });
    let header = BenchHeader {
        format: BENCH_FORMAT,
        etalon: "0.1.0".to_owned(),
        commit: None,
        machine: Machine::default(),
        started: "2026-01-01T00:00:00Z".to_owned(),
        command: vec!["etalon".to_owned(), "bench".to_owned()],
        profile: "quick".to_owned(),
        cases: 1,
        rounds: 9,
        shader_cache: ShaderCache::Warm,
        ruler: "counting".to_owned(),
        adapters: vec![serde_json::from_value(adapter).unwrap()],
        absent: Vec::new(),
    };
    let mut writer = BenchWriter::create(folder, &header).unwrap();
    let picture = Picture {
        case: "perf/clear".to_owned(),
        adapter: "cpu".to_owned(),
        verdict: Verdict::Pass,
        asserted: 1.0,
        message: String::new(),
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
            read_back: Vec::new(),
        });
        writer.append(&line).unwrap();
    }
}

#[test]
fn a_slower_bench_gives_one_and_any_other_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (fast, slow) = (folder.path().join("fast"), folder.path().join("slow"));
    bench(&fast, 0.001);
    bench(&slow, 0.00105);
    let diff = |a: &Path, b: &Path| {
        let mut command = etalon();
        command.arg("diff").arg(a).arg(b);
        command
    };
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

#[test]
fn other_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let fast = folder.path().join("fast");
    bench(&fast, 0.001);
    let run = folder.path().join("run");
    std::fs::create_dir(&run).unwrap();
    std::fs::write(run.join("run.jsonl"), "{}\n").unwrap();
    for (other, words) in [
        (&run, "no runs yet"),
        (&folder.path().join("nothing"), "holds no bench.jsonl"),
    ] {
        etalon()
            .arg("diff")
            .arg(&fast)
            .arg(other)
            .assert()
            .code(64)
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
