//! Whole runs.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, etalon};
use assert_cmd::Command;
use etalon_frame::{Band, CounterOutcome, Requirement};
use etalon_record::{Reason, Record, Run, Verdict};
use etalon_report::message;
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Debian's software drivers; the test script installs them.
const DUE: [&str; 7] = [
    "cpu",
    "gl:es:softpipe",
    "gl:llvmpipe",
    "gl:softpipe",
    "vulkan:lavapipe",
    "wgpu:gl:llvmpipe",
    "wgpu:vulkan:lavapipe",
];

fn run(out: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = etalon(&["run", "--force", "--out"]);
    command.arg(out).args(arguments).assert()
}

fn count(globs: &[&str]) -> usize {
    let output = etalon(&["list"]).args(globs).assert().success();
    output
        .get_output()
        .stdout
        .iter()
        .filter(|b| **b == b'\n')
        .count()
}

fn pairs(records: &[Record]) -> BTreeSet<(&str, &str)> {
    records
        .iter()
        .map(|r| (r.case.as_str(), r.adapter.as_str()))
        .collect()
}

/// Reads the run in a folder. It must have exactly one record per case and adapter.
fn whole(folder: &Path) -> Run {
    let run = Run::read(folder).unwrap();
    assert!(!run.truncated);
    assert_eq!(run.missing(), 0);
    assert_eq!(
        pairs(&run.records).len(),
        run.records.len(),
        "no pair twice"
    );
    assert_eq!(run.records.len() as u64, run.header.expected_records());
    for file in ["index.html", "junit.xml"] {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        assert!(text.len() > 100, "{file}: {text}");
    }
    run
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn every_selftest_fails_for_a_stated_reason() {
    let out = folder();
    let adapters = ["cpu", "vulkan:lavapipe", "gl:softpipe"];
    for adapter in adapters {
        let whole_records = ["--keep-frames", "all"];
        let drawn = ["selftest/*", "--adapter", adapter];
        run(out.path(), &[&drawn[..], &whole_records].concat()).code(0);
        let run = whole(out.path());
        assert_eq!(run.records.len(), count(&["selftest"]));
        for record in &run.records {
            assert!(record.due_fail, "{record:?}");
            if matches!(record.verdict, Verdict::NotSupported | Verdict::Blocked) {
                assert_ne!(adapter, "cpu", "{record:?}");
                continue;
            }
            assert_eq!(record.verdict, Verdict::Fail, "{record:?}");
            let counted = |c: &CounterOutcome| c.band == Some(Band::Fail);
            if record.texels.wrong == 0 && record.counters.iter().any(counted) {
                assert!(message(record).starts_with("counter "), "{record:?}");
                continue;
            }
            assert!(
                record.texels.wrong > 0 && !record.wrong.is_empty(),
                "{record:?}"
            );
            if record.case.starts_with("selftest/relation-") {
                let differ = |reason: &Reason| matches!(reason, Reason::Difference { .. });
                assert!(record.reasons.iter().any(differ), "{record:?}");
                continue;
            }
            let story = record.story.as_ref().unwrap();
            assert!(!story.events.is_empty(), "{record:?}");
            assert!(
                story.events.iter().any(|e| e.citation.is_some()),
                "{story:?}"
            );
            let frame = record.frame.as_ref().unwrap();
            let frame = Run::read_frame(out.path(), frame).unwrap();
            assert_eq!(
                (&frame.case, &frame.adapter),
                (&record.case, &record.adapter)
            );
            assert!(frame.images.iter().all(|i| i.is_whole()), "{frame:?}");
            assert!(
                frame.images.iter().any(|i| i.wrong.contains(&2)),
                "{frame:?}"
            );
        }
    }
}

#[test]
fn one_record_per_case_and_adapter() {
    let out = folder();
    let out = out.path().join("new/deep/folder");
    let adapters = ["cpu", "gl:softpipe", "vulkan:lavapipe"];
    let mut arguments = vec!["depth/*"];
    // A repeated name is one adapter.
    for adapter in adapters.iter().chain(&["cpu"]) {
        arguments.extend(["--adapter", adapter]);
    }
    let assert = run(&out, &arguments).code(0);
    assert.stdout(contains("vulkan:lavapipe").and(contains("index.html")));
    let text = fs::read_to_string(out.join("run.jsonl")).unwrap();
    let first: Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    assert_eq!(first["format"], etalon_record::FORMAT);
    assert_eq!(first["command"][0], "etalon");
    let run = whole(&out);
    let found: BTreeSet<&str> = run
        .header
        .adapters
        .iter()
        .map(|a| a.info.name.as_str())
        .collect();
    assert_eq!(found, adapters.into());
    assert_eq!(run.records.len(), 3 * count(&["depth"]));
    for record in &run.records {
        assert!(!record.unexpected(), "{record:?}");
        if record.verdict == Verdict::Pass {
            let asserted: u64 = record.assertions.iter().map(|a| a.asserted).sum();
            assert!(asserted > 0, "{record:?}");
        }
    }
}

#[test]
fn every_adapter_that_is_found_draws_some_cases_as_expected() {
    let output = etalon(&["adapters", "--format", "json"]).assert().code(0);
    let found: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let found: BTreeSet<String> = found
        .as_array()
        .unwrap()
        .iter()
        .map(|a| a["name"].as_str().unwrap().to_owned())
        .collect();
    for name in DUE {
        assert!(found.contains(name), "{name} is not here, only {found:?}");
    }
    let globs = [
        "depth/clear*",
        "depth/compare/*format=depth2*",
        "stencil/clear*",
        "stencil/faces/*compare=equal*",
        "stencil/masks-zero",
        "cull",
        "blend/textbook",
        "blend/write-mask",
        "selftest/*",
    ];
    let out = folder();
    let json = [&globs[..], &["--format", "json"]].concat();
    let assert = run(out.path(), &json).code(0);
    let output: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let run = whole(out.path());
    assert_eq!(output["records"], run.records.len());
    assert_eq!(output["unexpected"], 0);
    assert_eq!(output["improvements"], 0);
    assert_eq!(output["folder"], out.path().to_str().unwrap());
    assert!(Path::new(output["report"].as_str().unwrap()).is_file());
    let ran: BTreeSet<String> = output["adapters"]
        .as_array()
        .unwrap()
        .iter()
        .map(|a| a.as_str().unwrap().to_owned())
        .collect();
    assert_eq!(ran, found);
    assert_eq!(run.records.len(), count(&globs) * found.len());
    for record in &run.records {
        assert!(!record.unexpected(), "{record:?}");
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_and_loses_nothing() {
    let folder = folder();
    let file = folder.path().join("notes");
    fs::write(&file, "precious").unwrap();
    for out in [file.clone(), file.join("below")] {
        let assert = run(&out, &["depth/clear", "--adapter", "cpu"]).code(64);
        assert
            .stdout(is_empty())
            .stderr(contains(file.to_str().unwrap()));
        assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
    }
}

#[test]
fn an_old_run_is_replaced_and_other_files_stay() {
    let out = folder();
    run(out.path(), &["selftest/*", "--adapter", "cpu"]).code(0);
    assert!(out.path().join("frames").is_dir());
    fs::write(out.path().join("notes"), "precious").unwrap();
    // A refused or empty run leaves the old run alone.
    run(out.path(), &["nothing/*"]).code(4);
    run(out.path(), &["depth", "--adapter", "nobody"]).code(64);
    assert_eq!(whole(out.path()).records.len(), count(&["selftest"]));
    let other = ["depth/clear", "--adapter", "cpu"];
    etalon(&["run", "--out"])
        .arg(out.path())
        .args(other)
        .assert()
        .code(64);
    assert_eq!(whole(out.path()).records.len(), count(&["selftest"]));
    run(out.path(), &other).code(0);
    assert_eq!(whole(out.path()).records.len(), count(&["depth/clear"]));
    assert!(!out.path().join("frames").exists());
    assert_eq!(
        fs::read_to_string(out.path().join("notes")).unwrap(),
        "precious"
    );
}

#[test]
fn an_empty_selection_exits_with_4_and_makes_no_folder() {
    let out = folder();
    let out = out.path().join("out");
    run(&out, &["dpeth/*"])
        .code(4)
        .stdout(is_empty())
        .stderr(contains("dpeth/*"));
    assert!(!out.exists());
}

fn expectation(verdict: &str, case: &str) -> Value {
    json!({ "adapter": "cp*", "driver": "*", "case": case, "verdict": verdict,
            "reason": "a test", "evidence": "none" })
}

#[test]
fn expectations_are_compared_with_verdicts() {
    let folder = folder();
    let out = folder.path().join("out");
    let expect = folder.path().join("expect.json");
    let with = |entries: Value| {
        fs::write(&expect, json!({ "entries": entries }).to_string()).unwrap();
        let file = expect.to_str().unwrap();
        run(
            &out,
            &[
                "depth/clear",
                "--profile",
                "full",
                "--adapter",
                "cpu",
                "--expect",
                file,
                "--format",
                "json",
            ],
        )
    };
    // Better than expected.
    let assert = with(json!([expectation("fail", "*format=depth16unorm*")])).code(2);
    let output: Value = serde_json::from_slice(&assert.get_output().stdout).unwrap();
    let better: Vec<Record> = whole(&out)
        .records
        .into_iter()
        .filter(|r| r.improves == Some(Verdict::Fail))
        .collect();
    assert!(!better.is_empty() && better.iter().all(|r| r.case.contains("depth16unorm")));
    assert_eq!(output["improvements"], better.len());
    assert_eq!(output["unexpected"], 0);
    // As expected; the other entries are about other cases.
    with(json!([expectation("pass", "*")])).code(0);
    assert!(whole(&out).records.iter().all(|r| r.expected.is_some()));
    with(json!([expectation("fail", "stencil/*")])).code(0);
    with(json!([])).code(0);
}

#[test]
fn damaged_expectations_name_file_and_line() {
    let folder = folder();
    let out = folder.path().join("out");
    let expect = folder.path().join("expect.json");
    let file = expect.to_str().unwrap();
    let fine =
        serde_json::to_string_pretty(&json!({ "entries": [expectation("fail", "*")] })).unwrap();
    for (from, to, line) in [
        ("\"fail\"", "\"failure\"", 9),
        ("\"case\": \"*\"", "\"case\": \"[\"", 5),
        ("\"reason\"", "\"raeson\"", 8),
        ("\"a test\"", "\"\"", 5),
        ("\"fail\"", "fail", 9),
    ] {
        let text = fine.replacen(from, to, 1);
        assert_ne!(text, fine);
        fs::write(&expect, &text).unwrap();
        let assert = run(&out, &["depth/clear", "--adapter", "cpu", "--expect", file]).code(64);
        let said = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(
            said.contains(&format!("expect.json:{line}: ")),
            "{to}: {said}\n{text}"
        );
        assert!(!out.exists());
    }
    fs::remove_file(&expect).unwrap();
    run(&out, &["depth/clear", "--adapter", "cpu", "--expect", file])
        .code(64)
        .stderr(contains("expect.json"));
}

#[test]
fn a_full_disk_leaves_an_incomplete_run_that_can_be_read() {
    let folder = folder();
    let out = folder.path().join("out");
    // Files cannot grow beyond this many blocks; if the signal is ignored, writing fails.
    let script = r#"trap '' XFSZ; ulimit -f 40; exec "$0" "$@""#;
    Command::new("/bin/sh")
        .args([
            "-c",
            script,
            BINARY,
            "run",
            "stencil/*",
            "--adapter",
            "cpu",
            "--out",
        ])
        .arg(&out)
        .assert()
        .code(3)
        .stderr(contains("incomplete").and(contains("run.jsonl")));
    let run = Run::read(&out).unwrap();
    assert!(!run.records.is_empty());
    assert!(run.missing() > 0);
    etalon(&["report"])
        .arg(&out)
        .assert()
        .code(3)
        .stderr(contains("is incomplete"))
        .stdout(contains("index.html"));
}

/// Starts a run on one adapter and waits until it has written some records.
fn started(out: &Path, adapter: &str) -> Child {
    let mut child = std::process::Command::new(BINARY)
        .args([
            "run",
            "stencil/*",
            "--adapter",
            adapter,
            "--jobs",
            "1",
            "--out",
        ])
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let file = out.join("run.jsonl");
    let start = Instant::now();
    loop {
        let text = fs::read_to_string(&file).unwrap_or_default();
        if text.lines().count() > 5 {
            return child;
        }
        assert!(child.try_wait().unwrap().is_none(), "it ended too early");
        assert!(start.elapsed() < Duration::from_secs(60), "no records come");
        sleep(Duration::from_millis(2));
    }
}

/// Returns the child processes of this process.
fn children(parent: u32) -> Vec<Pid> {
    let mut found = Vec::new();
    for entry in fs::read_dir("/proc").unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let Ok(pid) = name.parse::<i32>() else {
            continue;
        };
        let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        // The name in parentheses can contain anything; state and parent follow it.
        let Some((_, rest)) = stat.rsplit_once(')') else {
            continue;
        };
        let mut fields = rest.split_whitespace();
        let alive = fields.next().is_some_and(|state| state != "Z");
        if alive && fields.next() == Some(&parent.to_string()) {
            found.extend(Pid::from_raw(pid));
        }
    }
    found
}

#[test]
fn a_worker_that_is_killed_once_makes_one_case_flaky() {
    let out = folder();
    let mut child = started(out.path(), "vulkan:lavapipe");
    let workers = children(child.id());
    assert_eq!(workers.len(), 1, "{workers:?}");
    kill_process(workers[0], Signal::KILL).unwrap();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(1));
    let run = whole(out.path());
    assert_eq!(run.records.len(), count(&["stencil"]));
    let (crashes, others): (Vec<&Record>, Vec<&Record>) = run
        .records
        .iter()
        .partition(|r| r.verdict == Verdict::Flaky);
    assert_eq!(crashes.len(), 1);
    let end = crashes[0].process.as_ref().unwrap();
    assert_eq!(end.signal, Some(9));
    assert!(crashes[0].unexpected());
    for record in others {
        assert!(!record.unexpected(), "{record:?}");
    }
}

#[test]
fn a_run_that_is_killed_can_be_read_and_its_workers_end() {
    let out = folder();
    let mut child = started(out.path(), "gl:softpipe");
    let workers = children(child.id());
    assert_eq!(workers.len(), 1, "{workers:?}");
    child.kill().unwrap();
    child.wait().unwrap();
    let run = Run::read(out.path()).unwrap();
    assert!(run.records.len() >= 5 && run.missing() > 0);
    let start = Instant::now();
    while Path::new(&format!("/proc/{}", workers[0].as_raw_nonzero())).exists() {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "the worker stays"
        );
        sleep(Duration::from_millis(20));
    }
    etalon(&["report"])
        .arg(out.path())
        .assert()
        .code(3)
        .stdout(contains("gl:softpipe"));
}

