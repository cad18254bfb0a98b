//! The format of github-action-benchmark.

use crate::benchmark::{Benchmark, file, nanoseconds};
use etalon_record::Time;
use serde::Serialize;

/// The name of github-action-benchmark's file in a folder.
pub const ACTION_FILE: &str = "benchmark-action.json";

/// One result of github-action-benchmark's `customSmallerIsBetter`
/// (<https://github.com/benchmark-action/github-action-benchmark>, `BenchmarkResult`).
#[derive(Serialize)]
struct ActionResult<'a> {
    name: &'a str,
    unit: &'static str,
    value: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<String>,
    #[serde(skip_serializing_if = "str::is_empty")]
    extra: &'a str,
}

/// Returns wall medians in nanoseconds. The format has one direction for all results; smaller times are
/// better.
///
/// # Errors
/// If a value has no JSON form.
pub fn action(benchmarks: &[Benchmark]) -> serde_json::Result<Vec<u8>> {
    let each = benchmarks.iter().filter_map(|benchmark| {
        let wall = benchmark.times.get(&Time::Wall)?;
        let reach = |[low, high]: [f64; 2]| (wall.median - low).max(high - wall.median);
        Some(ActionResult {
            name: &benchmark.name,
            unit: "ns",
            value: nanoseconds(wall.median),
            range: wall
                .interval
                .map(|i| format!("± {}", nanoseconds(reach(i)))),
            extra: &benchmark.extra,
        })
    });
    file(&each.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::benchmark::Figure;

    #[test]
    fn the_range_reaches_to_the_farther_end_of_the_interval() {
        let benchmark = |name: &str, time, interval| Benchmark {
            name: name.to_owned(),
            times: [(
                time,
                Figure {
                    median: 0.5,
                    interval,
                },
            )]
            .into(),
            extra: String::new(),
        };
        let benchmarks = [
            benchmark("a", Time::Wall, Some([0.25, 0.625])),
            benchmark("b", Time::Wall, None),
            benchmark("c", Time::Gpu, None),
        ];
        let value: serde_json::Value =
            serde_json::from_slice(&action(&benchmarks).unwrap()).unwrap();
        let expected = serde_json::json!([
            { "name": "a", "unit": "ns", "value": 5e8, "range": "± 250000000" },
            { "name": "b", "unit": "ns", "value": 5e8 },
        ]);
        assert_eq!(value, expected);
    }
}
