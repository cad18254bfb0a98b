//! `etalon run --history`: what is new, what counts, and what happens without the history.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use crate::history::HistoryFolder;
use assert_cmd::assert::Assert;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;

/// An adapter on which some scenes crash.
const ADAPTER: &str = "cpu:fault=abort";

fn run(history: &HistoryFolder, out: &str, arguments: &[&str]) -> Assert {
    let mut command = etalon(&["run", "cull/*", "--adapter", ADAPTER, "--out"]);
    command.arg(history.path(out)).args(arguments).assert()
}

/// The same with this folder's history, on branch main.
fn compared(history: &HistoryFolder, out: &str, arguments: &[&str]) -> Assert {
    let db = history.db().display().to_string();
    let flags = ["--history", &db, "--label", "branch=main"];
    run(history, out, &[&flags[..], arguments].concat())
}

fn add(history: &HistoryFolder, out: &str, branch: &str) {
    let folder = history.path(out).display().to_string();
    let label = format!("branch={branch}");
    history
        .command(&["add", &folder, "--label", &label])
        .code(0);
}

/// Copies a run to an earlier day with a pass for the cases that crashed. Returns these cases.
fn well_before(history: &HistoryFolder, from: &str, to: &str) -> Vec<String> {
    before(history, from, to, "2025-01-01T00:00:00Z", "pass")
}

/// Copies a run to another day with this verdict for the cases that crashed. Returns these cases.
fn before(history: &HistoryFolder, from: &str, to: &str, day: &str, verdict: &str) -> Vec<String> {
    let text = fs::read_to_string(history.path(from).join("run.jsonl")).unwrap();
    let mut bad = Vec::new();
    let lines = text.lines().map(|line| {
        let mut value: Value = serde_json::from_str(line).unwrap();
        if value["started"].is_string() {
            value["started"] = json!(day);
        } else if value["verdict"] == "crash" {
            bad.push(value["case"].as_str().unwrap().to_owned());
            value["verdict"] = json!(verdict);
        }
        value.to_string() + "\n"
    });
    let text: String = lines.collect();
    fs::create_dir_all(history.path(to)).unwrap();
    fs::write(history.path(to).join("run.jsonl"), text).unwrap();
    let [from, to] = [from, to].map(|folder| history.path(folder).join("cases.txt"));
    fs::copy(from, to).unwrap();
    bad
}

#[test]
fn news_come_first_and_what_is_settled_does_not_count() {
    let history = HistoryFolder::new();
    run(&history, "first", &[]).code(1);
    let bad = well_before(&history, "first", "well");
    let n = bad.len();
    assert!(n > 1, "{bad:?}");

    // A run of another branch is not compared.
    add(&history, "well", "other");
    compared(&history, "alone", &[]).code(1).stdout(
        contains("no earlier run to compare with")
            .and(contains(format!("{n} bad, nothing to compare"))),
    );
    fs::remove_file(history.db()).unwrap();

    add(&history, "well", "main");
    compared(&history, "second", &[])
        .code(1)
        .stdout(contains(format!("{n} broken since the last run")).and(contains("pass before")))
        .stderr(contains("etalon history add").and(contains("--label branch=main")));
    let summary = fs::read_to_string(history.path("second").join("summary.md")).unwrap();
    let new = summary.find("broken since the last run").unwrap();
    assert!(new < summary.find("## Adapters").unwrap(), "{summary}");

    // Cases that were broken before are not new, but count until they are triaged.
    add(&history, "second", "main");
    // Runs are distinguished by the second in which they began.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    let output = compared(&history, "third", &["--format", "json"]).code(1);
    let comparison: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let count = |kind: &str| comparison["news"][kind].as_array().unwrap().len();
    assert_eq!([count("broken"), count("fixed"), count("old")], [0, 0, n]);

    let settle = |case: &str, state: &str| {
        let said = ["triage", case, "--adapter", ADAPTER, "--state", state];
        history
            .command(&[&said[..], &["--reason", "looked at"]].concat())
            .code(0);
    };
    for case in &bad[1..] {
        settle(case, "ignored");
    }
    compared(&history, "fourth", &[]).code(1);
    settle(&bad[0], "real");
    compared(&history, "fifth", &[])
        .code(0)
        .stdout(contains(format!("{n} settled by triage, not counted")));
    let summary = fs::read_to_string(history.path("fifth").join("summary.md")).unwrap();
    assert!(summary.contains("Nothing unexpected"), "{summary}");
    // A case that is triaged as fixed but is not, counts.
    settle(&bad[0], "fixed");
    compared(&history, "sixth", &[]).code(1);
    // A merge gives the same verdict.
    let merge = |branch: &str| {
        let mut command = etalon(&["merge", "--force", "--label", branch, "--history"]);
        command
            .arg(history.db())
            .arg("--out")
            .arg(history.path("merged"));
        command.arg(history.path("fifth")).assert()
    };
    merge("branch=main")
        .code(1)
        .stdout(contains("1 unexpected as before"));
    settle(&bad[0], "real");
    merge("branch=main").code(0);
}

