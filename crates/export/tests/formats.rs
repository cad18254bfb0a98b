//! Exports of a small history with hostile names: what it holds comes back, and no name becomes a path.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use etalon_export::{ExportError, Format, Selection, export};
use etalon_history::{
    Adapter, FrameTimes, History, Kind, Labels, NewAdapter, NewRun, Outcome, Writer, parse_time,
};
use etalon_record::{Machine, Verdict};
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

const HOSTILE: &str = "../a\"b\\c\n/é";

fn history(dir: &Path, days: &[&str]) -> History {
    let path = dir.join("h.db");
    let mut writer = Writer::open(&path).unwrap();
    for (number, day) in (1..).zip(days) {
        let mut adapter = NewAdapter::new(Adapter {
            name: HOSTILE.to_owned(),
            backend: "vulkan".to_owned(),
            device: String::new(),
            driver: "a driver".to_owned(),
            driver_version: format!("{number}.0"),
            driver_id: String::new(),
            api_version: String::new(),
            software: true,
            line: String::new(),
            version: String::new(),
        });
        let case = format!("perf/{HOSTILE}");
        let mut fail = Outcome::new(Verdict::Fail);
        fail.expected = Some("known \"bug\"".to_owned());
        adapter.outcomes.insert(case.clone(), fail);
        let pass = Outcome::new(Verdict::Pass);
        adapter.outcomes.insert("depth/a".to_owned(), pass);
        let times = FrameTimes {
            frames: 5,
            wall: vec![0.5],
            ..FrameTimes::default()
        };
        adapter.times.insert(case, times);
        let run = NewRun {
            digest: [number; 32],
            header: [number; 32],
            kind: Kind::Run,
            etalon: "0.1.0".to_owned(),
            commit: None,
            machine: Machine {
                os: HOSTILE.to_owned(),
                cpu: "a processor".to_owned(),
                cores: 2,
            },
            started: parse_time(day).unwrap(),
            released: None,
            profile: Some("quick".to_owned()),
            ruler: None,
            missing: 0,
            labels: Labels::from([("branch".to_owned(), HOSTILE.to_owned())]),
            adapters: vec![adapter],
        };
        writer.add(&run).unwrap();
    }
    drop(writer);
    History::open_read(&path).unwrap()
}

fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            all.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    all
}

#[test]
fn tables_hold_what_the_history_holds() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &["2026-01-01", "2026-01-02"]);
    let out = dir.path().join("out");
    let all = Selection::default();
    let written = export(&history, Format::Parquet, &all, &out).unwrap();
    assert_eq!(written.rows, 6);
    let mut found = Vec::new();
    for path in files(&out.join("records")).keys() {
        let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
        for row in reader.get_row_iter(None).unwrap() {
            let row = row.unwrap().to_string();
            found.push(row);
        }
    }
    assert_eq!(found.len(), 4);
    let failed: Vec<_> = found.iter().filter(|r| r.contains("\"fail\"")).collect();
    assert_eq!(failed.len(), 2, "{found:?}");
    for row in failed {
        for due in ["known", "0.1.0", "quick", "perf", "inferred: false"] {
            assert!(row.contains(due), "{due}: {row}");
        }
    }
}

#[test]
fn every_format_is_the_same_each_time_and_stays_in_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &["2026-01-01", "2026-01-02"]);
    for format in [
        Format::Parquet,
        Format::OpenMetrics,
        Format::Otava,
        Format::Bencher,
        Format::ActionBenchmark,
    ] {
        let (one, two) = (dir.path().join("x/one"), dir.path().join("x/two"));
        let all = Selection::default();
        let written = export(&history, format, &all, &one).unwrap();
        export(&history, format, &all, &two).unwrap();
        let (a, b) = (files(&one), files(&two));
        assert_eq!(a.len() as u64, written.files, "{format:?}");
        assert!(a.values().eq(b.values()), "{format:?}");
        assert_eq!(fs::read_dir(dir.path().join("x")).unwrap().count(), 2);
        let again = export(&history, format, &all, &one);
        assert!(matches!(again, Err(ExportError::NotEmpty { .. })));
        fs::remove_dir_all(dir.path().join("x")).unwrap();
    }
}

#[test]
fn samples_are_escaped_and_end() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &["2026-01-01"]);
    let out = dir.path().join("out");
    export(&history, Format::OpenMetrics, &Selection::default(), &out).unwrap();
    let text = fs::read_to_string(out.join("history.om")).unwrap();
    assert!(text.ends_with("# EOF\n"));
    assert!(text.contains(r#"adapter="../a\"b\\c\n/é""#), "{text}");
    assert!(!text.contains("NaN"));
    for line in text.lines() {
        assert!(
            line.starts_with('#') || line.starts_with("etalon_"),
            "{line}"
        );
    }
}

#[test]
fn an_empty_history_is_exported() {
    let dir = tempfile::tempdir().unwrap();
    let history = history(dir.path(), &[]);
    let out = dir.path().join("out");
    let written = export(&history, Format::OpenMetrics, &Selection::default(), &out).unwrap();
    assert_eq!(written.rows, 0);
}
