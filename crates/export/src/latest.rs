//! The latest times of each series, for services that keep a history of their own.

use crate::error::ExportError;
use crate::tables::machine_text;
use crate::written::Written;
use etalon_history::{FrameTimes, History, RunId};
use etalon_record::Time;
use serde_json::{Map, Value, json};
use std::collections::HashSet;
use std::fs;
use std::path::Path;

/// `bencher.json`: medians in nanoseconds in Bencher's metric format.
pub(crate) fn bencher(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<Written, ExportError> {
    let mut all = Map::new();
    each(history, runs, |name, times| {
        let mut measures = Map::new();
        for time in [Time::Wall, Time::Cpu, Time::Gpu, Time::ReadBack] {
            if let Some(median) = times.median(time) {
                let measure = match time {
                    Time::Wall => "latency".to_owned(),
                    other => format!("{}-time", other.name()),
                };
                measures.insert(measure, json!({"value": nanoseconds(median)}));
            }
        }
        all.insert(name, measures.into());
    })?;
    write(dir, "bencher.json", all.len(), &all.into())
}

/// `benchmark-action.json`: wall medians in nanoseconds for github-action-benchmark's `customSmallerIsBetter`.
pub(crate) fn action(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<Written, ExportError> {
    let mut all = Vec::new();
    each(history, runs, |name, times| {
        if let Some(median) = times.median(Time::Wall) {
            all.push(json!({"name": name, "unit": "ns", "value": nanoseconds(median)}));
        }
    })?;
    write(dir, "benchmark-action.json", all.len(), &all.into())
}

fn each(
    history: &History,
    runs: &HashSet<RunId>,
    mut each: impl FnMut(String, &FrameTimes),
) -> Result<(), ExportError> {
    for key in history.series_keys()? {
        let points = history.series(&key)?;
        let Some(point) = points.iter().rfind(|p| runs.contains(&p.run)) else {
            continue;
        };
        let machine = history.machine(key.machine).map(machine_text);
        let (case, machine) = (history.case_name(key.case)?, machine.unwrap_or_default());
        each(format!("{case} {} {machine}", key.timeline), &point.times);
    }
    Ok(())
}

fn nanoseconds(seconds: f64) -> f64 {
    (seconds * 1e12).round() / 1e3
}

fn write(dir: &Path, name: &str, rows: usize, value: &Value) -> Result<Written, ExportError> {
    let path = dir.join(name);
    fs::write(&path, format!("{value:#}\n")).map_err(ExportError::io(&path))?;
    Ok(Written {
        files: 1,
        rows: rows as u64,
    })
}
