//! `etalon fuzz`, whose groups do not depend on the number of workers, and `etalon mutants --fuzz`.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Run, Verdict};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Draws random scenes. Returns the exit code, the summary and the error output.
fn fuzz(adapter: &str, out: &Path, more: &[&str]) -> (i32, Value, String) {
    let out = out.to_str().unwrap();
    let base = [
        "fuzz",
        "--adapter",
        adapter,
        "--format",
        "json",
        "--out",
        out,
    ];
    let arguments: Vec<&str> = base.iter().chain(more).copied().collect();
    let output = etalon(&arguments).output().unwrap();
    let summary = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    let error = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), summary, error)
}

/// The case files of a search, by name.
fn found(out: &Path) -> BTreeMap<String, String> {
    let files = fs::read_dir(out.join("found")).into_iter().flatten();
    let each = files.map(|file| {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        (name, fs::read_to_string(path).unwrap())
    });
    each.collect()
}

/// Returns the groups in the file, without the folder.
fn groups(out: &Path) -> Vec<Value> {
    let text = fs::read_to_string(out.join("fuzz.jsonl")).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    let mut groups: Vec<Value> = lines
        .filter(|l: &Value| l.get("violation").is_some())
        .collect();
    for group in &mut groups {
        let file = group["file"].as_str().unwrap().rsplit('/').next().unwrap();
        group["file"] = file.into();
    }
    groups
}

#[test]
fn a_failing_scene_is_kept_once_and_fails_again_with_any_number_of_workers() {
    let folder = TempDir::new().unwrap();
    let [first, other] = ["one", "three"].map(|name| folder.path().join(name));
    // Unlike bugs of real drivers, a planted one fails in the same way every time.
    let adapter = "gl:llvmpipe:call-fault=scissor-kept";
    // Without findings, all groups are new.
    let search = |out: &Path, jobs: &str| {
        let more = ["--count", "40", "--jobs", jobs, "--expect-only"];
        fuzz(adapter, out, &more)
    };
    let (code, summary, error) = search(&first, "1");
    assert_eq!(code, 1, "{error}");
    let adapters = summary["adapters"].as_array().unwrap();
    assert_eq!(adapters[0]["scenes"], 40);
    assert!(adapters[0]["pairs"].as_u64().unwrap() > 10_000, "{summary}");
    let (code, _, error) = search(&other, "3");
    assert_eq!(code, 1, "{error}");
    assert_eq!(groups(&first), groups(&other));
    assert_eq!(found(&first), found(&other));

    let groups = groups(&first);
    let count = |key: &str| -> u64 { groups.iter().map(|g| g[key].as_u64().unwrap()).sum() };
    assert_eq!(Value::from(count("count")), adapters[0]["failing"]);
    // Each is a case file that fails.
    let [cases, run] = [first.join("found"), folder.path().join("run")];
    let arguments = [
        "run",
        "--profile",
        "full",
        "--cases",
        cases.to_str().unwrap(),
        "--adapter",
        adapter,
        "--out",
        run.to_str().unwrap(),
    ];
    etalon(&arguments).output().unwrap();
    let records = Run::read(&run).unwrap().records;
    let steady = groups.iter().filter(|g| g["steady"] == true);
    let mut checked = 0;
    for group in steady {
        let id = group["file"].as_str().unwrap().trim_end_matches(".json");
        let record = records.iter().find(|r| r.case == id).unwrap();
        assert!(
            record.verdict.is_violation() || record.verdict == Verdict::InternalError,
            "{id}: {}",
            record.verdict
        );
        checked += 1;
    }
    assert!(checked > 2, "{groups:#?}");
}

