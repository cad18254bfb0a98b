//! Bencher's format.

use crate::benchmark::{Benchmark, Figure, file, nanoseconds};
use etalon_record::Time;
use serde::Serialize;
use std::collections::BTreeMap;

/// The name of Bencher's file in a folder.
pub const BENCHER_FILE: &str = "bencher.json";

/// One metric of Bencher's format (<https://bencher.dev/docs/reference/bencher-metric-format>).
#[derive(Serialize)]
struct Metric {
    value: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    lower_value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    upper_value: Option<f64>,
}

impl Metric {
    fn new(figure: &Figure) -> Self {
        let ends = figure.interval.map(|i| i.map(nanoseconds));
        Self {
            value: nanoseconds(figure.median),
            lower_value: ends.map(|e| e[0]),
            upper_value: ends.map(|e| e[1]),
        }
    }
}

/// Returns Bencher's name of a time. `latency` is built in; first use creates the others.
fn measure(time: Time) -> String {
    match time {
        Time::Wall => "latency".to_owned(),
        other => format!("{}-time", other.name()),
    }
}

/// Returns a map from benchmark to measure to metric: medians in nanoseconds, with their intervals.
///
/// # Errors
/// If a value has no JSON form.
pub fn bencher(benchmarks: &[Benchmark]) -> serde_json::Result<Vec<u8>> {
    let mut by_benchmark: BTreeMap<&str, BTreeMap<String, Metric>> = BTreeMap::new();
    for benchmark in benchmarks {
        let measures = by_benchmark.entry(&benchmark.name).or_default();
        for (time, figure) in &benchmark.times {
            measures.insert(measure(*time), Metric::new(figure));
        }
    }
    file(&by_benchmark)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wall_times_are_latencies_and_missing_intervals_have_no_bounds() {
        let figure = |median, interval| Figure { median, interval };
        let times = [
            (Time::Wall, figure(0.5, Some([0.25, 1.0]))),
            (Time::Gpu, figure(1.5e-12, None)),
        ];
        let benchmark = Benchmark {
            name: "a b".to_owned(),
            times: times.into(),
            extra: String::new(),
        };
        let text = String::from_utf8(bencher(&[benchmark]).unwrap()).unwrap();
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        let expected = serde_json::json!({ "a b": {
            "latency": { "value": 5e8, "lower_value": 2.5e8, "upper_value": 1e9 },
            "gpu-time": { "value": 0.002 },
        }});
        assert_eq!(value, expected);
        assert!(text.ends_with("}\n"));
    }
}