#[test]
fn reports_need_a_run() {
    let folder = folder();
    let path = folder.path().to_str().unwrap();
    etalon(&["report", path])
        .assert()
        .code(64)
        .stderr(contains(path));
    fs::write(folder.path().join("run.jsonl"), "{}\n").unwrap();
    etalon(&["report", path])
        .assert()
        .code(64)
        .stderr(contains("run.jsonl:1"));
}

#[test]
fn a_machine_without_drivers_still_has_the_cpu() {
    // Files that are not libraries come before the real ones on the path.
    let libraries = folder();
    for name in [
        "libvulkan.so.1",
        "libvulkan.so",
        "libEGL.so.1",
        "libEGL.so",
        "libGL.so.1",
        "libGL.so",
        "libGLESv2.so.2",
        "libGLESv2.so",
    ] {
        fs::write(libraries.path().join(name), "").unwrap();
    }
    let bare = |arguments: &[&str]| {
        let mut command = etalon(arguments);
        command.env("LD_LIBRARY_PATH", libraries.path());
        // There is no browser either.
        command.env("PATH", libraries.path());
        command
    };
    let output = bare(&["adapters", "--format", "json"]).assert().code(0);
    let found: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let names: Vec<&Value> = found
        .as_array()
        .unwrap()
        .iter()
        .map(|a| &a["name"])
        .collect();
    assert_eq!(names, ["cpu"]);
    bare(&["adapters"])
        .assert()
        .code(0)
        .stdout(contains("\nUnavailable\n"))
        .stdout(contains("vulkan:lavapipe: no Vulkan loader ("))
        .stdout(contains("gl:softpipe: libEGL.so.1"))
        .stdout(contains("apt-get").not());
    bare(&["adapters", "--remedies"])
        .assert()
        .code(0)
        .stdout(contains("apt-get install mesa-vulkan-drivers"));

    let out = folder();
    let out = out.path();
    bare(&["run", "depth/clear", "--out"])
        .arg(out)
        .assert()
        .code(0)
        .stderr(contains("no graphics driver was found").and(contains("apt-get install")))
        .stderr(contains("unavailable: ").not());
    let run = whole(out);
    assert_eq!(run.records.len(), count(&["depth/clear"]));
    for name in DUE.iter().filter(|name| **name != "cpu") {
        let absent = run.header.absent.iter().find(|a| a.name == *name).unwrap();
        assert!(
            !absent.reason.is_empty() && !absent.remedy.is_empty(),
            "{absent:?}"
        );
    }
    bare(&[
        "run",
        "depth/clear",
        "--adapter",
        "gl:softpipe",
        "--force",
        "--out",
    ])
    .arg(out)
    .assert()
    .code(64)
    .stderr(contains("gl:softpipe").and(contains("apt-get install")));
}

