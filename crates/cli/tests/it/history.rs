//! `etalon history`, tested through the binary.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, etalon};
use assert_cmd::assert::Assert;
use etalon_record::{
    AdapterRecord, BENCH_FORMAT, BenchHeader, BenchLine, BenchWriter, FORMAT, Header, Picture,
    Provenance, Record, Round, Settings, ShaderCache, Verdict,
};
use predicates::prelude::*;
use predicates::str::contains;
use rusqlite::Connection;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;

const CASE: &str = "depth/made/n=1";
const OTHER: &str = "depth/made/n=2";

/// A folder for runs and their history.
pub(crate) struct Place {
    pub(crate) folder: TempDir,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn db(&self) -> PathBuf {
        self.path("etalon.db")
    }

    /// Runs a history command on this folder's file.
    pub(crate) fn history(&self, arguments: &[&str]) -> Assert {
        let mut command = etalon(&["history"]);
        command.args(arguments).arg("--db").arg(self.db()).assert()
    }

    pub(crate) fn json(&self, arguments: &[&str]) -> Value {
        let assert = self.history(&[arguments, &["--format", "json"]].concat());
        serde_json::from_slice(&assert.code(0).get_output().stdout).unwrap()
    }

    /// Writes a run of `cpu` and returns its folder.
    pub(crate) fn run(&self, day: u32, version: &str, verdicts: &[(&str, Verdict)]) -> String {
        let folder = self.path(&format!("run-{day}"));
        fs::create_dir_all(&folder).unwrap();
        let header = header(day, version, verdicts.len() as u64);
        let mut text = serde_json::to_string(&header).unwrap() + "\n";
        for (case, verdict) in verdicts {
            text += &serde_json::to_string(&Record::new(*case, "cpu", *verdict)).unwrap();
            text.push('\n');
        }
        fs::write(folder.join("run.jsonl"), text).unwrap();
        folder.display().to_string()
    }

    /// Writes a bench of `cpu` with seven rounds, with about this frame time and ruler time.
    pub(crate) fn bench(&self, night: u32, seconds: f64, ruler: f64) -> String {
        let folder = self.path(&format!("bench-{night}"));
        let header = BenchHeader {
            format: BENCH_FORMAT,
            provenance: Provenance {
                etalon: "0.1.0".to_owned(),
                commit: Some(format!("{night:040x}")),
                started: started(night),
                command: vec!["etalon".to_owned()],
                ..Provenance::default()
            },
            profile: "quick".to_owned(),
            cases: 1,
            rounds: 7,
            shader_cache: ShaderCache::Warm,
            ruler: "counting".to_owned(),
            limits: Vec::new(),
            settings: Default::default(),
            adapters: vec![adapter("1.0")],
            absent: Vec::new(),
        };
        let mut writer = BenchWriter::create(&folder, &header).unwrap();
        let picture = Picture {
            case: "perf/made".to_owned(),
            adapter: "cpu".to_owned(),
            verdict: Verdict::Pass,
            asserted: 1.0,
            reasons: Vec::new(),
            work: None,
        };
        writer.append(&BenchLine::Picture(picture)).unwrap();
        for round in 0..7 {
            let jitter = 1.0 + f64::from((night * 7 + round * 5) % 11) / 2000.0;
            let time = seconds * jitter;
            let line = BenchLine::Round(Round {
                case: "perf/made".to_owned(),
                adapter: "cpu".to_owned(),
                round,
                at: f64::from(round),
                ruler: [ruler, ruler],
                prepare: 0.1,
                first: 0.1,
                warm_up: 1,
                wall: vec![time; 3],
                cpu: vec![time; 3],
                gpu: Vec::new(),
                clock: None,
                read_back: Vec::new(),
            });
            writer.append(&line).unwrap();
        }
        folder.display().to_string()
    }

