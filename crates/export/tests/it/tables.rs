//! Parquet, read back by the format's own reader: each value of each column.

use crate::made::{HOSTILE, daily, exported, files, machine, middle, selected, time};
use crate::random::{runs, selections};
use etalon_export::{ExportFormat, RunChoice};
use etalon_history::{NewAdapter, NewRun, format_time};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::Field;
use proptest::prelude::*;
use std::fs::File;
use std::path::Path;

/// The columns of a row, in their order.
type Row = Vec<(String, Field)>;

fn text(text: &str) -> Field {
    Field::Str(text.to_owned())
}

fn number(value: Option<f64>) -> Field {
    value.map_or(Field::Null, Field::Double)
}

fn row<const N: usize>(fields: [(&str, Field); N]) -> Row {
    let named = fields.into_iter();
    named
        .map(|(name, field)| (name.to_owned(), field))
        .collect()
}

/// The columns that both tables begin with.
fn shared(run: &NewRun, part: &NewAdapter) -> Row {
    let digest: String = run.digest.iter().map(|b| format!("{b:02x}")).collect();
    row([
        ("run", text(&digest)),
        ("time", Field::Long(time(run))),
        ("kind", text(run.kind.name())),
        ("etalon", text(&run.etalon)),
        ("profile", text(run.profile.as_deref().unwrap_or_default())),
        ("commit", text(run.commit.as_deref().unwrap_or_default())),
        ("machine", text(&machine(run))),
        ("labels", text(&serde_json::to_string(&run.labels).unwrap())),
        ("name", text(&part.adapter.info.name)),
        ("driver", text(&part.adapter.info.driver)),
        ("version", text(part.adapter.shown_version())),
    ])
}

/// The rows of `records` that these runs make, each with the folder of its file.
fn records(runs: &[&NewRun]) -> Vec<(String, Row)> {
    let mut rows = Vec::new();
    for run in runs {
        for part in &run.adapters {
            for (case, outcome) in &part.outcomes {
                let method = outcome.measures.method.as_ref();
                let mut fields = shared(run, part);
                let area = case.split('/').next().unwrap();
                let reason = outcome.expected.as_deref();
                fields.extend(row([
                    ("area", text(area)),
                    ("case", text(case)),
                    ("verdict", text(outcome.verdict.name())),
                    ("expected", Field::Bool(reason.is_some())),
                    ("unexpected", Field::Bool(outcome.unexpected())),
                    ("expectation", text(reason.unwrap_or_default())),
                    ("inferred", Field::Bool(outcome.inferred)),
                    ("asserted_share", number(outcome.asserted_share())),
                    ("rmse", number(method.map(|m| m.rmse.into()))),
                    ("max_error", number(method.map(|m| m.max.into()))),
                    ("flip", number(method.map(|m| m.flip.into()))),
                    ("wrong_share", number(method.map(|m| m.wrong.into()))),
                ]));
                let day = format_time(time(run));
                rows.push((format!("{} {}", &day[..10], part.timeline), fields));
            }
        }
    }
    rows
}

/// The rows of `frame_times` that these runs make.
fn frame_times(runs: &[&NewRun]) -> Vec<(String, Row)> {
    let mut rows = Vec::new();
    for run in runs {
        for part in &run.adapters {
            for (case, times) in &part.times {
                let mut fields = shared(run, part);
                fields.extend(row([
                    ("case", text(case)),
                    ("frames", Field::Long(times.frames.into())),
                    ("wall", number(middle(&times.wall))),
                    ("cpu", number(middle(&times.cpu))),
                    ("gpu", number(middle(&times.gpu))),
                    ("read_back", number(middle(&times.read_back))),
                    ("ruler", number(middle(&times.ruler))),
                ]));
                rows.push((part.timeline.clone(), fields));
            }
        }
    }
    rows
}

/// The values of the partitions of a path, as readers of Hive partitions take them.
fn partitions(path: &Path) -> String {
    let parts = path
        .iter()
        .filter_map(|part| part.to_str()?.split_once('='));
    let values: Vec<String> = parts.map(|(_, value)| decoded(value)).collect();
    values.join(" ")
}

/// Decodes a text in which `%` and two digits encode a byte.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let digits: Vec<u8> = rest.by_ref().take(2).collect();
                u8::from_str_radix(str::from_utf8(&digits).unwrap(), 16).unwrap()
            }
            other => other,
        });
    }
    String::from_utf8(bytes).unwrap()
}

/// All rows of the files of a table, each with the partitions of its file.
fn read(out: &Path, table: &str) -> Vec<(String, Row)> {
    let folder = out.join(table);
    let mut rows = Vec::new();
    if !folder.exists() {
        return rows;
    }
    for path in files(&folder).keys() {
        let place = partitions(path.strip_prefix(out).unwrap());
        let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
        for read in reader.get_row_iter(None).unwrap() {
            let read = read.unwrap();
            let columns = read.get_column_iter();
            let columns = columns.map(|(name, field)| (name.clone(), field.clone()));
            rows.push((place.clone(), columns.collect()));
        }
    }
    rows
}

fn sorted(mut rows: Vec<(String, Row)>) -> Vec<(String, Row)> {
    rows.sort_by_cached_key(|row| format!("{row:?}"));
    rows
}

#[test]
fn an_exported_row_has_the_values_of_its_record() {
    let (out, _dir) = exported(
        &daily(&["2026-01-01"]),
        ExportFormat::Parquet,
        &RunChoice::default(),
    );
    let rows = read(&out, "records");
    let value = |verdict: &str, name: &str| {
        let has = |(_, row): &&(String, Row)| row.contains(&("verdict".to_owned(), text(verdict)));
        let (_, row) = rows.iter().find(has).unwrap();
        let found = row.iter().find(|(column, _)| column == name);
        found.unwrap().1.clone()
    };
    let yes = Field::Bool(true);
    for (name, fail, pass) in [
        (
            "time",
            Field::Long(1_767_225_600),
            Field::Long(1_767_225_600),
        ),
        ("area", text("perf"), text("depth")),
        ("case", text(&format!("perf/{HOSTILE}")), text("depth/a")),
        ("expected", yes, Field::Bool(false)),
        ("unexpected", Field::Bool(false), Field::Bool(false)),
        ("expectation", text("known \"bug\""), text("")),
        ("commit", text(""), text("")),
        ("version", text("1.0"), text("1.0")),
        ("asserted_share", Field::Double(0.25), Field::Null),
        ("rmse", Field::Null, Field::Double(0.5)),
        ("max_error", Field::Null, Field::Double(0.75)),
        ("flip", Field::Null, Field::Double(0.25)),
        ("wrong_share", Field::Null, Field::Double(0.125)),
    ] {
        assert_eq!(value("fail", name), fail, "{name}");
        assert_eq!(value("pass", name), pass, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn exported_tables_hold_what_was_added(runs in runs(), selection in selections()) {
        let chosen = selected(&runs, &selection);
        prop_assume!(!chosen.is_empty());
        let (out, _dir) = exported(&runs, ExportFormat::Parquet, &selection);
        prop_assert_eq!(sorted(read(&out, "records")), sorted(records(&chosen)));
        prop_assert_eq!(sorted(read(&out, "frame_times")), sorted(frame_times(&chosen)));
    }
}