#[test]
fn a_site_is_made_of_a_run_and_replaced_only_when_asked() {
    let folder = tempfile::tempdir().unwrap();
    let (run, to) = (folder.path().join("run"), folder.path().join("site"));
    etalon(&["run", "cull/lines", "--adapter", "cpu", "--out"])
        .arg(&run)
        .assert()
        .code(0);
    let site = || {
        let mut command = etalon(&["site"]);
        command.args([&to, &run]);
        command
    };
    site().assert().code(0).stdout(contains("Site: "));
    let start = std::fs::read_to_string(to.join("index.html")).unwrap();
    for text in [
        "runs/run/index.html#gallery=cull",
        "2 cases on cpu",
        "nothing unexpected",
    ] {
        assert!(start.contains(text), "{text}: {start}");
    }
    site()
        .assert()
        .code(64)
        .stderr(contains("--force replaces it"));
    site().arg("--force").assert().code(0);
    etalon(&["site"]).arg(&to).assert().code(64);
    etalon(&["site"])
        .args([&folder.path().join("other"), &folder.path().join("none")])
        .assert()
        .code(64)
        .stderr(contains("cannot read"));
}

#[test]
fn a_time_limit_leaves_cases_out_and_says_so() {
    let out = TempDir::new().unwrap();
    let adapters = ["cpu", "gl:softpipe", "vulkan:lavapipe"];
    let arguments = adapters.iter().flat_map(|name| ["--adapter", name]);
    let arguments: Vec<&str> = ["--within", "0.6", "--jobs", "1"]
        .into_iter()
        .chain(arguments)
        .collect();
    run(out.path(), &arguments)
        .success()
        .stdout(contains("not drawn within 0.6 s"));
    let run = whole(out.path());
    for adapter in adapters {
        let of = |verdict: &dyn Fn(Verdict) -> bool| {
            let records = run.records.iter().filter(|r| r.adapter == adapter);
            records.filter(|r| verdict(r.verdict)).count()
        };
        assert!(of(&|v| v == Verdict::Skipped) > 0, "{adapter}");
        assert!(of(&Verdict::is_judged) > 0, "{adapter}");
    }
    let skipped = run.records.iter().filter(|r| r.verdict == Verdict::Skipped);
    for record in skipped {
        assert_eq!(message(record), "not drawn within 0.6 s", "{record:?}");
        assert!(!record.unexpected());
    }
}