#[test]
fn what_is_mended_is_news() {
    let history = HistoryFolder::new();
    run(&history, "bad", &[]).code(1);
    let bad = well_before(&history, "bad", "well");
    // The failing run comes first, and a good one is merged after it. A later run changes nothing.
    before(&history, "bad", "older", "2024-01-01T00:00:00Z", "crash");
    add(&history, "older", "main");
    add(&history, "bad", "main");
    let mut command = etalon(&["merge", "--label", "branch=main", "--history"]);
    command
        .arg(history.db())
        .arg("--out")
        .arg(history.path("merged"));
    command.arg(history.path("well")).assert().code(0).stdout(
        contains(format!("{} fixed since the last run", bad.len())).and(contains("2024-01-01")),
    );
}

/// The number of lines of a status in deqp-runner's list of a folder.
fn listed(history: &HistoryFolder, out: &str, status: &str) -> usize {
    let mut lists = fs::read_dir(history.path(out).join("results")).unwrap();
    let text = fs::read_to_string(lists.next().unwrap().unwrap().path()).unwrap();
    let statuses = text.lines().filter_map(|line| line.split(',').nth(1));
    statuses.filter(|found| *found == status).count()
}

#[test]
fn reports_made_anew_say_what_the_run_said_and_agree_with_the_exit_code() {
    let history = HistoryFolder::new();
    run(&history, "first", &[]).code(1);
    let bad = well_before(&history, "first", "well");
    add(&history, "well", "main");
    compared(&history, "second", &[]).code(1);
    let read = |name: &str| fs::read_to_string(history.path("second").join(name)).unwrap();
    let summary = read("summary.md");
    assert!(summary.contains("broken since the last run"), "{summary}");

    // The history now has the run, and a later one.
    add(&history, "second", "main");
    compared(&history, "third", &[]).code(1);
    add(&history, "third", "main");
    let db = history.db().display().to_string();
    let report = |flags: &[&str]| {
        let mut command = etalon(&["report"]);
        command.arg(history.path("second")).args(flags).assert()
    };
    let flags = ["--history", &db, "--label", "branch=main", "--deqp"];
    report(&[]).code(1);
    assert_ne!(read("summary.md"), summary);
    report(&flags)
        .code(1)
        .stdout(contains("broken since the last run"));
    assert_eq!(read("summary.md"), summary);
    let failed = || listed(&history, "second", "Crash");
    assert_eq!(failed(), bad.len());

    // The triage state is also in the files for other programs.
    for (case, state) in bad.iter().zip(["real", "ignored"].into_iter().cycle()) {
        let said = ["triage", case, "--adapter", ADAPTER, "--state", state];
        let reason = ["--reason", "looked <at> it"];
        history.command(&[&said[..], &reason].concat()).code(0);
    }
    report(&flags)
        .code(0)
        .stdout(contains("unexpected record").not());
    compared(&history, "fourth", &[]).code(0);
    assert!(!history.path("fourth").join("results").exists());
    for out in ["second", "fourth"] {
        let read = |name: &str| fs::read_to_string(history.path(out).join(name)).unwrap();
        let junit = read("junit.xml");
        assert!(junit.contains("failures=\"0\" errors=\"0\""), "{junit}");
        assert!(!junit.contains("<failure") && !junit.contains("<error"));
        for state in ["real", "ignored"] {
            let message = format!("expected: triage {state}: looked &lt;at&gt; it");
            assert!(junit.contains(&message), "{message}: {junit}");
        }
        assert!(read("index.html").contains("nothing unexpected"));
        assert!(read("summary.md").contains("Nothing unexpected."));
        // The record itself stays unchanged.
        assert!(!read("run.jsonl").contains("looked"));
    }
    assert_eq!(failed(), 0);
    assert_eq!(listed(&history, "second", "ExpectedFail"), bad.len());
    // A report that the folder has is renewed without being asked for.
    report(&[]).code(1);
    assert_eq!(failed(), bad.len());
}

