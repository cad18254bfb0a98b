//! `etalon history export`: folders, selections and exit codes.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::history::HistoryFolder;
use assert_cmd::assert::Assert;
use etalon_record::Verdict;
use rusqlite::Connection;
use std::fs;

const FORMATS: [&str; 4] = [
    "parquet",
    "openmetrics",
    "bencher",
    "github-action-benchmark",
];

/// Exports, and returns the line that is printed.
fn export(history: &HistoryFolder, out: &str, arguments: &[&str], code: i32) -> String {
    let out = history.path(out).display().to_string();
    let assert: Assert = history.command(&[&["export", &out], arguments].concat());
    let text = String::from_utf8(assert.code(code).get_output().stderr.clone()).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

/// A history of three days with two records each.
fn three_days() -> HistoryFolder {
    let history = HistoryFolder::new();
    let verdicts = [("depth/a", Verdict::Pass), ("depth/b", Verdict::Fail)];
    for day in 1..4 {
        let run = history.run(day, "1.0", &verdicts);
        history.command(&["add", &run]).code(0);
    }
    history
}

#[test]
fn a_folder_that_cannot_be_used_is_named() {
    let history = three_days();
    fs::write(history.path("file"), "mine").unwrap();
    fs::create_dir(history.path("full")).unwrap();
    fs::write(history.path("full/mine"), "mine").unwrap();
    for format in FORMATS {
        let line = export(&history, "full", &["--format", format], 64);
        assert!(line.contains("full is not empty; name another"), "{line}");
        for out in ["file", "file/below"] {
            let line = export(&history, out, &["--format", format], 64);
            let expected = format!("{} is no folder", history.path("file").display());
            assert!(line.contains(&expected), "{line}");
        }
    }
    assert_eq!(fs::read_dir(history.path("full")).unwrap().count(), 1);
    assert_eq!(fs::read_to_string(history.path("file")).unwrap(), "mine");
}

#[test]
fn a_selection_of_no_run_writes_nothing() {
    let history = three_days();
    let empty = three_days();
    let file = Connection::open(empty.db()).unwrap();
    for table in ["part", "change", "run"] {
        file.execute(&format!("DELETE FROM {table}"), []).unwrap();
    }
    drop(file);
    for format in FORMATS {
        let format = ["--format", format];
        for (history, flags) in [
            (&history, &["--since", "2031-01-01"][..]),
            (&history, &["--runs", "0"]),
            (&empty, &[]),
        ] {
            let line = export(history, "out", &[&format[..], flags].concat(), 4);
            let db = history.db().display().to_string();
            assert!(line.contains(&format!("{db} holds no such run")), "{line}");
            assert!(!history.path("out").exists(), "{format:?}");
        }
    }
}

#[test]
fn times_of_runs_without_times_are_nothing() {
    let history = three_days();
    for format in ["bencher", "github-action-benchmark"] {
        let line = export(&history, "out", &["--format", format], 4);
        assert!(line.contains("no frame times"), "{line}");
        assert_eq!(fs::read_dir(history.path("out")).unwrap().count(), 0);
    }
}

#[test]
fn a_part_of_the_runs_is_selected() {
    let history = three_days();
    for (index, (flags, files)) in [
        (&[][..], 3),
        (&["--since", "2024-01-03"], 2),
        (&["--since", "2024-01-03T12:00:00Z"], 1),
        (&["--runs", "1"], 1),
        (&["--runs", "7", "--since", "1970-01-01"], 3),
    ]
    .into_iter()
    .enumerate()
    {
        let out = format!("out-{index}");
        let line = export(
            &history,
            &out,
            &[&["--format", "parquet"], flags].concat(),
            0,
        );
        let noun = if files == 1 { "file" } else { "files" };
        let expected = format!("{} rows in {files} {noun} in", files * 2);
        assert!(line.contains(&expected), "{flags:?}: {line}");
    }
}

#[test]
fn what_is_no_date_or_no_history_is_wrong_usage() {
    let history = three_days();
    let since = ["--format", "openmetrics", "--since", "yesterday"];
    let line = export(&history, "out", &since, 64);
    assert!(line.contains("is no date; write 2026-01-31"), "{line}");
    let none = HistoryFolder::new();
    let line = export(&none, "out", &["--format", "openmetrics"], 64);
    assert!(line.contains("there is no history at"), "{line}");
    assert!(!history.path("out").exists() && !none.path("out").exists());
}
