//! Several writers of one history, and writers that are killed.

use super::{GOOD, Place};
use crate::etalon::{BINARY, etalon};
use etalon_record::Verdict;
use predicates::str::contains;
use rusqlite::Connection;
use serde_json::Value;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

#[test]
fn two_writers_at_once_add_all() {
    let place = Place::new();
    let folders: Vec<String> = (0..12).map(|day| place.run(day, "1", &GOOD)).collect();
    let writers: Vec<_> = folders
        .chunks(6)
        .map(|half| {
            let mut command = Command::new(BINARY);
            command
                .args(["history", "add"])
                .args(half)
                .arg("--db")
                .arg(place.db());
            command.stdout(Stdio::null()).spawn().unwrap()
        })
        .collect();
    for mut writer in writers {
        assert!(writer.wait().unwrap().success());
    }
    assert_eq!(place.json(&["show"]).as_array().unwrap().len(), 12);
}

#[test]
fn a_writer_that_is_killed_loses_nothing() {
    let place = Place::new();
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
            place.run(day, "1", &verdicts)
        })
        .collect();
    let mut killed = 0;
    for wait in [30, 60, 90, 120, 150] {
        let mut command = Command::new(BINARY);
        command
            .args(["history", "add"])
            .args(&folders)
            .arg("--db")
            .arg(place.db());
        let mut writer = command.stdout(Stdio::null()).spawn().unwrap();
        sleep(Duration::from_millis(wait));
        killed += u32::from(writer.try_wait().unwrap().is_none());
        writer.kill().unwrap();
        writer.wait().unwrap();
        let mut show = etalon(&["history", "show", "--db"]);
        let shown = show.arg(place.db()).assert();
        if shown.get_output().status.code() == Some(64) {
            shown.stderr(contains("there is no history"));
            continue;
        }
        // Only complete runs are there.
        let runs = place.json(&["show"]);
        let last = runs.as_array().unwrap().len();
        let assert = etalon(&[
            "history",
            "show",
            "depth/made/n=3999",
            "--format",
            "json",
            "--db",
        ])
        .arg(place.db())
        .assert();
        if last > 0 {
            let shown: Value = serde_json::from_slice(&assert.code(0).get_output().stdout).unwrap();
            assert_eq!(
                shown["adapters"][0]["records"].as_array().unwrap().len(),
                last
            );
        }
    }
    assert!(killed > 0, "no writer was killed while it wrote");
    let mut arguments = vec!["add"];
    arguments.extend(folders.iter().map(String::as_str));
    place.history(&arguments).code(0);
    assert_eq!(place.json(&["show"]).as_array().unwrap().len(), 40);
    let file = Connection::open(place.db()).unwrap();
    let sound: String = file
        .query_row("PRAGMA integrity_check", [], |row| row.get(0))
        .unwrap();
    assert_eq!(sound, "ok");
}
