//! `history.om`: samples in the text format of OpenMetrics.

use crate::error::ExportError;
use crate::tables::machine_text;
use crate::written::Written;
use etalon_history::{History, Kind, MachineId, RunId};
use etalon_record::Time;
use std::collections::{BTreeMap, HashSet};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// The number of records.
pub(crate) const RECORDS: &str = "etalon_records";
/// The median frame time.
pub(crate) const FRAME: &str = "etalon_frame_seconds";

/// The times of which medians are written.
const TIMES: [Time; 4] = [Time::Wall, Time::Cpu, Time::Gpu, Time::ReadBack];

pub(crate) fn write(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<Written, ExportError> {
    let path = dir.join("history.om");
    let wrong = ExportError::io(&path);
    let mut out = BufWriter::new(File::create(&path).map_err(&wrong)?);
    let mut rows = 0;

    // Two samples of one series and one time are an error to Prometheus: the later run stands for both.
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
    // The samples of a series stand together.
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

    writeln!(
        out,
        "# TYPE {FRAME} gauge\n# UNIT {FRAME} seconds\n# HELP {FRAME} Median frame time of a bench."
    )
    .map_err(&wrong)?;
    for key in history.series_keys()? {
        let case = history.case_name(key.case)?;
        let mut by_time = BTreeMap::new();
        for point in history.series(&key)? {
            if let Some(run) = history.run(point.run).filter(|r| runs.contains(&r.id)) {
                by_time.insert(run.time(), point.times);
            }
        }
        for time in TIMES {
            let labels = [
                ("adapter", &*key.timeline),
                ("machine", &machine(history, key.machine)),
                ("case", &case),
                ("time", time.name()),
            ]
            .map(|(name, value)| label(name, value))
            .join(",");
            for (at, times) in &by_time {
                if let Some(median) = times.median(time).filter(|m| m.is_finite()) {
                    writeln!(out, "{FRAME}{{{labels}}} {median} {at}").map_err(&wrong)?;
                    rows += 1;
                }
            }
        }
    }
    writeln!(out, "# EOF").map_err(&wrong)?;
    out.flush().map_err(&wrong)?;
    Ok(Written { files: 1, rows })
}

fn machine(history: &History, id: MachineId) -> String {
    history.machine(id).map(machine_text).unwrap_or_default()
}

/// A label with its value in quotes.
fn label(name: &str, value: &str) -> String {
    let value = value
        .replace('\\', "\\\\")
        .replace('"', "\\\"")
        .replace('\n', "\\n");
    format!("{name}=\"{value}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_escaped() {
        assert_eq!(label("a", "b\"c\\d\ne"), r#"a="b\"c\\d\ne""#);
    }
}