#[test]
fn a_history_for_reports_is_refused_or_told_as_for_runs() {
    let history = HistoryFolder::new();
    run(&history, "run", &[]).code(1);
    let report = |flags: &[&str]| {
        let mut command = etalon(&["report"]);
        command.arg(history.path("run")).args(flags).assert()
    };
    let db = history.db().display().to_string();
    report(&["--history", &db])
        .code(1)
        .stderr(contains("there is no history at"));
    report(&["--label", "branch=main"])
        .code(64)
        .stderr(contains("--history"));
    fs::write(history.db(), "something else, which is long enough").unwrap();
    report(&["--history", &db])
        .code(64)
        .stderr(contains("is no history of etalon"));
}

#[test]
fn a_history_that_is_lost_changes_nothing_and_is_told() {
    let history = HistoryFolder::new();
    compared(&history, "run", &[])
        .code(1)
        .stderr(contains("there is no history at").and(contains("judged without a history")));
    assert!(!history.db().exists());
}

#[test]
fn a_file_that_is_no_history_is_refused_before_anything_is_drawn() {
    let history = HistoryFolder::new();
    fs::write(
        history.db(),
        "something else, which is long enough to be read",
    )
    .unwrap();
    compared(&history, "run", &[])
        .code(64)
        .stderr(contains("is no history of etalon"));
    assert!(!history.path("run").exists());
    // Without a history, labels limit expectations, but must still be valid.
    run(&history, "run", &["--label", "branch"])
        .code(64)
        .stderr(contains("branch"));
    assert!(!history.path("run").exists());
}

#[test]
fn a_failure_that_became_a_crash_is_news_and_a_crash_that_is_not_drawn_is_not_fixed() {
    let history = HistoryFolder::new();
    run(&history, "now", &[]).code(1);
    let bad = before(&history, "now", "then", "2025-01-01T00:00:00Z", "fail");
    let n = bad.len();
    add(&history, "then", "main");
    compared(&history, "second", &[])
        .code(1)
        .stdout(contains(format!("{n} broken since the last run")).and(contains("fail before")));
    before(
        &history,
        "now",
        "gone",
        "2026-01-01T00:00:00Z",
        "not-supported",
    );
    before(&history, "now", "crashed", "2025-06-01T00:00:00Z", "crash");
    add(&history, "crashed", "main");
    let mut command = etalon(&["merge", "--label", "branch=main", "--history"]);
    command
        .arg(history.db())
        .arg("--out")
        .arg(history.path("merged"));
    command.arg(history.path("gone")).assert().code(0).stdout(
        contains("0 fixed since the last run")
            .and(contains(format!("{n} no longer counted, but not fixed"))),
    );
}

#[test]
fn a_rehearsal_breaks_an_adapter_under_its_own_name() {
    let history = HistoryFolder::new();
    let adapter = ["--adapter", "gl:llvmpipe", "--out"];
    let run = ["run", "cull/points"];
    let night = history.path("night");
    let mut first = etalon(&[&run[..], &adapter].concat());
    first.arg(&night).assert().code(0);
    history
        .command(&["add", &night.display().to_string()])
        .code(0);
    // Runs are distinguished by the second in which they began.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../ci/adapters/rehearsal.json"
    );
    let mut second = etalon(&[&run[..], &["--adapters", file], &adapter].concat());
    second
        .arg(history.path("rehearsal"))
        .arg("--history")
        .arg(history.db());
    let broken = contains("2 broken since the last run").and(contains("pass before"));
    second.assert().code(1).stdout(broken);
}
