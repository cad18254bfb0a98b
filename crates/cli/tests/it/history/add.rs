//! `etalon history add`: labels, refusals, and the file that it writes.

use super::{CASE, GOOD, HistoryFolder};
use crate::etalon::etalon;
use predicates::prelude::*;
use predicates::str::contains;
use rusqlite::Connection;
use serde_json::json;
use std::fs;
use std::path::Path;

#[test]
fn adding_a_run_twice_changes_nothing() {
    let history = HistoryFolder::new();
    let out = history.path("run").display().to_string();
    let run = ["run", "cull/points", "--adapter", "cpu", "--out", &out];
    etalon(&run).assert().code(0);
    let added = history.json(&["add", &out, "--label", "branch=main"]);
    assert_eq!(
        (&added[0]["added"], &added[0]["run"]),
        (&json!(true), &json!(1))
    );
    assert!(added[0]["records"].as_u64().unwrap() > 0, "{added}");
    let before = history.dump();
    history
        .command(&["add", &out])
        .code(0)
        .stdout(contains("is run 1 already"));
    assert_eq!(history.dump(), before);
    let runs = history.json(&["show"]);
    assert_eq!(runs.as_array().unwrap().len(), 1);
    assert_eq!(runs[0]["labels"], json!({ "branch": "main" }));
}

#[test]
fn the_file_is_named_by_flag_or_variable_or_lies_beside_the_reports() {
    let history = HistoryFolder::new();
    let run = history.run(1, "1", &GOOD);
    let add = |variable: Option<&Path>| {
        let mut command = etalon(&["history", "add", &run]);
        command
            .current_dir(history.folder.path())
            .env_remove("ETALON_HISTORY");
        command.envs(variable.map(|path| ("ETALON_HISTORY", path)));
        command.assert().code(0);
    };
    add(None);
    assert!(history.path("reports/etalon.db").is_file());
    add(Some(&history.path("deep/er/own.db")));
    assert!(history.path("deep/er/own.db").is_file());
}

#[test]
fn hostile_labels_are_kept_and_give_no_orders_to_a_terminal() {
    let history = HistoryFolder::new();
    let run = history.run(1, "1", &GOOD);
    let value = "a=b'; DROP TABLE run; -- \u{1b}[31m\u{202e}\n{{x}}";
    history
        .command(&["add", &run, "--label", &format!("note={value}")])
        .code(0);
    assert_eq!(history.json(&["show"])[0]["labels"]["note"], *value);
    history
        .command(&["show"])
        .code(0)
        .stdout(contains("\u{1b}").not().and(contains("\u{202e}").not()));
    let long = format!("key={}", "x".repeat(5000));
    for wrong in ["branch", "=main", "", &long] {
        let refused = history.command(&["add", &run, "--label", wrong]).code(64);
        let line = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
        assert_eq!(
            (line.lines().count(), line.contains("label")),
            (1, true),
            "{line}"
        );
    }
    history
        .command(&["add", &run, "--label", "a=1", "--label", "a=2"])
        .code(64);
    assert_eq!(history.json(&["show"]).as_array().unwrap().len(), 1);
}

#[test]
fn a_run_that_lacks_records_is_refused_and_then_taken() {
    let history = HistoryFolder::new();
    let folder = history.run(1, "1", &GOOD);
    let file = Path::new(&folder).join("run.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() - 40]).unwrap();
    let refused = history.command(&["add", &folder]).code(3);
    let line = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert_eq!(line.lines().count(), 1, "{line}");
    assert!(
        line.contains("lacks 1 record;") && line.contains("--resume"),
        "{line}"
    );
    assert!(line.contains(&folder), "{line}");
    assert_eq!(history.json(&["show"]), json!([]));
    history
        .command(&["add", &folder, "--incomplete"])
        .code(0)
        .stdout(contains("1 missing"));
    // The resumed run replaces the part that was already there.
    fs::write(&file, &text).unwrap();
    history.command(&["add", &folder]).code(0);
    history
        .command(&["show"])
        .stdout(contains("resumed as run 2"));
    history
        .command(&["show", CASE])
        .stdout(contains("cpu  1 run, run 2").and(contains("  ✓\n")));
}

#[test]
fn bad_input_is_one_line_and_the_rest_is_added() {
    let history = HistoryFolder::new();
    let good = history.run(1, "1", &GOOD);
    let half = history.run(2, "1", &GOOD);
    fs::write(Path::new(&half).join("run.jsonl"), "{\"format\":3,\"etal").unwrap();
    let damaged = history.run(3, "1", &GOOD);
    let file = Path::new(&damaged).join("run.jsonl");
    let text = fs::read_to_string(&file)
        .unwrap()
        .replace("\"pass\"", "\"fine\"");
    fs::write(&file, text).unwrap();
    let nothing = history.path("nothing").display().to_string();
    let refused = history
        .command(&["add", &half, &damaged, &nothing, &good])
        .code(64);
    let lines = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert_eq!(lines.lines().count(), 3, "{lines}");
    for (line, path) in lines.lines().zip([&half, &damaged, &nothing]) {
        assert!(line.contains(path.as_str()), "{line}");
    }
    assert_eq!(history.json(&["show"]).as_array().unwrap().len(), 1);
    let dates = history.path("dates.json");
    fs::write(&dates, r#"{"cpu": {"1": "soon"}}"#).unwrap();
    let dates = dates.display().to_string();
    let wrong = history.command(&["add", &good, "--dates", &dates]).code(64);
    wrong.stderr(contains("dates.json").and(contains("is no date")));
}

#[test]
fn other_files_and_newer_ones_are_refused_and_stay_as_they_are() {
    let history = HistoryFolder::new();
    let run = history.run(1, "1", &GOOD);
    history
        .command(&["show", CASE])
        .code(64)
        .stderr(contains("etalon history add"));
    for content in [
        "not a database, though long enough to look like one to a hasty reader",
        "{}",
    ] {
        fs::write(history.db(), content).unwrap();
        for arguments in [&["add", &run][..], &["show", CASE], &["triage"]] {
            history
                .command(arguments)
                .code(64)
                .stderr(contains("is no history of etalon"));
        }
        assert_eq!(fs::read_to_string(history.db()).unwrap(), content);
    }
    fs::remove_file(history.db()).unwrap();
    history.command(&["add", &run]).code(0);
    let file = Connection::open(history.db()).unwrap();
    file.pragma_update(None, "user_version", 1000).unwrap();
    drop(file);
    for arguments in [&["add", &run][..], &["show", CASE], &["triage"]] {
        let refused = history.command(arguments).code(64);
        refused.stderr(contains("has schema 1000").and(contains("use the etalon that wrote it")));
    }
}