    /// Returns all tables of the file as text.
    fn content(&self) -> String {
        let file = Connection::open(self.db()).unwrap();
        let count = |table: &str| -> i64 {
            file.query_row(&format!("SELECT count(*) FROM {table}"), [], |row| {
                row.get(0)
            })
            .unwrap()
        };
        let tables = [
            "run",
            "part",
            "change",
            "outcome",
            "test_case",
            "frame_time",
        ];
        tables
            .map(|table| format!("{table} {}", count(table)))
            .join(", ")
    }
}

/// Returns the day this many days after the first.
fn started(day: u32) -> String {
    format!(
        "20{:02}-{:02}-{:02}T02:00:00Z",
        24 + day / 336,
        day / 28 % 12 + 1,
        day % 28 + 1
    )
}

fn adapter(version: &str) -> AdapterRecord {
    let adapter = json!({
        "name": "cpu", "backend": "cpu", "device": "d", "driver": "etalon", "driver_version": version,
        "api_version": "1", "software": true,
        "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
            "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
    });
    serde_json::from_value(adapter).unwrap()
}

fn header(day: u32, version: &str, cases: u64) -> Header {
    Header {
        format: FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            commit: Some(format!("{day:040x}")),
            started: started(day),
            command: vec!["etalon".to_owned()],
            ..Provenance::default()
        },
        cases,
        settings: Settings {
            profile: Some("quick".to_owned()),
            ..Settings::default()
        },
        adapters: vec![adapter(version)],
        absent: Vec::new(),
    }
}

const GOOD: [(&str, Verdict); 2] = [(CASE, Verdict::Pass), (OTHER, Verdict::Pass)];
const BAD: [(&str, Verdict); 2] = [(CASE, Verdict::Fail), (OTHER, Verdict::Pass)];

#[test]
fn a_real_run_is_added_once() {
    let place = Place::new();
    let out = place.path("run").display().to_string();
    let run = ["run", "cull/points", "--adapter", "cpu", "--out", &out];
    etalon(&run).assert().code(0);
    let added = place.json(&["add", &out, "--label", "branch=main"]);
    assert_eq!(
        (&added[0]["added"], &added[0]["run"]),
        (&json!(true), &json!(1))
    );
    assert!(added[0]["records"].as_u64().unwrap() > 0, "{added}");
    let before = place.content();
    place
        .history(&["add", &out])
        .code(0)
        .stdout(contains("is run 1 already"));
    assert_eq!(place.content(), before);
    let runs = place.json(&["show"]);
    assert_eq!(runs.as_array().unwrap().len(), 1);
    assert_eq!(runs[0]["labels"], json!({ "branch": "main" }));
}

#[test]
fn the_file_is_named_by_flag_or_variable_or_is_beside_the_reports() {
    let place = Place::new();
    let run = place.run(1, "1", &GOOD);
    let add = |variable: Option<&Path>| {
        let mut command = etalon(&["history", "add", &run]);
        command
            .current_dir(place.folder.path())
            .env_remove("ETALON_HISTORY");
        command.envs(variable.map(|path| ("ETALON_HISTORY", path)));
        command.assert().code(0);
    };
    add(None);
    assert!(place.path("reports/etalon.db").is_file());
    add(Some(&place.path("deep/er/own.db")));
    assert!(place.path("deep/er/own.db").is_file());
}

