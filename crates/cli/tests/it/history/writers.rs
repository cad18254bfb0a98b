//! Several writers of one history, and writers that are killed.

use super::{GOOD, HistoryFolder};
use crate::etalon::etalon;
use etalon_record::Verdict;
use predicates::str::contains;
use rusqlite::Connection;
use std::thread::sleep;
use std::time::Duration;

#[test]
fn two_writers_at_once_add_all() {
    let history = HistoryFolder::new();
    let folders: Vec<String> = (0..12).map(|day| history.run(day, "1", &GOOD)).collect();
    let writers: Vec<_> = folders
        .chunks(6)
        .map(|half| history.spawn_add(half))
        .collect();
    for mut writer in writers {
        assert!(writer.wait().unwrap().success());
    }
    assert_eq!(history.json(&["show"]).as_array().unwrap().len(), 12);
}

#[test]
fn a_writer_that_is_killed_loses_nothing() {
    let history = HistoryFolder::new();
    let cases: Vec<String> = (0..4000).map(|n| format!("depth/made/n={n}")).collect();
    let folders: Vec<String> = (0..40)
        .map(|day| {
            let verdict = |n: usize| match (n + day as usize) % 7 {
                0 => Verdict::Fail,
                _ => Verdict::Pass,
            };
            let verdicts: Vec<(&str, Verdict)> = cases
                .iter()
                .enumerate()
                .map(|(n, case)| (case.as_str(), verdict(n)))
                .collect();
            history.run(day, "1", &verdicts)
        })
        .collect();
    let mut killed = 0;
    for wait in [30, 60, 90, 120, 150] {
        let mut writer = history.spawn_add(&folders);
        sleep(Duration::from_millis(wait));
        killed += u32::from(writer.try_wait().unwrap().is_none());
        writer.kill().unwrap();
        writer.wait().unwrap();
        let mut show = etalon(&["history", "show", "--db"]);
        let output = show.arg(history.db()).assert();
        if output.get_output().status.code() == Some(64) {
            output.stderr(contains("there is no history"));
            continue;
        }
        // Only complete runs are there.
        let runs = history.json(&["show"]);
        let last = runs.as_array().unwrap().len();
        if last > 0 {
            let case = history.json(&["show", "depth/made/n=3999"]);
            assert_eq!(
                case["adapters"][0]["records"].as_array().unwrap().len(),
                last
            );
        }
    }
    // On a machine so fast that every writer ends in 30 ms, more runs are needed.
    assert!(killed > 0, "no writer was killed while it wrote");
    let mut arguments = vec!["add"];
    arguments.extend(folders.iter().map(String::as_str));
    history.command(&arguments).code(0);
    assert_eq!(history.json(&["show"]).as_array().unwrap().len(), 40);
    let file = Connection::open(history.db()).unwrap();
    let sound: String = file
        .query_row("PRAGMA integrity_check", [], |row| row.get(0))
        .unwrap();
    assert_eq!(sound, "ok");
}