#[test]
fn known_bugs_are_named_by_their_findings() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let adapter = "gl:softpipe";
    let search = |more: &[&str]| {
        fuzz(
            adapter,
            &out,
            &[&["--count", "14", "--seed", "32", "--force"], more].concat(),
        )
    };
    let counts = |summary: &Value| {
        let count_of = |key: &str| summary["adapters"][0][key].as_u64().unwrap();
        ["new", "alike", "known"].map(count_of)
    };
    let (code, summary, error) = search(&[]);
    let found = (code, counts(&summary));
    assert_eq!(found, (1, [0, 1, 1]), "{error}\n{summary}");
    let of_match = |name: &str| {
        let mut groups = summary["groups"].as_array().unwrap().iter();
        groups.find(|g| g["known"]["match"] == name).unwrap()
    };
    let text = |group: &Value, folder: &str| {
        let file = group["file"].as_str().unwrap();
        assert!(file.contains(folder), "{file}");
        fs::read_to_string(file).unwrap()
    };
    // One scene shows that points count as back faces, as the finding's cases do.
    let group = of_match("exact");
    let known = &group["known"];
    assert_eq!(known["finding"], "softpipe-facing-points", "{known}");
    let case = known["case"].as_str().unwrap();
    assert!(case.starts_with("cull/points/"), "{known}");
    assert!(groups(&out).iter().any(|g| g["known"] == *known));
    let document: Value = serde_json::from_str(&text(group, "/known/")).unwrap();
    let about = document["about"].as_str().unwrap();
    assert!(about.contains("Known: softpipe-facing-points ("), "{about}");
    // Another scene needs one state in addition to the finding's: it is not excused.
    assert!(text(of_match("alike"), "/found/").contains("Looks like: "));

    // With a finding about other cases both are new.
    let finding = folder.path().join("other.json");
    let text = r#"{ "title": "t", "adapters": ["*"], "driver": "*", "cases": ["depth/compare/*"],
        "grade": "proven", "clause": "c", "evidence": "e" }"#;
    fs::write(&finding, text).unwrap();
    let (code, summary, error) = search(&["--expect-only", "--expect", finding.to_str().unwrap()]);
    let found = (code, counts(&summary));
    assert_eq!(found, (1, [2, 0, 0]), "{error}\n{summary}");
    let groups = summary["groups"].as_array().unwrap();
    assert!(groups.iter().all(|g| g["known"].is_null()), "{groups:?}");

    let base = [
        "fuzz",
        "--adapter",
        adapter,
        "--count",
        "14",
        "--seed",
        "32",
    ];
    let out = ["--force", "--out", out.to_str().unwrap()];
    let output = etalon(&[&base[..], &out].concat()).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for expected in [
        "in 2 groups (0 new, 1 like a finding, 1 known)",
        "\n  known: softpipe-facing-points: softpipe treats points as back-facing in the fragment shader: 1 scene in 1 group\n",
        "\n  looks like: softpipe-",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    let places = ["\n  looks like: ", "\n  known: "].map(|word| text.find(word));
    assert!(places.is_sorted(), "{text}");
}

#[test]
fn the_commonest_groups_are_listed_and_the_others_counted() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().to_str().unwrap();
    let base = [
        "fuzz",
        "--adapter",
        "gl:softpipe",
        "--seed",
        "7",
        "--count",
        "1000",
        "--expect-only",
        "--out",
        out,
        "--force",
    ];
    let output = etalon(&base).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = fs::read_to_string(folder.path().join("fuzz.jsonl")).unwrap();
    let lines = lines
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap());
    let counts: Vec<u64> = lines.filter_map(|line| line["count"].as_u64()).collect();
    assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
    let (listed, others) = counts.split_at(20);
    let scenes: u64 = others.iter().sum();
    assert!(others.len() > 1, "{counts:?}");
    let rest = format!(
        "\n  and {} more groups of {scenes} scenes, in fuzz.jsonl\n",
        others.len()
    );
    assert!(text.contains(&rest), "{rest}{text}");
    assert_eq!(text.matches(" × ").count(), listed.len(), "{text}");
}

#[test]
fn the_rasterizer_passes_all_scenes() {
    let folder = TempDir::new().unwrap();
    let (code, summary, error) = fuzz("cpu", folder.path(), &["--count", "300", "--seed", "7"]);
    assert_eq!(
        (code, &summary["groups"]),
        (0, &serde_json::json!([])),
        "{error}"
    );
    assert!(!folder.path().join("found").exists());
}

