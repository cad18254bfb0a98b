//! Selected runs, and empty selections.

use crate::made::{FORMATS, daily, history, selected};
use etalon_export::{ExportError, RunChoice, export};
use etalon_history::parse_time;

const DAYS: [&str; 3] = ["2026-01-01", "2026-01-02", "2026-01-03"];

fn since(day: &str) -> RunChoice {
    RunChoice {
        since: parse_time(day),
        last: None,
    }
}

fn last(n: usize) -> RunChoice {
    RunChoice {
        since: None,
        last: Some(n),
    }
}

#[test]
fn a_selection_without_runs_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let full = history(dir.path(), &daily(&DAYS));
    let other = tempfile::tempdir().unwrap();
    let empty = history(other.path(), &[]);
    let out = dir.path().join("out");
    for format in FORMATS {
        for (history, selection) in [
            (&empty, RunChoice::default()),
            (&full, since("2026-01-04")),
            (&full, last(0)),
        ] {
            let error = export(history, format, &selection, &out).unwrap_err();
            assert!(matches!(error, ExportError::NoRuns { .. }), "{error:?}");
            let line = error.to_string();
            assert!(
                line.contains("h.db") && !line.contains('\n'),
                "{format:?}: {line}"
            );
            assert!(!out.exists(), "{format:?}");
        }
    }
}

#[test]
fn a_run_of_the_day_itself_is_late_enough() {
    let runs = daily(&DAYS);
    for (selection, expected) in [
        (since("2026-01-02"), 2),
        (since("2026-01-02T00:00:01Z"), 1),
        (last(2), 2),
        (last(9), 3),
        (
            RunChoice {
                last: Some(1),
                ..since("2026-01-01")
            },
            1,
        ),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let history = history(dir.path(), &runs);
        assert_eq!(selected(&runs, &selection).len(), expected);
        for (format, rows) in FORMATS.into_iter().zip([3, 3]) {
            let out = dir.path().join(format!("{format:?}"));
            let written = export(&history, format, &selection, &out).unwrap();
            // Two records and a time of each run.
            assert_eq!(
                written.rows,
                rows * expected as u64,
                "{format:?} {selection:?}"
            );
        }
    }
}