#[test]
fn a_time_limit_draws_first_the_cases_that_find_most() {
    let out = TempDir::new().unwrap();
    let arguments = ["--within", "600", "--jobs", "1", "--adapter", "cpu"];
    run(out.path(), &[&["blend/*"][..], &arguments].concat()).success();
    let run = whole(out.path());
    let order = include_str!("../../../../cases/order.txt");
    let ranked = order.lines().filter(|id| id.starts_with("blend/"));
    let drawn = run.records.iter().map(|r| r.case.as_str());
    let drawn: Vec<&str> = drawn.filter(|id| id.starts_with("blend/")).collect();
    let ranked: Vec<&str> = ranked.collect();
    assert!(ranked.len() > 10);
    assert_eq!(drawn[..ranked.len()], ranked);
    // Then a case of each file, before any file has its second.
    let files: Vec<&str> = drawn[ranked.len()..]
        .iter()
        .map(|id| etalon_frame::CaseId::new(id).file())
        .collect();
    let of_all: BTreeSet<&str> = files.iter().copied().collect();
    let of_first: BTreeSet<&str> = files[..of_all.len()].iter().copied().collect();
    assert_eq!(of_first, of_all);
}

#[test]
fn a_time_limit_cannot_be_combined_with_an_order_or_a_resume() {
    for other in [&["--shuffle", "1"][..], &["--resume"]] {
        etalon(&["run", "--within", "5"])
            .args(other)
            .assert()
            .code(64)
            .stderr(contains("--within"));
    }
}

