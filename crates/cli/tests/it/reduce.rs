//! `etalon reduce`: reduced cases, and messages about cases that cannot be reduced.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Run, Verdict};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Reduces a case. Returns the exit code, the summary and the error output.
fn reduce(case: &str, adapter: &str, out: &Path) -> (i32, Value, String) {
    reduce_with(case, adapter, out, &[])
}

/// The same with further arguments.
fn reduce_with(case: &str, adapter: &str, out: &Path, more: &[&str]) -> (i32, Value, String) {
    let out = out.to_str().unwrap();
    let base = [
        "reduce",
        case,
        "--adapter",
        adapter,
        "--format",
        "json",
        "--out",
        out,
    ];
    let arguments = [&base, more].concat();
    let output = etalon(&arguments).output().unwrap();
    let summary = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    let error = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), summary, error)
}

/// Reduces a case, and checks that the reduced case file fails in the same way.
fn reduced(case: &str, adapter: &str) -> (Value, Value) {
    let folder = TempDir::new().unwrap();
    let cases = folder.path().join("cases");
    let (code, summary, error) = reduce(case, adapter, &cases);
    assert_eq!(code, 0, "{case} on {adapter}: {error}");
    let text = fs::read_to_string(summary["file"].as_str().unwrap()).unwrap();
    let document: Value = serde_json::from_str(&text).unwrap();

    let number = |key: &str, index: usize| summary[key][index].as_u64().unwrap();
    assert!(number("keys", 1) <= number("keys", 0), "{summary}");
    assert!(number("values", 1) <= number("values", 0), "{summary}");
    assert!(summary["draws"].as_u64().unwrap() <= 1000, "{summary}");
    let about = document["about"].as_str().unwrap();
    assert!(
        about.contains(case) && about.contains("Violated: "),
        "{about}"
    );

    // The same attachment and aspect, and no new operation.
    let parts = |key: &str| {
        let text = summary[key].as_str().unwrap();
        let (place, operations) = text.split_once(" (").unwrap_or((text, ""));
        let operations = operations.trim_end_matches(')').split(", ");
        (
            place.to_owned(),
            operations.map(str::to_owned).collect::<Vec<_>>(),
        )
    };
    let ((place, before), (same, after)) = (parts("first_violation"), parts("violation"));
    assert_eq!(place, same);
    assert!(
        after.iter().all(|o| before.contains(o)),
        "{before:?} {after:?}"
    );

    let out = folder.path().join("run");
    let folders = [&cases, &out].map(|p| p.to_str().unwrap().to_owned());
    let arguments = [
        "run",
        "--profile",
        "full",
        "--cases",
        &folders[0],
        "--adapter",
        adapter,
        "--out",
        &folders[1],
    ];
    etalon(&arguments).output().unwrap();
    let run = Run::read(&out).unwrap();
    let records: Vec<_> = run.records.iter().collect();
    assert_eq!(records.len(), 1, "{case}");
    assert_eq!(records[0].verdict, Verdict::Fail, "{case} on {adapter}");
    (summary, document)
}

/// Returns the draws of a document.
fn draws(document: &Value) -> Vec<&Value> {
    let passes = document["scene"]["passes"].as_array().unwrap();
    let lists = passes.iter().map(|p| p["draws"].as_array().unwrap());
    lists.flatten().collect()
}

#[test]
fn a_random_scene_is_reduced_to_the_state_that_the_driver_gets_wrong() {
    let (summary, document) = reduced("combined/extended/seed=16", "gl:softpipe");
    let left = draws(&document);
    assert_eq!(left.len(), 1, "{document}");
    let keys: Vec<&String> = left[0].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["logic", "mesh", "shader"]);
    assert_eq!(
        summary["violation"],
        "color of color (logic operation, store color)"
    );
    let values = &summary["values"];
    let dropped = 1.0 - values[1].as_f64().unwrap() / values[0].as_f64().unwrap();
    assert!(dropped >= 0.95, "{summary}");

    let (summary, document) = reduced("combined/extended/seed=104", "gl:softpipe");
    assert_eq!(draws(&document).len(), 1, "{document}");
    assert_eq!(draws(&document)[0]["depth_clamp"], true);
    let clause = summary["clause"].as_str().unwrap();
    assert!(clause.contains("Depth Buffer Test"), "{clause}");
}

#[test]
fn a_reduction_is_deterministic() {
    let [first, other] = [(); 2].map(|()| {
        let folder = TempDir::new().unwrap();
        let (code, summary, error) =
            reduce("combined/extended/seed=16", "gl:es:softpipe", folder.path());
        if code != 0 {
            return (json!(code), json!(error.contains("does not support")));
        }
        let text = fs::read_to_string(summary["file"].as_str().unwrap()).unwrap();
        (json!(text), summary["draws"].clone())
    });
    assert_eq!(first, other);
}

