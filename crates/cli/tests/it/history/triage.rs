//! `etalon history triage`: bad verdicts and steps of times.

use super::{BAD, CASE, GOOD, HistoryFolder};
use predicates::prelude::*;
use predicates::str::contains;
use rusqlite::Connection;
use serde_json::json;

/// Adds 45 benches. The driver slows down at run 21, and the machine, with its ruler, at run 34.
fn history_with_steps() -> HistoryFolder {
    let history = HistoryFolder::new();
    let mut add = vec!["add".to_owned()];
    for night in 0..45 {
        let seconds = if night < 20 { 0.001 } else { 0.0012 };
        let [seconds, ruler] = [seconds, 0.002].map(|t| if night < 33 { t } else { t * 1.1 });
        add.push(history.bench(night, seconds, ruler));
    }
    let add: Vec<&str> = add.iter().map(String::as_str).collect();
    history.command(&add).code(0);
    history
}

#[test]
fn a_step_of_times_has_its_cause_and_ratio() {
    let history = history_with_steps();
    let case = history.json(&["show", "perf/made"]);
    let series = &case["adapters"][0]["series"][0];
    let changes = series["changes"].as_array().unwrap();
    let steps: Vec<_> = changes
        .iter()
        .map(|c| (&c["run"], &c["cause"], &c["state"]))
        .collect();
    let new = json!("new");
    assert_eq!(
        steps,
        [
            (&json!(21), &json!("driver"), &new),
            (&json!(34), &json!("machine"), &new)
        ]
    );
    let ratio = changes[0]["ratio"]["estimate"].as_f64().unwrap();
    assert!((1.19..1.21).contains(&ratio), "{ratio}");
    history.command(&["show", "perf/made"]).stdout(
        contains("  ruler  ▁")
            .and(contains("smallest visible change +"))
            .and(contains("the machine's: the ruler stepped along"))
            .and(contains("a step of +")),
    );
}

#[test]
fn a_step_of_times_is_open_until_triaged_and_no_entry_is_removed() {
    let history = history_with_steps();
    history
        .command(&["triage"])
        .stdout(contains("1 open change of frame times"));
    let settle = |arguments: &[&str]| {
        let subject = ["triage", "perf/made", "--adapter", "cpu"];
        history.command(&[&subject[..], arguments].concat())
    };
    settle(&["--step", "10", "--state", "real", "--reason", "r"])
        .code(64)
        .stderr(contains("does not change at run 10: changes are at 21, 34"));
    settle(&[
        "--step",
        "21",
        "--state",
        "real",
        "--reason",
        "a slower clear",
    ])
    .code(0);
    history
        .command(&["triage"])
        .stdout(contains("0 open changes"));
    history
        .command(&["triage", "--all"])
        .stdout(contains("real: a slower clear"));
    history
        .command(&["show", "perf/made"])
        .stdout(contains("real: a slower clear"));
    // The last entry counts.
    settle(&["--step", "21", "--state", "new"]).code(0);
    history
        .command(&["triage"])
        .stdout(contains("1 open change of"));
    let file = Connection::open(history.db()).unwrap();
    let entries: u32 = file
        .query_row("SELECT count(*) FROM triage", [], |row| row.get(0))
        .unwrap();
    assert_eq!(entries, 2);
}

#[test]
fn a_bad_verdict_is_open_until_triaged() {
    let history = HistoryFolder::new();
    history
        .command(&[
            "add",
            &history.run(1, "1", &GOOD),
            &history.run(2, "1", &BAD),
        ])
        .code(0);
    history.command(&["triage"]).code(0).stdout(
        contains("1 open bad verdict\n").and(contains(format!("{CASE} on cpu: fail since run 2"))),
    );
    let subject = ["triage", CASE, "--adapter", "cpu", "--state"];
    let settle = |arguments: &[&str]| history.command(&[&subject[..], arguments].concat());
    settle(&["ignored"])
        .code(64)
        .stderr(contains("needs a reason"));
    settle(&["ignored", "--reason", " "])
        .code(64)
        .stderr(contains("needs a reason"));
    settle(&["wrong", "--reason", "r"]).code(64);
    history.command(&["triage", CASE]).code(64);
    settle(&[
        "ignored",
        "--reason",
        "known\u{1b}[2J",
        "--author",
        "A. N. Other",
    ])
    .code(0)
    .stdout(contains("ignored: known").and(contains("\u{1b}").not()));
    let open_entries = history.json(&["triage"]);
    assert_eq!(open_entries, json!({"verdicts": [], "steps": []}));
    let triage = history.json(&["triage", "--all"]);
    assert_eq!(triage["verdicts"][0]["state"], "ignored");
    assert_eq!(triage["verdicts"][0]["since"], 2);
}
