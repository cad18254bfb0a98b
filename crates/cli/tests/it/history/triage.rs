//! `etalon history triage`: bad verdicts and steps of times.

use super::{BAD, CASE, GOOD, Place};
use predicates::prelude::*;
use predicates::str::contains;
use rusqlite::Connection;
use serde_json::json;

#[test]
fn steps_of_times_are_found_told_and_settled() {
    let place = Place::new();
    let mut add = vec!["add".to_owned()];
    for night in 0..45 {
        let seconds = if night < 20 { 0.001 } else { 0.0012 };
        // The machine slows down at night 33, and the ruler with it.
        let [seconds, ruler] = [seconds, 0.002].map(|t| if night < 33 { t } else { t * 1.1 });
        add.push(place.bench(night, seconds, ruler));
    }
    place
        .history(&add.iter().map(String::as_str).collect::<Vec<_>>())
        .code(0);
    let shown = place.json(&["show", "perf/made"]);
    let series = &shown["adapters"][0]["series"][0];
    let changes = series["changes"].as_array().unwrap();
    let places: Vec<_> = changes
        .iter()
        .map(|c| (&c["run"], &c["cause"], &c["state"]))
        .collect();
    let new = json!("new");
    assert_eq!(
        places,
        [
            (&json!(21), &json!("driver"), &new),
            (&json!(34), &json!("machine"), &new)
        ]
    );
    let ratio = changes[0]["ratio"]["estimate"].as_f64().unwrap();
    assert!((1.19..1.21).contains(&ratio), "{ratio}");
    place.history(&["show", "perf/made"]).stdout(
        contains("  ruler  ▁")
            .and(contains("smallest visible change +"))
            .and(contains("the machine's: the ruler stepped along"))
            .and(contains("a step of +")),
    );
    place
        .history(&["triage"])
        .stdout(contains("1 open change of frame times"));
    let settle = |arguments: &[&str]| {
        let subject = ["triage", "perf/made", "--adapter", "cpu"];
        place.history(&[&subject[..], arguments].concat())
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
    place
        .history(&["triage"])
        .stdout(contains("0 open changes"));
    place
        .history(&["triage", "--all"])
        .stdout(contains("real: a slower clear"));
    place
        .history(&["show", "perf/made"])
        .stdout(contains("real: a slower clear"));
    // The last entry counts, and no entry is removed.
    settle(&["--step", "21", "--state", "new"]).code(0);
    place
        .history(&["triage"])
        .stdout(contains("1 open change of"));
    let file = Connection::open(place.db()).unwrap();
    let entries: u32 = file
        .query_row("SELECT count(*) FROM triage", [], |row| row.get(0))
        .unwrap();
    assert_eq!(entries, 2);
}

#[test]
fn what_is_bad_is_open_until_somebody_says_what_it_is() {
    let place = Place::new();
    place
        .history(&["add", &place.run(1, "1", &GOOD), &place.run(2, "1", &BAD)])
        .code(0);
    place.history(&["triage"]).code(0).stdout(
        contains("1 open bad verdict\n").and(contains(format!("{CASE} on cpu: fail since run 2"))),
    );
    let settle = ["triage", CASE, "--adapter", "cpu", "--state"];
    let with = |more: &[&str]| place.history(&[&settle[..], more].concat());
    with(&["ignored"])
        .code(64)
        .stderr(contains("needs a reason"));
    with(&["ignored", "--reason", " "])
        .code(64)
        .stderr(contains("needs a reason"));
    with(&["wrong", "--reason", "r"]).code(64);
    place.history(&["triage", CASE]).code(64);
    with(&[
        "ignored",
        "--reason",
        "known\u{1b}[2J",
        "--author",
        "A. N. Other",
    ])
    .code(0)
    .stdout(contains("ignored: known").and(contains("\u{1b}").not()));
    let left = place.json(&["triage"]);
    assert_eq!(left, json!({"verdicts": [], "steps": []}));
    let triage = place.json(&["triage", "--all"]);
    assert_eq!(triage["verdicts"][0]["state"], "ignored");
    assert_eq!(triage["verdicts"][0]["since"], 2);
}
