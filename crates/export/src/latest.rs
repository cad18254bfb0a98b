//! The latest times of each series, for services that keep their own history.

use crate::error::ExportError;
use crate::tables::machine_text;
use crate::written::ExportSize;
use etalon_dashboards::{ACTION_FILE, BENCHER_FILE, Benchmark, Figure, action, bencher};
use etalon_history::{AdapterRun, History, RunId, RunInfo, SeriesKey, TimePoint};
use etalon_record::Time;
use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::Path;

/// Writes `bencher.json`: every time in Bencher's metric format.
pub(crate) fn write_bencher(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let benches = some(history, benchmarks(history, runs)?)?;
    write(dir, BENCHER_FILE, benches.len(), bencher(&benches))
}

/// Writes `benchmark-action.json`: wall times for github-action-benchmark's `customSmallerIsBetter`.
pub(crate) fn write_action(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let mut benches = benchmarks(history, runs)?;
    benches.retain(|benchmark| benchmark.times.contains_key(&Time::Wall));
    let benches = some(history, benches)?;
    write(dir, ACTION_FILE, benches.len(), action(&benches))
}

/// Returns the benchmarks, or an error without any.
fn some(history: &History, benches: Vec<Benchmark>) -> Result<Vec<Benchmark>, ExportError> {
    if benches.is_empty() {
        return Err(ExportError::NoTimes {
            path: history.path().to_owned(),
        });
    }
    Ok(benches)
}

/// Returns the times of each series in the latest of these runs that has the series.
fn benchmarks(history: &History, runs: &HashSet<RunId>) -> Result<Vec<Benchmark>, ExportError> {
    let mut benches = Vec::new();
    for key in history.series_keys()? {
        let points = history.series(&key)?;
        let Some(point) = points.iter().rfind(|p| runs.contains(&p.run)) else {
            continue;
        };
        let times = Time::ALL.into_iter().filter_map(|time| {
            let seconds = point.times.point(time)?;
            let figure = Figure {
                median: seconds.median,
                interval: seconds.interval,
            };
            Some((time, figure))
        });
        let times: BTreeMap<Time, Figure> = times.collect();
        if times.is_empty() {
            continue;
        }
        let run = history.run(point.run);
        let adapter = history.adapter(point.run, &key.timeline);
        let extra = run.zip(adapter);
        benches.push(Benchmark {
            name: name(history, &key)?,
            times,
            extra: extra.map_or(String::new(), |(run, adapter)| {
                extra_text(run, adapter, point)
            }),
        });
    }
    Ok(benches)
}

/// Returns a benchmark's name. Machines differ in speed, so each machine has its own benchmark.
fn name(history: &History, key: &SeriesKey) -> Result<String, ExportError> {
    let machine = history.machine(key.machine).map(machine_text);
    let (case, machine) = (history.case_name(key.case)?, machine.unwrap_or_default());
    Ok(format!("{case} {} {machine}", key.timeline))
}

fn extra_text(run: &RunInfo, adapter: &AdapterRun, point: &TimePoint) -> String {
    let commit = run.commit.as_deref().unwrap_or("unknown");
    let version = adapter.adapter.shown_version();
    format!(
        "run {} of {}\ndriver {version}, suite {commit}\n{} rounds, {} frames",
        run.id,
        run.day(),
        point.times.wall.len(),
        point.times.frames
    )
}

fn write(
    dir: &Path,
    name: &str,
    rows: usize,
    bytes: serde_json::Result<Vec<u8>>,
) -> Result<ExportSize, ExportError> {
    let path = dir.join(name);
    let bytes = bytes.map_err(|source| ExportError::Json {
        path: path.clone(),
        source,
    })?;
    fs::write(&path, bytes).map_err(ExportError::io(&path))?;
    Ok(ExportSize {
        files: 1,
        rows: rows as u64,
    })
}