#[test]
fn a_scene_that_ends_its_worker_is_kept_and_the_search_continues() {
    let folder = TempDir::new().unwrap();
    let adapter = "cpu:fault=abort@scissor";
    let (code, summary, error) = fuzz(adapter, folder.path(), &["--count", "60"]);
    assert_eq!(code, 1, "{error}");
    assert_eq!(summary["adapters"][0]["scenes"], 60);
    let groups = summary["groups"].as_array().unwrap();
    for group in groups {
        assert_eq!(group["verdict"], "crash");
        assert_eq!(group["steady"], true);
        assert_eq!(group["violation"], "process died by signal 6");
    }
    let group = &groups[0];
    let failing = summary["adapters"][0]["failing"].as_u64().unwrap();
    assert!(failing > 30, "{summary}");
    assert!(
        group["count"].as_u64().unwrap() > failing * 3 / 4,
        "{summary}"
    );
    let sentence = group["sentence"].as_str().unwrap();
    assert!(sentence.contains("about to abort"), "{sentence}");
    // Only the state that ends the process is left.
    let files = found(folder.path());
    assert_eq!(files.len(), groups.len());
    let name = group["file"].as_str().unwrap().rsplit('/').next().unwrap();
    let document: Value = serde_json::from_str(&files[name]).unwrap();
    let draws = &document["scene"]["passes"][0]["draws"];
    let keys: Vec<&String> = draws[0].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["mesh", "scissor", "shader"], "{document}");
    assert_eq!(draws.as_array().unwrap().len(), 1, "{document}");
}

#[test]
fn an_interrupted_search_keeps_what_it_found() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().to_str().unwrap();
    let arguments = [
        "fuzz",
        "--adapter",
        "cpu:fault=abort",
        "--time",
        "10m",
        "--out",
        out,
    ];
    let child = std::process::Command::new(env!("CARGO_BIN_EXE_etalon"))
        .args(arguments)
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    for _ in 0..600 {
        if folder.path().join("found").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    let id = rustix::process::Pid::from_child(&child);
    rustix::process::kill_process(id, rustix::process::Signal::INT).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("interrupted: what was found is kept"),
        "{said}"
    );
    assert!(!groups(folder.path()).is_empty());
}

#[test]
fn a_time_limit_also_holds_for_comparing_with_findings() {
    let folder = TempDir::new().unwrap();
    let begun = std::time::Instant::now();
    let (_, out, error) = fuzz("gl:softpipe", folder.path(), &["--time", "4s"]);
    // Comparing all groups takes half a minute.
    assert!(begun.elapsed().as_secs() < 20, "{out}");
    assert!(error.contains("a longer --time compares all"), "{error}");
}

#[test]
fn earlier_results_and_wrong_flags_are_refused() {
    let folder = TempDir::new().unwrap();
    let out = folder.path();
    let (code, _, error) = fuzz("cpu", out, &["--count", "3"]);
    assert_eq!(code, 0, "{error}");
    let (code, _, error) = fuzz("cpu", out, &["--count", "3"]);
    assert_eq!((code, error.contains("--force")), (64, true), "{error}");
    assert_eq!(fuzz("cpu", out, &["--count", "3", "--force"]).0, 0);
    let (code, _, error) = fuzz("gl:none", out, &["--force"]);
    assert_eq!(
        (code, error.contains("there is no adapter")),
        (64, true),
        "{error}"
    );
    assert_eq!(fuzz("cpu", out, &["--count", "3", "--time", "9"]).0, 64);
    assert_eq!(fuzz("cpu", out, &["--time", "soon"]).0, 64);
    assert_eq!(
        fuzz("cpu", out, &["--force", "--expect", "none.json"]).0,
        64
    );
}

#[test]
fn random_scenes_catch_bugs_and_pass_what_is_legal() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().to_str().unwrap();
    let arguments = [
        "mutants", "--fuzz", "400", "depth/*", "logic/*", "--out", out,
    ];
    let output = etalon(&arguments).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let table = fs::read_to_string(folder.path().join("recall.txt")).unwrap();
    let line = table
        .lines()
        .find(|l| l.starts_with("Without size: "))
        .unwrap();
    let mut numbers = line
        .split(' ')
        .filter_map(|w| w.trim_matches(',').parse::<f64>().ok());
    let [caught, total] = [(); 2].map(|()| numbers.next().unwrap());
    assert!(
        total >= 99.5 && caught > 0.75 * total && caught < total - 0.5,
        "{line}"
    );
}
