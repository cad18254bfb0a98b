//! Files that are not a history, in use, full or half written.

use crate::made::{case, run, with};
use etalon_history::{Added, History, HistoryError, NewRun, Writer};
use rusqlite::Connection;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

fn numbered_run(number: u8) -> NewRun {
    let verdicts = if number.is_multiple_of(2) {
        "ppf"
    } else {
        "pfp"
    };
    run(number, "2026-01-01", vec![with("cpu", "1", verdicts)])
}

/// One line that names the file and ends without a period.
fn assert_line(error: &HistoryError, path: &Path) {
    let text = error.to_string();
    assert!(
        !text.contains('\n') && text.contains(path.to_str().unwrap()),
        "{text}"
    );
}

#[test]
fn a_file_that_is_no_history_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let text = folder.path().join("text.db");
    fs::write(
        &text,
        "not a database, but long enough to have a header of one: ".repeat(20),
    )
    .unwrap();
    let short = folder.path().join("short.db");
    fs::write(&short, "no").unwrap();
    let other = folder.path().join("other.db");
    Connection::open(&other)
        .unwrap()
        .execute_batch("CREATE TABLE mine (x); INSERT INTO mine VALUES (1)")
        .unwrap();
    for path in [&text, &short, &other] {
        let before = fs::read(path).unwrap();
        for error in [
            Writer::open(path).unwrap_err(),
            History::open_read(path).unwrap_err(),
        ] {
            assert!(matches!(error, HistoryError::Other { .. }), "{error}");
            assert_line(&error, path);
        }
        assert_eq!(fs::read(path).unwrap(), before);
    }
    let folder_itself = Writer::open(folder.path()).unwrap_err();
    assert_line(&folder_itself, folder.path());
    let none = folder.path().join("none.db");
    let error = History::open_read(&none).unwrap_err();
    assert!(matches!(error, HistoryError::None { .. }), "{error}");
    assert!(!none.exists());
}

#[test]
fn an_empty_file_becomes_a_history() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    fs::write(&path, "").unwrap();
    let error = History::open_read(&path).unwrap_err();
    assert!(matches!(error, HistoryError::None { .. }), "{error}");
    assert_line(&error, &path);
    Writer::open(&path).unwrap().add(&numbered_run(1)).unwrap();
    assert_eq!(History::open_read(&path).unwrap().runs().len(), 1);
}

#[test]
fn a_newer_schema_is_refused_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    Writer::open(&path).unwrap().add(&numbered_run(1)).unwrap();
    let connection = Connection::open(&path).unwrap();
    connection.pragma_update(None, "user_version", 7).unwrap();
    drop(connection);
    for error in [
        Writer::open(&path).unwrap_err(),
        History::open_read(&path).unwrap_err(),
    ] {
        assert_line(&error, &path);
        assert!(
            error.to_string().contains("use the etalon that wrote it"),
            "{error}"
        );
    }
}

#[test]
fn a_locked_file_is_waited_for_and_then_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open_with(&path, Duration::from_millis(50)).unwrap();
    let other = Connection::open(&path).unwrap();
    other.execute_batch("BEGIN EXCLUSIVE").unwrap();
    let error = writer.add(&numbered_run(1)).unwrap_err();
    assert!(matches!(error, HistoryError::Busy { .. }), "{error}");
    assert_line(&error, &path);
    other.execute_batch("COMMIT").unwrap();
    assert!(matches!(
        writer.add(&numbered_run(1)).unwrap(),
        Added::New(_)
    ));
}

#[test]
fn several_writers_can_add_at_the_same_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    thread::scope(|scope| {
        for writer in 0..4u8 {
            let path = &path;
            scope.spawn(move || {
                for number in 0..8u8 {
                    // Each run comes from two of them.
                    let number = number * 4 + writer / 2 * 2;
                    Writer::open(path)
                        .unwrap()
                        .add(&numbered_run(number))
                        .unwrap();
                }
            });
        }
    });
    let history = History::open_read(&path).unwrap();
    assert_eq!(history.runs().len(), 16);
    let found = history.case_history(&case(0), None).unwrap();
    assert_eq!(found[0].points.len(), 16);
}

#[test]
fn a_full_disk_keeps_what_was_added_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    writer.add(&numbered_run(0)).unwrap();
    let pages: i64 = writer.pages().unwrap();
    writer.limit_pages(pages).unwrap();
    let large = run(1, "2026-01-02", vec![with("cpu", "1", &"pf".repeat(2000))]);
    let error = writer.add(&large).unwrap_err();
    assert!(matches!(error, HistoryError::Full { .. }), "{error}");
    assert_line(&error, &path);
    let history = History::open_read(&path).unwrap();
    assert_eq!(history.runs().len(), 1);
    assert_eq!(history.cases().unwrap().len(), 3);
    // With space again, the run can be added.
    assert!(matches!(
        Writer::open(&path).unwrap().add(&large).unwrap(),
        Added::New(_)
    ));
}

#[test]
fn a_reader_sees_the_history_as_it_was_at_its_start() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("etalon.db");
    let mut writer = Writer::open(&path).unwrap();
    writer.add(&numbered_run(0)).unwrap();
    let history = History::open_read(&path).unwrap();
    let points = |history: &History| {
        history.case_history(&case(1), None).unwrap()[0]
            .points
            .len()
    };
    for number in 1..9 {
        writer.add(&numbered_run(number)).unwrap();
        assert_eq!((history.runs().len(), points(&history)), (1, 1));
    }
    assert_eq!(points(&History::open_read(&path).unwrap()), 9);
}
