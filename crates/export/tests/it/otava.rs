//! The files for Apache Otava, read back as its importer reads them.

use crate::made::{exported, files, machine, middle, selected, time};
use crate::random::{runs, selections};
use etalon_export::Format;
use etalon_history::{NewRun, parse_time};
use proptest::prelude::*;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The columns of a row by their names.
type Row = BTreeMap<String, String>;

/// Reads CSV: fields in quotes can contain anything, and a quote in them is doubled.
fn records(text: &str) -> Vec<Vec<String>> {
    let (mut records, mut record, mut field) = (Vec::new(), Vec::new(), String::new());
    let mut quoted = false;
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => field.extend(chars.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => record.push(std::mem::take(&mut field)),
            '\n' if !quoted => {
                record.push(std::mem::take(&mut field));
                records.push(std::mem::take(&mut record));
            }
            c => field.push(c),
        }
    }
    assert!(!quoted && field.is_empty() && record.is_empty(), "{text}");
    records
}

/// The rows of each test that the configuration names. Every file must belong to a test, and every column
/// that a test names must exist.
fn read(out: &Path) -> BTreeMap<String, Vec<Row>> {
    let text = fs::read_to_string(out.join("otava.yaml")).unwrap();
    let configuration: Value = serde_json::from_str(&text).unwrap();
    let mut tests = BTreeMap::new();
    let mut named = BTreeSet::from([out.join("otava.yaml")]);
    for (title, test) in configuration["tests"].as_object().unwrap() {
        assert_eq!(test["type"], "csv");
        let path = out.join(test["file"].as_str().unwrap());
        let mut records = records(&fs::read_to_string(&path).unwrap()).into_iter();
        assert!(named.insert(path), "{title}");
        let head = records.next().unwrap();
        let column = |name: &Value| {
            let name = name.as_str().unwrap();
            assert!(head.iter().any(|column| column == name), "{name}");
        };
        column(&test["time_column"]);
        test["attributes"]
            .as_array()
            .unwrap()
            .iter()
            .for_each(column);
        for metric in test["metrics"].as_object().unwrap().values() {
            column(&metric["column"]);
            assert_eq!(metric["direction"], -1);
        }
        let rows = records.map(|record| {
            assert_eq!(record.len(), head.len());
            head.iter().cloned().zip(record).collect()
        });
        tests.insert(title.clone(), rows.collect());
    }
    assert_eq!(files(out).into_keys().collect::<BTreeSet<_>>(), named);
    tests
}

/// Time, commit, version and times of each run of each test.
type TestRows = BTreeMap<String, Vec<(i64, String, String, [Option<f64>; 5])>>;

fn expected_rows(runs: &[&NewRun]) -> TestRows {
    let mut tests = TestRows::new();
    for run in runs {
        for part in &run.adapters {
            for (case, times) in &part.times {
                let ruler = run.ruler.as_deref().map(|ruler| format!(", ruler {ruler}"));
                let ruler = ruler.unwrap_or_default();
                let title = format!("{case} {} {}{ruler}", part.timeline, machine(run));
                let measured = [
                    &times.wall,
                    &times.cpu,
                    &times.gpu,
                    &times.read_back,
                    &times.ruler,
                ];
                let row = (
                    time(run),
                    run.commit.clone().unwrap_or_default(),
                    part.adapter.driver_version.clone(),
                    measured.map(|rounds| middle(rounds)),
                );
                tests.entry(title).or_default().push(row);
            }
        }
    }
    tests
}

fn exported_rows(tests: BTreeMap<String, Vec<Row>>) -> TestRows {
    let row = |row: Row| {
        let value = |name: &str| match row[name].as_str() {
            "" => None,
            text => Some(text.parse().unwrap()),
        };
        (
            parse_time(&row["time"]).unwrap(),
            row["commit"].clone(),
            row["version"].clone(),
            ["wall", "cpu", "gpu", "read_back", "ruler"].map(value),
        )
    };
    let each = tests.into_iter();
    each.map(|(title, rows)| (title, rows.into_iter().map(row).collect()))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn rows_are_what_was_added(runs in runs(), selection in selections()) {
        let chosen = selected(&runs, &selection);
        prop_assume!(!chosen.is_empty());
        let (out, _dir) = exported(&runs, Format::Otava, &selection);
        prop_assert_eq!(exported_rows(read(&out)), expected_rows(&chosen));
    }
}
