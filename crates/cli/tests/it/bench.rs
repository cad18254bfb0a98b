//! Benches. The tests assert no times.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Bench, Enough, FolderKind, ShaderCache, Verdict};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder of cases: one picture that is right, and one that the judge takes for wrong.
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
fn right_pictures_are_timed_and_wrong_ones_are_not() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    // A selftest is due to fail, so the bench succeeds.
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
    let [accuracy] = &right.picture.accuracy[..] else {
        panic!("{:?}", right.picture)
    };
    assert!(accuracy.channels > 0 && accuracy.is_exact());
    assert!(
        right
            .picture
            .work
            .is_some_and(|work| work.texels > 0 || work.cleared > 0)
    );
    let wrong = bench.record("perf/wrong", "cpu").unwrap();
    assert_eq!(wrong.picture.verdict, Verdict::Fail);
    assert!(wrong.rounds.is_empty());
    for name in ["index.html", "bencher.json", "benchmark-action.json"] {
        assert!(out.path().join(name).is_file(), "{name}");
    }
}

#[test]
fn a_bench_summarizes_itself_as_json() {
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
    assert_eq!(adapter.info.name, "cpu");
    assert!(
        adapter.info.driver_version.ends_with("slower by 50 %"),
        "{adapter:?}"
    );
    assert_eq!(bench_of.header.shader_cache, ShaderCache::Cold);
    let both = ["--adapter", "cpu", "--adapter", "cpu:slower=5%"];
    let other = tempfile::tempdir().unwrap();
    bench(cases.path(), other.path(), &both)
        .code(64)
        .stderr(contains("report the name cpu"));
    etalon(&["adapters"])
        .assert()
        .stdout(contains("slower").not());
}

#[test]
fn instructions_are_counted_beside_the_times() {
    const CASE: &str = "perf/quad/size=256x256";
    let counted = |adapter: &str| {
        let out = tempfile::tempdir().unwrap();
        let mut bench = etalon(&["bench", CASE, "--seconds", "0.001", "--rounds", "1"]);
        bench.args(["--instructions", "--adapter", adapter, "--out"]);
        let ran = bench.arg(out.path()).assert();
        ran.code(0).stdout(contains("instructions"));
        let recorded = Bench::read(out.path()).unwrap();
        let record = recorded.record(CASE, "cpu").unwrap();
        assert_eq!(record.rounds.len(), 1);
        assert_eq!(record.counted.as_ref().unwrap().processes.len(), 3);
        out
    };
    // The slower rasterizer spends its time in a loop, with many times the instructions.
    let [before, after] = ["cpu", "cpu:slower=50%"].map(counted);
    let diff = |after: &Path| {
        let folders = [before.path(), after].map(|path| path.to_str().unwrap().to_owned());
        etalon(&["diff", &folders[0], &folders[1], "--format", "json"]).assert()
    };
    let outcome = |output: &[u8]| {
        let found: Value = serde_json::from_slice(output).unwrap();
        found["instructions"][0]["outcome"].clone()
    };
    let slower = diff(after.path()).code(1);
    assert_eq!(outcome(&slower.get_output().stdout), "more");
    let same = diff(before.path());
    assert_eq!(outcome(&same.get_output().stdout), "as-many");
}

#[test]
fn wrong_usage_exits_with_64_and_an_empty_selection_with_4() {
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
            "expected a number of percent",
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

#[test]
fn a_recorded_bench_is_not_replaced_without_force() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    let right = ["perf/right", "--adapter", "cpu"];
    bench(cases.path(), out.path(), &right).code(0);
    let file = out.path().join("bench.jsonl");
    let before = fs::read(&file).unwrap();
    bench(cases.path(), out.path(), &right)
        .code(64)
        .stderr(contains("already holds a bench").and(contains("--force")));
    let run = |arguments: &[&str]| {
        let mut command = etalon(&["run", "perf/right", "--adapter", "cpu", "--cases"]);
        command.arg(cases.path()).arg("--out").arg(out.path());
        command.args(arguments).assert()
    };
    for arguments in [&[][..], &["--resume"]] {
        run(arguments)
            .code(64)
            .stderr(contains("holds a bench").and(contains("--force")));
    }
    etalon(&["merge", "--out"])
        .args([out.path(), out.path()])
        .assert()
        .code(64);
    assert_eq!(fs::read(&file).unwrap(), before);
    assert!(out.path().join("bencher.json").is_file());

    run(&["--force"]).code(0);
    assert_eq!(FolderKind::of(out.path()), Some(FolderKind::Run));
    assert!(!out.path().join("bencher.json").exists());
    let other = [&right[..], &["--resume"]].concat();
    bench(cases.path(), out.path(), &other)
        .code(64)
        .stderr(contains("holds a run"));
    let forced = [&right[..], &["--force"]].concat();
    bench(cases.path(), out.path(), &forced).code(0);
    assert_eq!(FolderKind::of(out.path()), Some(FolderKind::Bench));
    assert!(!out.path().join("junit.xml").exists());
}

