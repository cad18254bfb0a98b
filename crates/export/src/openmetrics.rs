//! `history.om`: samples in the text format of OpenMetrics.

use crate::error::ExportError;
use crate::tables::machine_text;
use crate::written::ExportSize;
use etalon_history::{FrameTimes, History, Kind, MachineId, RunId, SeriesKey};
use etalon_record::Time;
use std::collections::{BTreeMap, HashSet};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The metric of the number of records.
pub(crate) const RECORDS: &str = "etalon_records";
/// The metric of the median frame time.
pub(crate) const FRAME: &str = "etalon_frame_seconds";
/// The metric of the median time of the ruler that was measured with the case.
pub(crate) const RULER: &str = "etalon_ruler_seconds";

/// Samples in ascending time: seconds since 1970, and a value.
type MetricSamples = Vec<(i64, f64)>;

/// The times whose medians are written.
const TIMES: [Time; 4] = [Time::Wall, Time::Cpu, Time::Gpu, Time::ReadBack];

pub(crate) fn write(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let path = dir.join("history.om");
    let wrong = ExportError::io(&path);
    let mut out = BufWriter::new(File::create(&path).map_err(&wrong)?);
    let mut rows = 0;

    // Prometheus refuses two samples of one series at one time, so the later run is used.
    let mut latest: BTreeMap<(&str, MachineId, i64), RunId> = BTreeMap::new();
    let counted = || {
        let runs = history
            .runs()
            .iter()
            .filter(|r| runs.contains(&r.id) && r.kind != Kind::Bench);
        runs.flat_map(|run| history.adapters(run.id).iter().map(move |a| (run, a)))
    };
    for (run, adapter) in counted() {
        latest.insert((&*adapter.timeline, run.machine, run.time()), run.id);
    }
    writeln!(
        out,
        "# TYPE {RECORDS} gauge\n# HELP {RECORDS} Records of a run."
    )
    .map_err(&wrong)?;
    // The samples of a series must be consecutive.
    let mut series: BTreeMap<String, Vec<(i64, u32)>> = BTreeMap::new();
    for (run, adapter) in counted() {
        if latest.get(&(&*adapter.timeline, run.machine, run.time())) != Some(&run.id) {
            continue;
        }
        for tally in history.tallies(adapter)? {
            let labels = [
                ("adapter", &*adapter.timeline),
                ("machine", &machine(history, run.machine)),
                ("area", &tally.area),
                ("verdict", &tally.verdict.to_string()),
                (
                    "unexpected",
                    if tally.unexpected { "true" } else { "false" },
                ),
            ]
            .map(|(name, value)| label(name, value))
            .join(",");
            let sample = (run.time(), tally.records);
            series.entry(labels).or_default().push(sample);
        }
    }
    for (labels, samples) in &series {
        for (time, records) in samples {
            writeln!(out, "{RECORDS}{{{labels}}} {records} {time}").map_err(&wrong)?;
            rows += 1;
        }
    }

    for (metric, help) in [
        (FRAME, "Median frame time of a bench."),
        (
            RULER,
            "Median time of the ruler measured with a case of a bench.",
        ),
    ] {
        writeln!(
            out,
            "# TYPE {metric} gauge\n# UNIT {metric} seconds\n# HELP {metric} {help}"
        )
        .map_err(&wrong)?;
        for key in history.series_keys()? {
            for (labels, samples) in samples(history, &key, runs, metric)? {
                for (time, seconds) in samples {
                    writeln!(out, "{metric}{{{labels}}} {seconds} {time}").map_err(&wrong)?;
                    rows += 1;
                }
            }
        }
    }
    writeln!(out, "# EOF").map_err(&wrong)?;
    out.flush().map_err(&wrong)?;
    Ok(ExportSize { files: 1, rows })
}

/// Returns the samples of one metric in one series, with their labels. Times measured with different rulers
/// are not comparable, so the ruler is one of the labels.
fn samples(
    history: &History,
    key: &SeriesKey,
    runs: &HashSet<RunId>,
    metric: &str,
) -> Result<Vec<(String, MetricSamples)>, ExportError> {
    let case = history.case_name(key.case)?;
    let machine = machine(history, key.machine);
    let mut found = Vec::new();
    for (ruler, points) in history.series_by_ruler(key)? {
        // If two runs have the same time, the later one is used.
        let mut by_time: BTreeMap<i64, FrameTimes> = BTreeMap::new();
        for point in points {
            if let Some(run) = history.run(point.run).filter(|r| runs.contains(&r.id)) {
                by_time.insert(run.time(), point.times);
            }
        }
        let mut labels = vec![
            label("adapter", &key.timeline),
            label("machine", &machine),
            label("case", &case),
        ];
        labels.extend(ruler.map(|ruler| label("ruler", ruler)));
        let labels = labels.join(",");
        let mut push = |labels: String, median: &dyn Fn(&FrameTimes) -> Option<f64>| {
            let values = by_time.iter().filter_map(|(time, times)| {
                Some((*time, median(times).filter(|m| m.is_finite())?))
            });
            found.push((labels, values.collect()));
        };
        if metric == RULER {
            push(labels, &FrameTimes::ruler_median);
            continue;
        }
        for time in TIMES {
            let labels = format!("{labels},{}", label("time", time.name()));
            push(labels, &|times| times.median(time));
        }
    }
    Ok(found)
}

fn machine(history: &History, id: MachineId) -> String {
    history.machine(id).map(machine_text).unwrap_or_default()
}

/// Returns a label with its value in quotes.
fn label(name: &str, value: &str) -> String {
    let value = value
        .replace('\\', "\\\\")
        .replace('"', "\\\"")
        .replace('\n', "\\n")
        .replace(char::is_control, "\u{fffd}");
    format!("{name}=\"{value}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_escaped() {
        assert_eq!(label("a", "b\"c\\d\ne"), r#"a="b\"c\\d\ne""#);
        assert_eq!(label("a", "\0\r"), "a=\"\u{fffd}\u{fffd}\"");
    }
}