#[test]
fn every_kind_of_violation_is_kept() {
    for (case, violation, state) in [
        ("selftest/logic/judged=or", "color of color (", "logic"),
        ("selftest/logic/judged=copy", "color of color (", "logic"),
        (
            "selftest/scissor/judged=right",
            "color of color (clear, scissor)",
            "scissor",
        ),
        ("selftest/resolve", "color of resolved (resolve)", "resolve"),
        (
            "selftest/counter/right=8",
            "counter samples-passed counts too much",
            "counters",
        ),
        (
            "selftest/counter-runs",
            "counter shader-runs counts too little",
            "early_tests",
        ),
        ("selftest/relation-frames", "relation repeat", "relation"),
    ] {
        let (summary, document) = reduced(case, "cpu");
        let found = summary["violation"].as_str().unwrap();
        assert!(found.starts_with(violation), "{case}: {found}");
        assert!(document.to_string().contains(state), "{case}: {document}");
    }
}

#[test]
fn the_state_that_a_driver_gets_wrong_stays() {
    let case = "sequence/state/scissor/across=draw/first=none/then=left";
    let (_, document) = reduced(case, "gl:softpipe:call-fault=scissor-kept");
    let left = draws(&document);
    assert!(
        left.iter().any(|d| d.get("scissor").is_some()),
        "{document}"
    );
    assert!(left.iter().all(|d| d.get("blend").is_none()), "{document}");
}

#[test]
fn a_case_that_ends_its_worker_is_reduced_to_what_ends_it() {
    let case = "sequence/state/scissor/across=draw/first=none/then=left";
    for (fault, verdict, symptom) in [
        ("abort", Verdict::Crash, "process died by signal 6"),
        ("exit", Verdict::Crash, "process died with exit status 7"),
        ("hang", Verdict::Timeout, "no answer"),
        ("garbage", Verdict::Crash, "invalid message"),
        ("lost", Verdict::DeviceLost, "the device was lost"),
        (
            "refused",
            Verdict::ResourceError,
            "the driver refused a buffer",
        ),
        ("panic", Verdict::InternalError, "the backend panicked"),
    ] {
        let folder = TempDir::new().unwrap();
        let cases = folder.path().join("cases");
        let adapter = format!("cpu:fault={fault}@scissor");
        let more: &[&str] = match fault {
            "hang" => &["--timeout", "0.5"],
            _ => &[],
        };
        let (code, summary, error) = reduce_with(case, &adapter, &cases, more);
        assert_eq!(code, 0, "{fault}: {error}");
        for key in ["first_violation", "violation"] {
            let violation = summary[key].as_str().unwrap();
            assert!(violation.contains(symptom), "{fault}: {violation}");
        }
        assert!(summary["draws"].as_u64().unwrap() <= 200, "{summary}");
        let text = fs::read_to_string(summary["file"].as_str().unwrap()).unwrap();
        let document: Value = serde_json::from_str(&text).unwrap();
        let about = document["about"].as_str().unwrap();
        assert!(about.contains(&format!("Ends by {verdict}")), "{about}");
        let left = draws(&document);
        assert_eq!(left.len(), 1, "{fault}: {document}");
        let keys: Vec<&String> = left[0].as_object().unwrap().keys().collect();
        assert_eq!(keys, ["mesh", "scissor", "shader"], "{fault}");
    }
}

#[test]
fn a_case_that_passes_is_not_reduced() {
    let folder = TempDir::new().unwrap();
    let (code, _, error) = reduce("combined/common/seed=0", "cpu", folder.path());
    assert_eq!(code, 4, "{error}");
    assert!(error.contains("does not fail on cpu"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let (code, _, error) = reduce("combined/common/seed=none", "cpu", folder.path());
    assert_eq!(
        (code, error.contains("there is no case")),
        (64, true),
        "{error}"
    );
    let (code, _, error) = reduce("combined/common/seed=0", "gl:none", folder.path());
    assert_eq!(
        (code, error.contains("there is no adapter")),
        (64, true),
        "{error}"
    );
}

#[test]
fn a_flaky_failure_is_distinguished_from_a_steady_one() {
    // One scene in eight fails, in about half of all processes.
    let folder = TempDir::new().unwrap();
    let flaky = (0..60).any(|seed| {
        let case = format!("combined/common/seed={seed}");
        let (code, _, error) = reduce(&case, "cpu:fault=flaky", folder.path());
        if code == 1 {
            // Four processes in a row can fail, and the next one pass.
            let flaky = error.contains("is flaky on cpu:fault=flaky");
            assert!(flaky || error.contains("drawn alone it is pass"), "{error}");
            return flaky;
        }
        false
    });
    assert!(flaky);
}

#[test]
fn a_reduced_case_can_be_reduced_again_from_its_folder() {
    let folder = TempDir::new().unwrap();
    let (code, first, error) = reduce("combined/extended/seed=16", "gl:softpipe", folder.path());
    assert_eq!(code, 0, "{error}");
    let path = Path::new(first["file"].as_str().unwrap());
    let id = path.file_stem().unwrap().to_str().unwrap();
    let other = TempDir::new().unwrap();
    let (cases, out) = (folder.path(), other.path());
    let arguments = [
        "reduce",
        id,
        "--adapter",
        "gl:softpipe",
        "--cases",
        cases.to_str().unwrap(),
        "--format",
        "json",
        "--out",
        out.to_str().unwrap(),
    ];
    let output = etalon(&arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let again: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(again["keys"][0], again["keys"][1]);
    assert_eq!(again["states"], first["states"]);
}