#[test]
fn a_bench_that_was_stopped_is_resumed() {
    let cases = cases();
    let out = tempfile::tempdir().unwrap();
    bench(cases.path(), out.path(), &["--adapter", "cpu"]).code(0);
    let file = out.path().join("bench.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    // The header, both pictures and the first round; half of the second.
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 5);
    let half = &lines[4][..lines[4].len() / 2];
    let stopped = format!("{}\n{half}", lines[..4].join("\n"));
    fs::write(&file, &stopped).unwrap();
    assert_eq!(Bench::read(out.path()).unwrap().missing(), 1);
    bench(
        cases.path(),
        out.path(),
        &["--adapter", "cpu", "--resume", "--cold"],
    )
    .code(64)
    .stderr(contains("the shader cache was warm there and is cold here"));
    bench(
        cases.path(),
        out.path(),
        &["--adapter", "cpu", "--resume", "perf/right"],
    )
    .code(64)
    .stderr(contains("the selection of cases"));
    assert_eq!(fs::read_to_string(&file).unwrap(), stopped);
    bench(
        cases.path(),
        out.path(),
        &["--adapter", "cpu", "--resume", "--timeout", "30"],
    )
    .code(0);
    let done = Bench::read(out.path()).unwrap();
    assert_eq!((done.missing(), done.truncated), (0, false));
    let rounds = &done.record("perf/right", "cpu").unwrap().rounds;
    assert_eq!(rounds.len(), 2);
    assert!(rounds[1].at >= rounds[0].at, "{rounds:?}");
    // Measured rounds stay.
    let now = fs::read_to_string(&file).unwrap();
    assert!(now.starts_with(&lines[..4].join("\n")), "{now}");
}

#[test]
fn shards_of_a_bench_are_the_whole() {
    let cases = cases();
    let mut seen = Vec::new();
    for shard in ["1/2", "2/2"] {
        let out = tempfile::tempdir().unwrap();
        bench(
            cases.path(),
            out.path(),
            &["--adapter", "cpu", "--shard", shard],
        )
        .stderr(contains(format!("shard {shard}: ")));
        let part = Bench::read(out.path()).unwrap();
        assert_eq!(part.header.settings.shard.unwrap().to_string(), shard);
        seen.extend(part.records.into_iter().map(|r| r.picture.case));
    }
    seen.sort();
    assert_eq!(seen, ["perf/right", "perf/wrong"]);
}

#[test]
fn a_bench_waits_no_longer_than_its_time_limit() {
    let cases = cases();
    let text = fs::read_to_string(cases.path().join("perf/right.json")).unwrap();
    let mut file: Value = serde_json::from_str(&text).unwrap();
    file["axes"] = json!({ "n": { "from": 1, "count": 24 } });
    file["scene"]["attachments"]["color"]["size"] = json!([8, "$n"]);
    fs::write(cases.path().join("perf/sizes.json"), file.to_string()).unwrap();
    let out = tempfile::tempdir().unwrap();
    // One scene in eight hangs.
    let hanging = [
        "perf/sizes",
        "--adapter",
        "cpu:fault=hang",
        "--timeout",
        "0.3",
        "--rounds",
        "1",
    ];
    let mut command = etalon(&["bench", "--seconds", "0.001", "--cases"]);
    command
        .arg(cases.path())
        .arg("--out")
        .arg(out.path())
        .args(hanging);
    command.assert().code(1);
    let bench = Bench::read(out.path()).unwrap();
    let timeouts = bench
        .records
        .iter()
        .filter(|r| r.picture.verdict == Verdict::Timeout)
        .count();
    assert!((1..20).contains(&timeouts), "{timeouts}");
}

