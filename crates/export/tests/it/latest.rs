//! The files for Bencher and github-action-benchmark: the latest times of each series.

use crate::made::{adapter, exported, run, wall};
use etalon_export::{ExportFormat, RunChoice};
use etalon_history::{FrameTimes, NewRun, parse_time};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const BENCHMARK: &str = "perf/a gl:x an OS, a processor, 2 cores";

/// Three nights; the last one timed only another case.
fn nights() -> Vec<NewRun> {
    let night = |number: u8, case: &str, times: FrameTimes| {
        let mut part = adapter("gl:x", "1.0");
        part.times.insert(case.to_owned(), times);
        let mut made = run(number, &format!("2026-01-0{number}"), vec![part]);
        made.machine.os = "an OS".to_owned();
        made
    };
    let second = FrameTimes {
        wall: vec![0.5, 0.25, 1.0, 0.5, 0.75, 0.5, 0.5],
        gpu: vec![0.125],
        ..FrameTimes::default()
    };
    let third = FrameTimes {
        interval: Some([1.5, 2.5]),
        ..wall(&[2.0])
    };
    vec![
        night(1, "perf/a", wall(&[8.0])),
        night(2, "perf/a", second),
        night(3, "methods/b", third),
    ]
}

fn read(out: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(out.join(name)).unwrap()).unwrap()
}

#[test]
fn bencher_has_every_time_with_its_interval() {
    let (out, _dir) = exported(&nights(), ExportFormat::Bencher, &RunChoice::default());
    let measures = read(&out, "bencher.json");
    assert_eq!(measures.as_object().unwrap().len(), 2);
    assert_eq!(
        measures[BENCHMARK],
        json!({
            "latency": {"value": 0.5e9, "lower_value": 0.25e9, "upper_value": 1e9},
            "gpu-time": {"value": 0.125e9},
        })
    );
    assert_eq!(
        measures["methods/b gl:x an OS, a processor, 2 cores"],
        json!({ "latency": {"value": 2e9, "lower_value": 1.5e9, "upper_value": 2.5e9} })
    );
}

#[test]
fn the_action_file_has_wall_times_with_their_ranges() {
    let (out, _dir) = exported(
        &nights(),
        ExportFormat::ActionBenchmark,
        &RunChoice::default(),
    );
    let document = read(&out, "benchmark-action.json");
    let of_case = |name: &str| {
        let entries = document.as_array().unwrap();
        entries
            .iter()
            .find(|entry| entry["name"] == name)
            .unwrap()
            .clone()
    };
    let entry = of_case(BENCHMARK);
    assert_eq!(
        (&entry["unit"], &entry["value"]),
        (&json!("ns"), &json!(0.5e9))
    );
    assert_eq!(entry["range"], "± 500000000");
    let extra = entry["extra"].as_str().unwrap();
    assert!(
        extra.contains("2026-01-02") && extra.contains("1.0"),
        "{extra}"
    );
}

#[test]
fn the_latest_run_is_the_latest_of_those_selected() {
    let selection = RunChoice {
        since: parse_time("2026-01-03"),
        last: None,
    };
    let (out, _dir) = exported(&nights(), ExportFormat::Bencher, &selection);
    let measures = read(&out, "bencher.json");
    assert_eq!(measures.as_object().unwrap().len(), 1);
    assert_eq!(measures.get(BENCHMARK), None);
}