#[test]
fn a_run_that_draws_nothing_is_incomplete() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let expect = path("expect.json");
    let entries = json!([expectation("skipped", "cull/points/*")]);
    fs::write(&expect, json!({ "entries": entries }).to_string()).unwrap();
    let adapters = ["--adapter", "cpu", "--adapter", "cpu:slower=1%"];
    let skipped = |out: &str, more: &[&str]| {
        let given = ["cull/points", "--expect", expect.to_str().unwrap()];
        run(&path(out), &[&given, &adapters[..2], more].concat())
    };
    let line = format!("nothing was drawn: {} skipped\n", count(&["cull/points"]));
    skipped("whole", &[]).code(3).stderr(contains(&*line));
    // A shard leaves the decision to the merged run.
    for shard in ["1/2", "2/2"] {
        let out = shard.replace('/', "-");
        skipped(&out, &["--shard", shard])
            .code(0)
            .stderr(contains("nothing was drawn").not());
    }
    let mut merge = etalon(&["merge", "--out"]);
    let merge = merge.arg(path("merged")).args([path("1-2"), path("2-2")]);
    merge.assert().code(3).stderr(contains(&*line));
    // One case that is drawn suffices.
    let given = [
        "cull/points",
        "cull/lines",
        "--expect",
        expect.to_str().unwrap(),
    ];
    run(&path("more"), &[&given, &adapters[..2]].concat())
        .code(0)
        .stderr(contains("drew no case").not());
}