#[test]
fn cells_of_the_matrix_are_measured_where_they_are_named() {
    let out = tempfile::tempdir().unwrap();
    let named = [
        "bench",
        "perf/matrix/clear/format=rgba8unorm*",
        "perf/matrix/read-back/format=rgba8unorm*",
        "--adapter",
        "cpu",
        "--seconds",
        "0.001",
        "--rounds",
        "2",
        "--within",
        "3%",
        "--format",
        "json",
        "--out",
    ];
    let output = etalon(&named)
        .arg(out.path())
        .assert()
        .code(0)
        .get_output()
        .clone();
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(
        summary["matrix"]
            .as_array()
            .is_some_and(|files| files.len() == 2),
        "{summary}"
    );
    let bench = Bench::read(out.path()).unwrap();
    assert_eq!((bench.header.cases, bench.missing()), (4, 0));
    assert_eq!(bench.header.settings.within, Some(0.03));
    // The two cases of a cell come one after the other.
    let layers: Vec<&str> = bench
        .records
        .iter()
        .filter_map(|r| r.picture.case.split('/').find(|p| p.starts_with("layers=")))
        .collect();
    assert_eq!(layers, ["layers=4", "layers=12", "layers=1", "layers=3"]);
    assert!(
        bench
            .records
            .iter()
            .all(|r| r.picture.work.is_some_and(|w| w.read > 0))
    );
    let csv = fs::read_to_string(out.path().join("matrix.csv")).unwrap();
    let cell = "cpu,perf/matrix/clear/format=rgba8unorm/size=512x512,";
    assert!(csv.contains(cell), "{csv}");
    assert_eq!(csv.lines().count(), 3);
    fs::remove_file(out.path().join("matrix.html")).unwrap();
    let mut report = etalon(&["report"]);
    report
        .arg(out.path())
        .assert()
        .code(0)
        .stdout(contains("matrix.csv").and(contains("Gpix/s")));
    assert!(out.path().join("matrix.html").exists());
    // Another bench in the folder removes the reports of this one.
    let cases = cases();
    bench_of(cases.path(), out.path());
    assert!(!out.path().join("matrix.html").exists() && !out.path().join("matrix.csv").exists());
}

/// Replaces the bench in a folder by one of another folder's cases, which has cells without naming them.
fn bench_of(cases: &Path, out: &Path) {
    let matrix = cases.join("perf/matrix");
    fs::create_dir(&matrix).unwrap();
    let text = fs::read_to_string(cases.join("perf/right.json")).unwrap();
    let mut file: Value = serde_json::from_str(&text).unwrap();
    file["axes"] = json!({ "layers": [1, 2] });
    file["scene"]["attachments"]["color"]["size"] = json!([8, "$layers"]);
    fs::write(matrix.join("fill.json"), file.to_string()).unwrap();
    bench(cases, out, &["--adapter", "cpu", "--force"]).code(0);
    let ids: Vec<String> = Bench::read(out)
        .unwrap()
        .records
        .into_iter()
        .map(|r| r.picture.case)
        .collect();
    assert_eq!(ids, ["perf/right", "perf/wrong"]);
}

#[test]
fn rounds_end_when_they_are_enough() {
    let cases = cases();
    for (flags, reason) in [
        (["--within", "100%"], Enough::Within),
        (["--limit", "0.1"], Enough::Limit),
    ] {
        let out = tempfile::tempdir().unwrap();
        let mut command = etalon(&[
            "bench",
            "perf/right",
            "--adapter",
            "cpu",
            "--seconds",
            "0.001",
        ]);
        command
            .args(["--rounds", "300"])
            .args(flags)
            .arg("--cases")
            .arg(cases.path());
        command.arg("--out").arg(out.path()).assert().code(0);
        let bench = Bench::read(out.path()).unwrap();
        let record = bench.record("perf/right", "cpu").unwrap();
        assert_eq!((record.enough, bench.missing()), (Some(reason), 0));
        let rounds = record.rounds.len();
        assert!(rounds < 300, "{rounds}");
        assert!(reason == Enough::Limit || rounds >= 7, "{rounds}");
    }
    let out = tempfile::tempdir().unwrap();
    for wrong in ["3", "0%", "101%", "x%"] {
        bench(cases.path(), out.path(), &["--within", wrong])
            .code(64)
            .stderr(contains("such as 3%"));
    }
}

#[test]
fn a_run_can_time_each_kind_of_work_too() {
    let out = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let mut command = etalon(&["run", "depth/compare", "--adapter", "cpu", "--force"]);
        command.args(arguments).arg("--out").arg(out.path());
        let output = command.assert().success().get_output().stdout.clone();
        let page = fs::read_to_string(out.path().join("details.html")).unwrap();
        (String::from_utf8(output).unwrap(), page)
    };
    let timed = out.path().join("timed");
    let (printed, page) = run(&["--timed", "--format", "json"]);
    let printed: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(printed["timed"], json!(timed.join("index.html")));
    let bench = Bench::read(&timed).unwrap();
    assert!(bench.records.len() > 8, "{}", bench.records.len());
    assert!(bench.records.iter().all(|record| !record.rounds.is_empty()));
    assert!(page.contains("<section id=\"speed\">") && page.contains("href=\"#speed\""));
    // A new run has no times of the one it replaces.
    let (printed, page) = run(&[]);
    assert!(!printed.contains("Frame times"), "{printed}");
    assert!(!page.contains("id=\"speed\""));
    assert_eq!(FolderKind::of(&timed), None);
}
