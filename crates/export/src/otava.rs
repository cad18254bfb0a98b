//! Series of frame times as CSV, and the configuration with which Apache Otava imports them.

use crate::error::ExportError;
use crate::folder::part;
use crate::tables::machine_text;
use crate::written::ExportSize;
use etalon_history::{History, RunId, SeriesKey, TimePoint, format_time};
use etalon_record::Time;
use serde_json::json;
use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// The columns of times.
const TIMES: [(&str, Time); 4] = [
    ("wall", Time::Wall),
    ("cpu", Time::Cpu),
    ("gpu", Time::Gpu),
    ("read_back", Time::ReadBack),
];

pub(crate) fn write(
    history: &History,
    runs: &HashSet<RunId>,
    dir: &Path,
) -> Result<ExportSize, ExportError> {
    let mut written = ExportSize::default();
    let mut tests = serde_json::Map::new();
    let mut place = 0;
    for key in history.series_keys()? {
        let case = history.case_name(key.case)?;
        for (ruler, points) in history.series_by_ruler(&key)? {
            let (csv, rows) = table(history, runs, &key, points);
            if rows == 0 {
                continue;
            }
            let name = format!("{}-{place}.csv", part(&case, place));
            place += 1;
            let path = dir.join(&name);
            fs::write(&path, csv).map_err(ExportError::io(&path))?;
            written.files += 1;
            written.rows += rows;
            let machine = history.machine(key.machine).map(machine_text);
            let machine = machine.unwrap_or_default();
            let ruler = ruler.map_or(String::new(), |ruler| format!(", ruler {ruler}"));
            let title = format!("{case} {} {machine}{ruler}", key.timeline);
            let metrics: serde_json::Map<_, _> = TIMES
                .iter()
                .map(|(column, _)| {
                    let metric = json!({"column": column, "direction": -1});
                    ((*column).to_owned(), metric)
                })
                .collect();
            let test = json!({
                "type": "csv",
                "file": name,
                "time_column": "time",
                "attributes": ["commit", "version"],
                "metrics": metrics,
            });
            tests.insert(title, test);
        }
    }
    // JSON is valid YAML.
    let path = dir.join("otava.yaml");
    let text = format!("{:#}\n", json!({"tests": tests}));
    fs::write(&path, text).map_err(ExportError::io(&path))?;
    written.files += 1;
    Ok(written)
}

/// Returns the text of a file and its number of rows.
fn table(
    history: &History,
    runs: &HashSet<RunId>,
    key: &SeriesKey,
    points: Vec<TimePoint>,
) -> (String, u64) {
    let mut csv = String::from("time,commit,version,wall,cpu,gpu,read_back,ruler\n");
    let mut rows = 0;
    for point in points {
        let Some(run) = history.run(point.run).filter(|r| runs.contains(&r.id)) else {
            continue;
        };
        let adapter = history.adapter(run.id, &key.timeline);
        let commit = run.commit.as_deref().unwrap_or_default();
        let version = adapter.map_or("", |a| a.adapter.shown_version());
        let _ = write!(
            csv,
            "{},{},{}",
            format_time(run.time()),
            field(commit),
            field(version)
        );
        let times = TIMES.map(|(_, time)| point.times.median(time));
        for value in times.into_iter().chain([point.times.ruler_median()]) {
            csv.push(',');
            if let Some(value) = value {
                let _ = write!(csv, "{value}");
            }
        }
        csv.push('\n');
        rows += 1;
    }
    (csv, rows)
}

/// Returns a CSV field, quoted if necessary. A field can hold line ends, but no other control characters (RFC 4180).
fn field(text: &str) -> String {
    let is_forbidden = |c: char| c.is_control() && !matches!(c, '\n' | '\r');
    let text = text.replace(is_forbidden, "\u{fffd}");
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_quoted() {
        assert_eq!(field("a"), "a");
        assert_eq!(field("a,\"b\"\n\0"), "\"a,\"\"b\"\"\n\u{fffd}\"");
    }
}