#[test]
fn softpipe_draws_no_multisampling_and_the_run_says_so() {
    let folder = folder();
    let softpipe = ["multisample/*", "--adapter", "gl:softpipe"];
    let assert = run(&folder.path().join("alone"), &softpipe).code(3);
    let text = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("nothing was drawn: "), "{text}");
    let blocked = |record: &&Record| record.verdict == Verdict::Blocked;
    let alone = whole(&folder.path().join("alone"));
    let record = alone.records.iter().find(blocked).unwrap();
    assert!(!record.unexpected(), "{record:?}");
    let by = &record.blocked_by[0];
    assert!(by.starts_with("capabilities/required/samples/"), "{by}");
    // Without the finding, it is news.
    let unknown = [&softpipe[..], &["--expect-only"]].concat();
    run(&folder.path().join("unknown"), &unknown).code(1);
    // With another adapter, the run has drawn something.
    let two = [&softpipe[..], &["--adapter", "cpu"]].concat();
    run(&folder.path().join("two"), &two)
        .code(0)
        .stderr(contains("gl:softpipe drew no case: ").and(contains("nothing was drawn").not()));
}

#[test]
fn cases_that_lack_what_the_version_requires_are_blocked_and_not_unsupported() {
    let folder = folder();
    let out = folder.path().join("out");
    let given = [
        "multisample/mask",
        "depth/compare",
        "--adapter",
        "cpu:limit=one-sample",
    ];
    run(&out, &given).code(1);
    let run = whole(&out);
    let blocked = run.records.iter().filter(|r| r.verdict == Verdict::Blocked);
    let blocked: Vec<&Record> = blocked.collect();
    assert!(!blocked.is_empty());
    for record in blocked {
        assert!(record.unexpected(), "{record:?}");
        let denied = |reason: &Reason| match reason {
            Reason::BlockedByDenial(denial) => matches!(denial.needed, Requirement::Samples(_, 4)),
            _ => false,
        };
        assert!(record.reasons.iter().any(denied), "{record:?}");
        assert!(!record.blocked_by.is_empty(), "{record:?}");
    }
    let drawn = run.records.iter().filter(|r| r.parts().area() == "depth");
    assert!(drawn.clone().count() > 0 && drawn.clone().all(|r| r.verdict == Verdict::Pass));
}

