//! Histories that are damaged in many ways: each command works or says what to do, and none panics.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::history::HistoryFolder;
use crate::sample;
use etalon_record::Verdict;
use rusqlite::Connection;
use std::fs;
use std::path::Path;

const CASE: &str = "depth/made/n=1";

/// A history of all tables.
fn history() -> HistoryFolder {
    let history = HistoryFolder::new();
    let cases = [CASE, "depth/made/n=2", "blend/made/n=3"];
    for day in 0..4 {
        let broken = day % 2 == 1;
        let verdict = if broken { Verdict::Fail } else { Verdict::Pass };
        let run = history.run(
            day,
            "1.0",
            &[
                (cases[0], verdict),
                (cases[1], Verdict::Pass),
                (cases[2], verdict),
            ],
        );
        history.command(&["add", &run]).code(0);
    }
    for night in 4..12 {
        let bench = history.bench(night, 0.001, 0.002);
        history.command(&["add", &bench]).code(0);
    }
    history
        .command(&[
            "triage",
            CASE,
            "--adapter",
            "cpu",
            "--state",
            "real",
            "--reason",
            "r",
        ])
        .code(0);
    history
}

/// Runs the commands that read a history.
fn check(history: &HistoryFolder, damage: &str, commands: &[&[&str]]) {
    for command in commands {
        let out = history.path("out");
        let mut words = command.to_vec();
        match words[0] {
            "report" => words.extend(["--out", out.to_str().unwrap()]),
            "export" => words.extend(["--format", "openmetrics", out.to_str().unwrap()]),
            _ => {}
        }
        let mut all = etalon(&["history"]);
        let assert = all.args(&words).arg("--db").arg(history.db()).assert();
        let output = assert.get_output();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let code = output.status.code();
        // A case or an adapter that has lost its name is one that was never there.
        let is_told = code == Some(64) || code == Some(4);
        assert!(
            code == Some(0) || is_told && said.starts_with("etalon: "),
            "{damage}: {command:?}: {code:?}: {said}"
        );
        assert!(!said.contains("Query returned no rows"), "{damage}: {said}");
        let _ = fs::remove_dir_all(&out);
    }
}

const COMMANDS: [&[&str]; 4] = [&["report"], &["show", CASE], &["triage"], &["export"]];

fn copy(from: &Path, to: &HistoryFolder) {
    fs::copy(from, to.db()).unwrap();
}

#[test]
fn missing_or_wrong_rows_are_reported() {
    let whole = history();
    let intact = whole.db();
    let damaged = HistoryFolder::new();
    let file = Connection::open(&intact).unwrap();
    let tables: Vec<String> = file
        .prepare("SELECT name FROM sqlite_schema WHERE type = 'table'")
        .unwrap()
        .query_map([], |row| row.get(0))
        .unwrap()
        .map(Result::unwrap)
        .collect();
    let mut damages: Vec<String> = Vec::new();
    for table in &tables {
        let columns: Vec<(String, String)> = file
            .prepare(&format!(
                "SELECT name, type FROM pragma_table_info('{table}')"
            ))
            .unwrap()
            .query_map([], |row| Ok((row.get(0)?, row.get(1)?)))
            .unwrap()
            .map(Result::unwrap)
            .collect();
        let first = &columns[0].0;
        damages.push(format!("DELETE FROM {table}"));
        for end in ["min", "max"] {
            damages.push(format!(
                "DELETE FROM {table} WHERE {first} = (SELECT {end}({first}) FROM {table})"
            ));
        }
        damages.push(format!("DROP TABLE {table}"));
        for (column, kind) in &columns {
            let values: &[&str] = match kind.as_str() {
                "INTEGER" => &["NULL", "-1", "0", "77", "4294967296", "9223372036854775807"],
                "TEXT" => &["NULL", "''", "'\u{1b}[2J'", "CAST(x'ff' AS TEXT)"],
                _ => &["NULL", "x''", "x'00'", "x'ffffffffffffffffffff'"],
            };
            for value in values {
                damages.push(format!("UPDATE OR REPLACE {table} SET {column} = {value}"));
                damages.push(format!(
                    "UPDATE OR REPLACE {table} SET {column} = {value} WHERE {first} = (SELECT max({first}) FROM {table})"
                ));
            }
        }
    }
    drop(file);
    let every = sample::count("damaged histories", 5, 1);
    let mut done = 0;
    for (number, damage) in damages.iter().enumerate() {
        // A missing row is always tried.
        if !damage.starts_with("D") && number % every != 0 {
            continue;
        }
        copy(&intact, &damaged);
        let file = Connection::open(damaged.db()).unwrap();
        file.execute_batch("PRAGMA foreign_keys = 0; PRAGMA ignore_check_constraints = 1")
            .unwrap();
        if file.execute(damage, []).is_err() {
            continue;
        }
        drop(file);
        done += 1;
        let commands = if damage.starts_with("D") {
            &COMMANDS[..]
        } else {
            &COMMANDS[number % 4..][..1]
        };
        check(&damaged, damage, commands);
    }
    assert!(done > 60, "{done}");
}

#[test]
fn cut_or_flipped_files_are_reported() {
    let whole = history();
    let bytes = fs::read(whole.db()).unwrap();
    let damaged = HistoryFolder::new();
    let mut random = 1_u64;
    let mut below = |most: usize| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % most
    };
    let count = sample::count("damaged history files", 40, 400);
    for number in 0..count {
        let mut spoilt = bytes.clone();
        let damage = if number % 4 == 0 {
            let length = below(bytes.len());
            spoilt.truncate(length);
            format!("cut at {length}")
        } else {
            let places: Vec<usize> = (0..1 + number % 8).map(|_| below(bytes.len())).collect();
            for place in &places {
                spoilt[*place] ^= 1 << below(8);
            }
            format!("flipped at {places:?}")
        };
        fs::write(damaged.db(), spoilt).unwrap();
        check(&damaged, &damage, &COMMANDS[number % 4..][..1]);
    }
}