#[test]
fn a_case_is_shown_with_its_events_and_their_versions() {
    let place = Place::new();
    for (day, version, verdicts) in [
        (1, "1.0", &GOOD),
        (2, "1.0", &GOOD),
        (3, "1.1", &BAD),
        (4, "1.1", &BAD),
        (5, "1.2", &GOOD),
    ] {
        place
            .history(&["add", &place.run(day, version, verdicts)])
            .code(0);
    }
    place.history(&["show", CASE]).code(0).stdout(
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
    let shown = place.json(&["show", CASE, "--adapter", "cpu"]);
    let of_cpu = &shown["adapters"][0];
    let verdicts = of_cpu["records"].as_array().unwrap().iter();
    let verdicts: Vec<&str> = verdicts.map(|r| r["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts, ["pass", "pass", "fail", "fail", "pass"]);
    assert_eq!(
        of_cpu["events"],
        json!([
            {"event": "broken", "after": 2, "at": 3}, {"event": "fixed", "after": 4, "at": 5}
        ])
    );
    place
        .history(&["show", OTHER])
        .stdout(contains("nothing happened"));
}

#[test]
fn old_runs_that_are_added_late_take_their_place() {
    let place = Place::new();
    place.history(&["add", &place.run(9, "1", &BAD)]).code(0);
    place.history(&["add", &place.run(4, "1", &GOOD)]).code(0);
    place
        .history(&["show", CASE])
        .stdout(contains("✓✗").and(contains("broken at run 1")));
    place
        .history(&["show", OTHER])
        .stdout(contains("cpu  2 runs, run"));
}

#[test]
fn runs_are_chosen_by_label() {
    let place = Place::new();
    let on = |branch: &str, run: &str| {
        place
            .history(&["add", run, "--label", &format!("branch={branch}")])
            .code(0);
    };
    on("main", &place.run(1, "1", &GOOD));
    on("other", &place.run(2, "1", &BAD));
    on("main", &place.run(3, "1", &GOOD));
    place.history(&["show", CASE]).stdout(contains("✓✗✓"));
    place
        .history(&["show", CASE, "--label", "branch=main"])
        .stdout(contains("  ✓✓\n"));
    place
        .history(&["show", CASE, "--label", "branch=none"])
        .code(4);
}

#[test]
fn hostile_labels_are_kept_and_give_no_orders_to_a_terminal() {
    let place = Place::new();
    let run = place.run(1, "1", &GOOD);
    let value = "a=b'; DROP TABLE run; -- \u{1b}[31m\u{202e}\n{{x}}";
    place
        .history(&["add", &run, "--label", &format!("note={value}")])
        .code(0);
    assert_eq!(place.json(&["show"])[0]["labels"]["note"], *value);
    place
        .history(&["show"])
        .code(0)
        .stdout(contains("\u{1b}").not().and(contains("\u{202e}").not()));
    let long = format!("key={}", "x".repeat(5000));
    for wrong in ["branch", "=main", "", &long] {
        let refused = place.history(&["add", &run, "--label", wrong]).code(64);
        let line = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
        assert_eq!(
            (line.lines().count(), line.contains("label")),
            (1, true),
            "{line}"
        );
    }
    place
        .history(&["add", &run, "--label", "a=1", "--label", "a=2"])
        .code(64);
    assert_eq!(place.json(&["show"]).as_array().unwrap().len(), 1);
}

#[test]
fn a_run_that_lacks_records_is_refused_and_then_taken() {
    let place = Place::new();
    let folder = place.run(1, "1", &GOOD);
    let file = Path::new(&folder).join("run.jsonl");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() - 40]).unwrap();
    let refused = place.history(&["add", &folder]).code(3);
    let line = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert_eq!(line.lines().count(), 1, "{line}");
    assert!(
        line.contains("lacks 1 record;") && line.contains("--resume"),
        "{line}"
    );
    assert!(line.contains(&folder), "{line}");
    assert_eq!(place.json(&["show"]), json!([]));
    place
        .history(&["add", &folder, "--incomplete"])
        .code(0)
        .stdout(contains("1 missing"));
    // The resumed run replaces the part that was already there.
    fs::write(&file, &text).unwrap();
    place.history(&["add", &folder]).code(0);
    place
        .history(&["show"])
        .stdout(contains("resumed as run 2"));
    place
        .history(&["show", CASE])
        .stdout(contains("cpu  1 run, run 2").and(contains("  ✓\n")));
}

#[test]
fn bad_input_is_one_line_and_the_rest_is_added() {
    let place = Place::new();
    let good = place.run(1, "1", &GOOD);
    let half = place.run(2, "1", &GOOD);
    fs::write(Path::new(&half).join("run.jsonl"), "{\"format\":3,\"etal").unwrap();
    let damaged = place.run(3, "1", &GOOD);
    let file = Path::new(&damaged).join("run.jsonl");
    let text = fs::read_to_string(&file)
        .unwrap()
        .replace("\"pass\"", "\"fine\"");
    fs::write(&file, text).unwrap();
    let nothing = place.path("nothing").display().to_string();
    let refused = place
        .history(&["add", &half, &damaged, &nothing, &good])
        .code(64);
    let lines = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert_eq!(lines.lines().count(), 3, "{lines}");
    for (line, path) in lines.lines().zip([&half, &damaged, &nothing]) {
        assert!(line.contains(path.as_str()), "{line}");
    }
    assert_eq!(place.json(&["show"]).as_array().unwrap().len(), 1);
    let dates = place.path("dates.json");
    fs::write(&dates, r#"{"cpu": {"1": "soon"}}"#).unwrap();
    let dates = dates.display().to_string();
    let wrong = place.history(&["add", &good, "--dates", &dates]).code(64);
    wrong.stderr(contains("dates.json").and(contains("is no date")));
}

#[test]
fn other_files_and_newer_ones_are_refused_and_stay_as_they_are() {
    let place = Place::new();
    let run = place.run(1, "1", &GOOD);
    place
        .history(&["show", CASE])
        .code(64)
        .stderr(contains("etalon history add"));
    for content in [
        "not a database, though long enough to look like one to a hasty reader",
        "{}",
    ] {
        fs::write(place.db(), content).unwrap();
        for arguments in [&["add", &run][..], &["show", CASE], &["triage"]] {
            place
                .history(arguments)
                .code(64)
                .stderr(contains("is no history of etalon"));
        }
        assert_eq!(fs::read_to_string(place.db()).unwrap(), content);
    }
    fs::remove_file(place.db()).unwrap();
    place.history(&["add", &run]).code(0);
    let file = Connection::open(place.db()).unwrap();
    file.pragma_update(None, "user_version", 1000).unwrap();
    drop(file);
    for arguments in [&["add", &run][..], &["show", CASE], &["triage"]] {
        let refused = place.history(arguments).code(64);
        refused.stderr(contains("has schema 1000").and(contains("use the etalon that wrote it")));
    }
}

#[test]
fn unknown_names_get_a_suggestion() {
    let place = Place::new();
    place.history(&["add", &place.run(1, "1", &GOOD)]).code(0);
    place
        .history(&["show", "depth/mode/n=1"])
        .code(64)
        .stderr(contains(format!("did you mean `{CASE}`")));
    let other = ["show", CASE, "--adapter", "cpi"];
    place
        .history(&other)
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
    place
        .history(&arguments)
        .code(64)
        .stderr(contains("did you mean"));
}

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

#[test]
fn releases_are_placed_at_their_dates() {
    let place = Place::new();
    let release = |version: &str| json!({"version": version, "adapter": format!("vulkan:a@{version}"), "driver": "d"});
    let header = json!({
        "format": 1, "etalon": "0.1.0", "machine": {"os": "o", "cpu": "c", "cores": 2},
        "started": "2026-11-23T06:04:56Z", "command": ["etalon"], "line": "a",
        "releases": [release("1"), release("2"), release("3")],
    });
    let case = json!({"case": CASE, "verdicts": ["fail", "fail", "pass"]});
    let file = place.path("versions.jsonl");
    fs::write(&file, format!("{header}\n{case}\n")).unwrap();
    let dates = place.path("dates.json");
    fs::write(&dates, r#"{"a": {"1": "2022-01-01", "3": "2024-01-01"}}"#).unwrap();
    let [file, dates] = [&file, &dates].map(|path| path.display().to_string());
    let added = place.history(&["add", &file, "--dates", &dates]).code(0);
    added.stderr(contains("no release date is known for a 2;"));
    place
        .history(&["show", CASE])
        .stdout(contains("✗✗✓").and(contains(
            "fixed at run 3 (2024-01-01), after run 2 (2022-01-01)",
        )));
}

#[test]
fn steps_of_times_are_found_reported_and_settled() {
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
fn a_bad_verdict_is_open_until_it_is_triaged() {
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
