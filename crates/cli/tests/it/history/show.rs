//! `etalon history show`: cases, order, labels and names.

use super::{BAD, CASE, GOOD, HistoryFolder, OTHER};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::json;
use std::fs;

#[test]
fn a_case_is_told_with_what_happened_and_between_which_versions() {
    let history = HistoryFolder::new();
    for (day, version, verdicts) in [
        (1, "1.0", &GOOD),
        (2, "1.0", &GOOD),
        (3, "1.1", &BAD),
        (4, "1.1", &BAD),
        (5, "1.2", &GOOD),
    ] {
        history
            .command(&["add", &history.run(day, version, verdicts)])
            .code(0);
    }
    history.command(&["show", CASE]).code(0).stdout(
        contains("✓✓✗✗✓")
            .and(contains(
                "broken at run 3 (2024-01-04), after run 2 (2024-01-03)",
            ))
            .and(contains(
                "pass before and fail then; driver 1.0 to 1.1, suite 000000000000",
            ))
            .and(contains("fixed at run 5"))
            .and(contains("now pass")),
    );
    let case = history.json(&["show", CASE, "--adapter", "cpu"]);
    let of_cpu = &case["adapters"][0];
    let verdicts = of_cpu["records"].as_array().unwrap().iter();
    let verdicts: Vec<&str> = verdicts.map(|r| r["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["pass", "pass", "fail", "fail", "pass"]);
    assert_eq!(
        of_cpu["events"],
        json!([
            {"event": "broken", "after": 2, "at": 3}, {"event": "fixed", "after": 4, "at": 5}
        ])
    );
    history
        .command(&["show", OTHER])
        .stdout(contains("nothing happened"));
}

#[test]
fn nightly_benches_between_runs_are_no_news() {
    let history = HistoryFolder::new();
    for night in 1..=3 {
        let run = history.run(2 * night, "1.0", &GOOD);
        let bench = history.bench(2 * night + 1, 0.01, 0.01);
        history.command(&["add", &run, &bench]).code(0);
    }
    let pages = history.path("pages").display().to_string();
    history.command(&["report", "--out", &pages]).code(0);
    let page = fs::read_to_string(history.path("pages/index.html")).unwrap();
    assert!(!page.contains("without a verdict on"), "{page}");
}

#[test]
fn an_adapter_that_never_drew_a_case_is_left_out_unless_it_is_named() {
    let history = HistoryFolder::new();
    let undrawn = [(CASE, etalon_record::Verdict::NotSupported)];
    history
        .command(&["add", &history.run(1, "1.0", &undrawn)])
        .code(0);
    history
        .command(&["show", CASE])
        .code(0)
        .stdout(contains("never drawn on cpu").and(contains("now not-supported").not()));
    history
        .command(&["show", CASE, "--adapter", "cpu"])
        .stdout(contains("now not-supported"));
}

#[test]
fn runs_are_ordered_by_start_not_by_addition() {
    let history = HistoryFolder::new();
    history
        .command(&["add", &history.run(9, "1", &BAD)])
        .code(0);
    history
        .command(&["add", &history.run(4, "1", &GOOD)])
        .code(0);
    history
        .command(&["show", CASE])
        .stdout(contains("✓✗").and(contains("broken at run 1")));
    history
        .command(&["show", OTHER])
        .stdout(contains("cpu  2 runs, run"));
}

#[test]
fn runs_are_chosen_by_label() {
    let history = HistoryFolder::new();
    let add_on_branch = |branch: &str, run: &str| {
        history
            .command(&["add", run, "--label", &format!("branch={branch}")])
            .code(0);
    };
    add_on_branch("main", &history.run(1, "1", &GOOD));
    add_on_branch("other", &history.run(2, "1", &BAD));
    add_on_branch("main", &history.run(3, "1", &GOOD));
    history.command(&["show", CASE]).stdout(contains("✓✗✓"));
    history
        .command(&["show", CASE, "--label", "branch=main"])
        .stdout(contains("  ✓✓\n"));
    history
        .command(&["show", CASE, "--label", "branch=none"])
        .code(4);
}

#[test]
fn unknown_names_come_with_near_ones() {
    let history = HistoryFolder::new();
    history
        .command(&["add", &history.run(1, "1", &GOOD)])
        .code(0);
    history
        .command(&["show", "depth/mode/n=1"])
        .code(64)
        .stderr(contains(format!("did you mean `{CASE}`")));
    let other = ["show", CASE, "--adapter", "cpi"];
    history
        .command(&other)
        .code(64)
        .stderr(contains("did you mean `cpu`?"));
    let arguments = [
        "triage",
        "depth/mode/n=1",
        "--adapter",
        "cpu",
        "--state",
        "real",
        "--reason",
        "r",
    ];
    history
        .command(&arguments)
        .code(64)
        .stderr(contains("did you mean"));
}

#[test]
fn releases_stand_at_their_dates() {
    let history = HistoryFolder::new();
    let release = |version: &str| json!({"version": version, "adapter": format!("vulkan:a@{version}"), "driver": "d"});
    let header = json!({
        "format": 1, "etalon": "0.1.0", "machine": {"os": "o", "cpu": "c", "cores": 2},
        "started": "2026-11-23T06:04:56Z", "command": ["etalon"], "line": "a",
        "releases": [release("1"), release("2"), release("3")],
    });
    let case = json!({"case": CASE, "verdicts": ["fail", "fail", "pass"]});
    let file = history.path("versions.jsonl");
    fs::write(&file, format!("{header}\n{case}\n")).unwrap();
    let dates = history.path("dates.json");
    fs::write(&dates, r#"{"a": {"1": "2022-01-01", "3": "2024-01-01"}}"#).unwrap();
    let [file, dates] = [&file, &dates].map(|path| path.display().to_string());
    let added = history.command(&["add", &file, "--dates", &dates]).code(0);
    added.stderr(contains("no release date is known for a 2;"));
    history
        .command(&["show", CASE])
        .stdout(contains("✗✗✓").and(contains(
            "fixed at run 3 (2024-01-01), after run 2 (2022-01-01)",
        )));
}
