//! Files for dashboards.

use crate::bench::figures::Figures;
use crate::error::ReportError;
use crate::numbers::change;
use etalon_record::Time;
use etalon_stats::Summary;
use serde::Serialize;
use std::collections::BTreeMap;

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
    fn new(summary: &Summary) -> Self {
        let ends = summary.interval.map(|i| i.map(nanoseconds));
        Self {
            value: nanoseconds(summary.median),
            lower_value: ends.map(|e| e[0]),
            upper_value: ends.map(|e| e[1]),
        }
    }
}

/// Bencher's latencies are in nanoseconds.
fn nanoseconds(seconds: f64) -> f64 {
    // Thousandths of a nanosecond are no figures of any clock.
    (seconds * 1e12).round() / 1e3
}

/// Bencher's name of a time: `latency` is built in, the others are created by their first use.
fn measure(time: Time) -> String {
    match time {
        Time::Wall => "latency".to_owned(),
        other => format!("{}-time", other.name()),
    }
}

/// `bencher.json`: benchmark to measure to metric, medians in nanoseconds with their intervals.
pub(crate) fn bencher(figures: &Figures<'_>) -> Result<Vec<u8>, ReportError> {
    let mut all: BTreeMap<String, BTreeMap<String, Metric>> = BTreeMap::new();
    for (case, timed) in figures.timed() {
        let measures = all.entry(name(case, timed.adapter())).or_default();
        measures.insert(measure(Time::Wall), Metric::new(&timed.wall));
        for (time, summary) in &timed.others {
            measures.insert(measure(*time), Metric::new(summary));
        }
    }
    json(&all)
}

/// One result of github-action-benchmark's `customSmallerIsBetter`
/// (<https://github.com/benchmark-action/github-action-benchmark>, `BenchmarkResult`).
#[derive(Serialize)]
struct ActionResult {
    name: String,
    unit: &'static str,
    value: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<String>,
    extra: String,
}

/// `benchmark-action.json`: wall medians in nanoseconds. The file has one direction; every time is
/// better when smaller.
pub(crate) fn action(figures: &Figures<'_>) -> Result<Vec<u8>, ReportError> {
    let each = figures.timed().map(|(case, timed)| {
        let s = &timed.wall;
        let reach = |[low, high]: [f64; 2]| (s.median - low).max(high - s.median);
        let visible = s.visible.map_or_else(
            || "no change is visible with so few rounds".to_owned(),
            |v| format!("smallest visible change {}", change(v)),
        );
        ActionResult {
            name: name(case, timed.adapter()),
            unit: "ns",
            value: nanoseconds(s.median),
            range: s.interval.map(|i| format!("± {}", nanoseconds(reach(i)))),
            extra: format!(
                "{} rounds, {} samples, {} discarded as warm-up\np50 {} ns, p95 {} ns\n{visible}",
                s.rounds,
                s.samples,
                timed.record.discarded(),
                nanoseconds(s.p50),
                nanoseconds(s.p95),
            ),
        }
    });
    json(&each.collect::<Vec<_>>())
}

/// Ids and adapters hold no spaces.
fn name(case: &str, adapter: &str) -> String {
    format!("{case} {adapter}")
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, ReportError> {
    let mut text = serde_json::to_vec_pretty(value).map_err(ReportError::Json)?;
    text.push(b'\n');
    Ok(text)
}
