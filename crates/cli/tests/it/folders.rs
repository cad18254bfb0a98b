//! What a command finds in its output folder: foreign files stay unchanged.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use predicates::str::contains;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const CASE: &str = "cull/points/cull=none/front_face=cw";

/// Writes the files of a foreign project.
fn project(folder: &Path) {
    for (name, text) in [
        ("index.html", "<p>mine"),
        ("summary.md", "mine"),
        ("junit.xml", "<mine/>"),
        ("mutants.html", "mine"),
        ("versions.html", "mine"),
        ("recall.txt", "mine"),
        ("cases/points.json", "{}"),
        ("cases/depth.js", "mine"),
        ("results/cpu.csv", "mine"),
        ("frames/a/b.json", "mine"),
        ("found/a.json", "mine"),
        ("known/b.json", "mine"),
        ("data/runs.js", "mine"),
        ("runs/a/index.html", "mine"),
        ("work/notes.txt", "mine"),
    ] {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

/// Returns the files below a folder, with their contents.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(self::files(&path));
        } else {
            files.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    files
}

fn run_into(out: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = etalon(&["run", CASE, "--adapter", "cpu", "--out"]);
    command.arg(out).args(more).assert()
}

/// A file with two releases of one driver line, for a search over them.
fn lines(folder: &Path) -> PathBuf {
    let release = |version: &str| json!({ "name": format!("cpu@{version}"), "backend": "cpu", "line": "ours", "version": version });
    let file = folder.join("lines.json");
    fs::write(&file, json!([release("1"), release("2")]).to_string()).unwrap();
    file
}

#[test]
fn no_command_writes_into_a_folder_of_somebody_else() {
    let work = tempfile::tempdir().unwrap();
    let (mine, run) = (work.path().join("mine"), work.path().join("run"));
    project(&mine);
    run_into(&run, &[]).success();
    let before = files(&mine);
    let lines = lines(work.path());
    let [run, lines] = [&run, &lines].map(|path| path.to_str().unwrap());
    let db = work.path().join("history.db");
    let db = db.to_str().unwrap();
    etalon(&["history", "add", run, "--db", db])
        .assert()
        .success();
    let out = mine.to_str().unwrap();
    for command in [
        vec!["run", CASE, "--adapter", "cpu", "--out", out],
        vec!["run", CASE, "--adapter", "cpu", "--out", out, "--resume"],
        vec!["bench", "perf/matrix/*", "--adapter", "cpu", "--out", out],
        vec!["merge", run, "--out", out],
        vec!["fuzz", "--adapter", "cpu", "--count", "1", "--out", out],
        vec![
            "bisect",
            CASE,
            "--line",
            "ours",
            "--adapters",
            lines,
            "--out",
            out,
        ],
        vec!["mutants", "depth/*", "--case", CASE, "--out", out],
        vec!["mutants", "depth/*", "--fuzz", "1", "--out", out],
        vec!["site", out, run],
        vec!["history", "report", "--db", db, "--out", out],
        vec!["history", "export", "--db", db, "--format", "otava", out],
    ] {
        let forced = ["run", "bench", "merge", "fuzz", "bisect", "site"];
        let takes_force = forced.contains(&command[0]) && !command.contains(&"--resume");
        for force in [&[][..], &["--force"]] {
            if !force.is_empty() && !takes_force {
                continue;
            }
            let ended = etalon(&command).args(force).assert().code(64);
            let said = String::from_utf8_lossy(&ended.get_output().stderr).into_owned();
            assert!(said.contains(out), "{command:?}: {said}");
            assert_eq!(files(&mine), before, "{command:?} {force:?}");
        }
    }
}

#[test]
fn a_file_of_our_name_without_our_header_marks_nothing() {
    let work = tempfile::tempdir().unwrap();
    for name in [
        "run.jsonl",
        "bench.jsonl",
        "fuzz.jsonl",
        "versions.jsonl",
        "mutants.json",
    ] {
        let mine = work.path().join(name);
        project(&mine);
        fs::write(mine.join(name), "{\"format\":4}\n").unwrap();
        let before = files(&mine);
        run_into(&mine, &["--force"])
            .code(64)
            .stderr(contains(name));
        assert_eq!(files(&mine), before, "{name}");
    }
    for (name, command) in [("site.json", "site"), ("history.json", "history")] {
        let mine = work.path().join(name);
        fs::create_dir_all(mine.join("data")).unwrap();
        fs::write(mine.join("index.html"), "mine").unwrap();
        fs::write(mine.join(name), "{\"cases\":[]}").unwrap();
        let before = files(&mine);
        let run = work.path().join("run");
        run_into(&run, &["--force"]).success();
        let db = work.path().join("history.db");
        etalon(&["history", "add"])
            .arg(&run)
            .arg("--db")
            .arg(&db)
            .assert()
            .success();
        match command {
            "site" => etalon(&["site", "--force"]).arg(&mine).arg(&run).assert(),
            _ => etalon(&["history", "report", "--db"])
                .arg(&db)
                .arg("--out")
                .arg(&mine)
                .assert(),
        }
        .code(64);
        assert_eq!(files(&mine), before, "{name}");
    }
}

#[test]
fn what_is_replaced_is_what_we_wrote() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    run_into(&out, &[]).success();
    let mine = [
        "notes.txt",
        "cases/notes.json",
        "results/notes.txt",
        "frames/a/notes.txt",
    ];
    for name in mine {
        let path = out.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    }
    fs::write(out.join("cases/gone.js"), "ours").unwrap();
    run_into(&out, &["--force"]).success();
    assert!(!out.join("cases/gone.js").exists());
    etalon(&[
        "fuzz",
        "--adapter",
        "cpu",
        "--count",
        "1",
        "--force",
        "--out",
    ])
    .arg(&out)
    .assert()
    .success();
    assert!(!out.join("run.jsonl").exists() && !out.join("index.html").exists());
    for name in mine {
        assert_eq!(
            fs::read_to_string(out.join(name)).unwrap(),
            "mine",
            "{name}"
        );
    }
    // A foreign file in a folder that would be replaced as a whole is named.
    let site = work.path().join("site");
    let run = work.path().join("other");
    run_into(&run, &[]).success();
    etalon(&["site"]).arg(&site).arg(&run).assert().success();
    let note = site.join("runs/other/notes.txt");
    fs::write(&note, "mine").unwrap();
    etalon(&["site", "--force"])
        .arg(&site)
        .arg(&run)
        .assert()
        .code(64)
        .stderr(contains("notes.txt"));
    fs::remove_file(&note).unwrap();
    etalon(&["site", "--force"])
        .arg(&site)
        .arg(&run)
        .assert()
        .success();
}

#[test]
fn the_folder_of_cases_is_apart_from_what_is_written() {
    let work = tempfile::tempdir().unwrap();
    let cases = work.path().join("in/cases");
    fs::create_dir_all(&cases).unwrap();
    let text = include_str!("../../../../cases/cull/points.json");
    fs::write(cases.join("points.json"), text).unwrap();
    let before = files(work.path());
    for out in ["in/cases", "in/cases/new", "in", "in/other/../cases/run"] {
        for command in [
            &["run", "--force"][..],
            &["mutants"],
            &["bench", "points", "--force"],
        ] {
            etalon(command)
                .arg("--cases")
                .arg(&cases)
                .arg("--out")
                .arg(work.path().join(out))
                .assert()
                .code(64)
                .stderr(contains("must not be inside each other"));
        }
        assert_eq!(files(work.path()), before, "{out}");
    }
    let beside = work.path().join("in/run");
    etalon(&["run", "--adapter", "cpu", "--cases"])
        .arg(&cases)
        .arg("--out")
        .arg(beside)
        .assert()
        .success();
}