#[test]
fn a_grid_that_is_too_fine_is_judged_as_the_finest_that_can_be() {
    let folder = folder();
    for bits in [13, 25, 63, 64, 65, 128, 192, 255] {
        let adapter = format!("cpu:limit=sub-pixel-bits-{bits}");
        let given = ["depth/compare", "scissor/rect", "--adapter", &adapter];
        let out = folder.path().join(bits.to_string());
        run(&out, &given).code(0);
        assert_eq!(whole(&out).header.adapters[0].limits.sub_pixel_bits, 12);
    }
}

#[test]
fn an_adapter_with_an_impossible_limit_is_refused_with_it() {
    let folder = folder();
    let given = ["cull/points", "--adapter", "cpu:limit=sample-outside"];
    run(&folder.path().join("out"), &given)
        .code(64)
        .stderr(contains("reports sample 0 of 1 at 640/256, 128/256"));
    // A run that was recorded with one is damaged.
    let out = folder.path().join("cpu");
    run(&out, &["cull/points", "--adapter", "cpu"]).code(0);
    let path = out.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    let spoilt = text.replacen("[[128,128]]", "[[640,128]]", 1);
    assert_ne!(spoilt, text);
    fs::write(&path, spoilt).unwrap();
    etalon(&["report"])
        .arg(&out)
        .assert()
        .code(64)
        .stderr(contains("run.jsonl:1: ").and(contains("outside the texel")));
}
