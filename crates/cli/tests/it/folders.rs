//! What a command finds in its output folder: foreign files stay unchanged.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use predicates::str::contains;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const CASE: &str = "cull/points/cull=none/front_face=cw";
/// A run with a failure, so that it has a frame.
#[cfg(unix)]
const FAILING: [&str; 5] = ["run", CASE, "--adapter", "gl:softpipe", "--expect-only"];

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
        vec![
            "history",
            "export",
            "--db",
            db,
            "--format",
            "openmetrics",
            out,
        ],
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
            _ => etalon(&["history", "report", "--force", "--db"])
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
fn a_site_with_a_foreign_file_is_not_replaced() {
    let work = tempfile::tempdir().unwrap();
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

/// A file of each kind that a user could have in a recorded folder, with names like those of etalon.
const MINE: [&str; 9] = [
    "notes.txt",
    "cases/mine.js",
    "pictures/mine.png",
    "results/mine.csv",
    "frames/cpu/cull/mine.json.gz",
    "found/mine.json",
    "known/mine.json",
    "work/mine.txt",
    "data/mine.js",
];

/// A command that writes into a folder.
struct Writing {
    arguments: Vec<String>,
    /// True if `--force` is a flag of it.
    takes_force: bool,
    /// A file at the top that it writes.
    writes: &'static str,
    /// True if it adds files to a folder that can hold others.
    adds: bool,
}

impl Writing {
    fn new(writes: &'static str, arguments: &[&str]) -> Self {
        Self {
            arguments: arguments.iter().map(|word| (*word).to_owned()).collect(),
            takes_force: true,
            writes,
            adds: false,
        }
    }

    fn run(&self, to: &Path, force: bool) -> (i32, String) {
        let to = to.to_str().unwrap();
        let words = self.arguments.iter().map(|word| word.replace("OUT", to));
        let words: Vec<String> = words.collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let mut command = etalon(&words);
        if force {
            command.arg("--force");
        }
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().unwrap(), said)
    }
}

fn copy(from: &Path, to: &Path) {
    for (path, bytes) in files(from) {
        let path = to.join(path.strip_prefix(from).unwrap());
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

/// Every command that writes a folder; the first seven write one of each kind.
fn writing(work: &Path) -> Vec<Writing> {
    let lines = lines(work);
    let lines = lines.to_str().unwrap();
    let run = work.join("run");
    run_into(&run, &[]).success();
    let run = run.to_str().unwrap();
    let db = work.join("history.db");
    let db = db.to_str().unwrap();
    etalon(&["history", "add", run, "--db", db])
        .assert()
        .success();
    let cpu = ["--adapter", "cpu", "--out", "OUT"];
    let with = |first: &[&'static str]| [first, &cpu].concat();
    let bisect = ["bisect", CASE, "--line", "ours", "--adapters", lines];
    let added = |writes, arguments: &[&str]| Writing {
        adds: true,
        ..Writing::new(writes, arguments)
    };
    vec![
        Writing::new("junit.xml", &with(&["run", CASE])),
        Writing::new(
            "bencher.json",
            &with(&[
                "bench",
                "perf/matrix/clear/*",
                "--rounds",
                "1",
                "--seconds",
                "0.001",
            ]),
        ),
        Writing::new("fuzz.jsonl", &with(&["fuzz", "--count", "1"])),
        Writing::new("versions.html", &[&bisect[..], &["--out", "OUT"]].concat()),
        Writing::new(
            "mutants.html",
            &["mutants", "cull/*", "--case", CASE, "--out", "OUT"],
        ),
        Writing::new("index.html", &["site", "OUT", run]),
        Writing::new(
            "index.html",
            &["history", "report", "--db", db, "--out", "OUT"],
        ),
        Writing::new("junit.xml", &["merge", run, "--out", "OUT"]),
        Writing::new(
            "recall.txt",
            &["mutants", "cull/*", "--fuzz", "1", "--out", "OUT"],
        ),
        Writing {
            takes_force: false,
            ..Writing::new(
                "history.om",
                &[
                    "history",
                    "export",
                    "--db",
                    db,
                    "--format",
                    "openmetrics",
                    "OUT",
                ],
            )
        },
        added("etalon-run.1", &["man", "--out", "OUT"]),
        added(
            "fails.txt",
            &["expectations", "export", "--adapter", "cpu", "--out", "OUT"],
        ),
        added(
            "cull-points-cull-none-front_face-cw.gl-softpipe.json",
            &["reduce", CASE, "--adapter", "gl:softpipe", "--out", "OUT"],
        ),
        added(
            "cull-points-cull-none-front_face-cw.gl-softpipe.tar.gz",
            &["bundle", CASE, "--adapter", "gl:softpipe", "--out", "OUT"],
        ),
    ]
}

/// The table: each command into each kind of folder, alone and with files of a user, with and without `--force`.
#[test]
fn a_command_replaces_what_etalon_wrote_only_when_forced_and_nothing_else_ever() {
    let work = tempfile::tempdir().unwrap();
    let commands = writing(work.path());
    let mut kinds = Vec::new();
    for (number, command) in commands.iter().take(7).enumerate() {
        let to = work.path().join(format!("kind-{number}"));
        let (code, said) = command.run(&to, false);
        assert_ne!(code, 64, "{:?}: {said}", command.arguments);
        assert!(to.join(command.writes).is_file(), "{:?}", command.arguments);
        kinds.push(to);
    }
    let to = work.path().join("to");
    for (number, command) in commands.iter().enumerate() {
        // Commands that take long meet two kinds; what they share is tried with the others.
        let most = if command.arguments.iter().any(|word| word == "gl:softpipe") {
            2
        } else {
            7
        };
        for (place, kind) in kinds.iter().enumerate().take(most) {
            for force in [false, true] {
                // A refusal is quick. Each command replaces some of the kinds, and all together replace each.
                let skips = (number + place) % 7 > 2 && most == 7;
                if force && (!command.takes_force || skips) {
                    continue;
                }
                let what = format!("{:?} into {} {force}", command.arguments, kind.display());
                copy(kind, &to);
                for name in MINE {
                    let path = to.join(name);
                    fs::create_dir_all(path.parent().unwrap()).unwrap();
                    fs::write(path, "mine").unwrap();
                }
                let before = files(&to);
                let (code, said) = command.run(&to, force);
                let after = files(&to);
                if code == 64 {
                    let lock = to.join(".lock");
                    let is_kept = |(path, _): &(&PathBuf, &Vec<u8>)| **path != lock;
                    let after: Vec<_> = after.iter().filter(is_kept).collect();
                    let before: Vec<_> = before.iter().filter(is_kept).collect();
                    assert!(after == before, "{what}: {said}");
                } else {
                    assert!(force || command.adds, "{what} was not refused");
                    assert!(to.join(command.writes).is_file(), "{what}: {said}");
                }
                for name in MINE {
                    let text = fs::read_to_string(to.join(name)).unwrap_or_default();
                    assert_eq!(text, "mine", "{what}: {name}");
                }
                if command.adds {
                    let lost = before
                        .iter()
                        .find(|(path, bytes)| after.get(*path) != Some(*bytes));
                    assert!(lost.is_none(), "{what}: {lost:?}");
                }
                fs::remove_dir_all(&to).unwrap();
            }
        }
    }
}

#[test]
fn a_file_of_a_user_under_a_name_of_ours_is_never_replaced() {
    let work = tempfile::tempdir().unwrap();
    let run = work.path().join("old");
    run_into(&run, &[]).success();
    for command in writing(work.path()) {
        let to = work.path().join("to");
        if !command.adds {
            copy(&run, &to);
        }
        fs::create_dir_all(&to).unwrap();
        if !command.adds {
            let list = fs::read_to_string(to.join(".files")).unwrap();
            let is_kept = |line: &&str| !line.ends_with(command.writes);
            let lines: Vec<&str> = list.lines().filter(is_kept).collect();
            fs::write(to.join(".files"), lines.join("\n")).unwrap();
        }
        fs::write(to.join(command.writes), "mine").unwrap();
        let before = files(&to);
        let force = command.takes_force && !command.adds;
        let (code, said) = command.run(&to, force);
        assert_eq!(code, 64, "{:?}: {said}", command.arguments);
        let mut after = files(&to);
        after.remove(&to.join(".lock"));
        let before: BTreeMap<_, _> = before
            .into_iter()
            .filter(|(path, _)| *path != to.join(".lock"))
            .collect();
        assert!(after == before, "{:?}: {said}", command.arguments);
        fs::remove_dir_all(&to).unwrap();
    }
}

#[test]
fn adding_commands_replace_their_own_names_when_forced() {
    let work = tempfile::tempdir().unwrap();
    let to = work.path().join("to");
    for command in writing(work.path()).iter().filter(|command| command.adds) {
        assert_eq!(command.run(&to, false).0, 0, "{:?}", command.arguments);
        let (code, said) = command.run(&to, false);
        assert!(
            code == 64 && said.contains("--force"),
            "{:?}: {said}",
            command.arguments
        );
        assert_eq!(command.run(&to, true).0, 0, "{:?}", command.arguments);
    }
}

#[cfg(unix)]
#[test]
fn links_in_a_folder_are_neither_written_through_nor_copied() {
    use std::os::unix::fs::symlink;
    let work = tempfile::tempdir().unwrap();
    let secret = work.path().join("secret");
    fs::write(&secret, "the secret").unwrap();
    let out = work.path().join("run");
    let failing = |more: &[&str]| etalon(&FAILING).arg("--out").arg(&out).args(more).assert();
    for name in [
        "index.html",
        "junit.xml",
        "frames",
        "cases",
        "run.jsonl",
        ".files",
        ".lock",
    ] {
        failing(&["--force"]).code(1);
        let path = out.join(name);
        if path.is_dir() {
            fs::remove_dir_all(&path).unwrap();
        } else {
            fs::remove_file(&path).unwrap();
        }
        symlink(&secret, &path).unwrap();
        failing(&["--force"]).code(64).stderr(contains("run"));
        assert_eq!(fs::read_to_string(&secret).unwrap(), "the secret", "{name}");
        fs::remove_dir_all(&out).unwrap();
    }
    failing(&[]).code(1);
    symlink(work.path(), out.join("results")).unwrap();
    etalon(&["report", "--deqp"]).arg(&out).assert().code(64);
    assert!(!work.path().join("gl_softpipe.csv").exists());
    fs::remove_file(out.join("results")).unwrap();
    let frame = files(&out)
        .into_keys()
        .find(|path| path.to_string_lossy().ends_with(".json.gz"))
        .unwrap();
    fs::remove_file(&frame).unwrap();
    symlink(&secret, &frame).unwrap();
    symlink(&secret, out.join("secret.json")).unwrap();
    let merged = work.path().join("merged");
    let ended = etalon(&["merge", "--out"]).arg(&merged).arg(&out).assert();
    ended.code(64).stderr(contains("is a link"));
    fs::create_dir(&merged).unwrap();
    let bundles = work.path().join("bundles");
    fs::create_dir(&bundles).unwrap();
    let archive = "cull-points-cull-none-front_face-cw.gl-softpipe.tar.gz";
    symlink(&secret, bundles.join(archive)).unwrap();
    etalon(&[
        "bundle",
        CASE,
        "--adapter",
        "gl:softpipe",
        "--force",
        "--out",
    ])
    .arg(&bundles)
    .assert()
    .code(64);
    assert_eq!(fs::read_to_string(&secret).unwrap(), "the secret");
    // A link to a folder stays one.
    let [data, site] = ["data", "site"].map(|name| work.path().join(name));
    fs::create_dir(&data).unwrap();
    symlink(&data, &site).unwrap();
    etalon(&["site"]).arg(&site).arg(&out).assert().code(0);
    assert!(site.is_symlink() && data.join("index.html").is_file());
    for folder in [&merged, &site] {
        for (path, bytes) in files(folder) {
            let text = String::from_utf8_lossy(&bytes);
            assert!(!text.contains("the secret"), "{}", path.display());
        }
    }
}

#[test]
fn a_page_of_a_comparison_replaces_only_such_a_page() {
    let work = tempfile::tempdir().unwrap();
    let run = work.path().join("run");
    run_into(&run, &[]).success();
    let page = work.path().join("mine.html");
    let diff = || {
        let mut command = etalon(&["diff", "--out"]);
        command.arg(&page).args([&run, &run]);
        command
    };
    fs::write(&page, "mine").unwrap();
    let refused = diff().assert().code(64);
    refused.stderr(contains("mine.html exists"));
    assert_eq!(fs::read_to_string(&page).unwrap(), "mine");
    fs::remove_file(&page).unwrap();
    diff().assert().code(0);
    diff().assert().code(0);
    #[cfg(unix)]
    {
        fs::rename(&page, work.path().join("other.html")).unwrap();
        std::os::unix::fs::symlink("other.html", &page).unwrap();
        diff().assert().code(64);
        assert!(page.is_symlink());
    }
}

/// What a full disk does, too.
#[cfg(unix)]
#[test]
fn a_command_that_cannot_write_its_first_file_removes_nothing() {
    let work = tempfile::tempdir().unwrap();
    let run = work.path().join("run");
    etalon(&FAILING).arg("--out").arg(&run).assert().code(1);
    let before = files(&run);
    let out = run.to_str().unwrap();
    for words in [
        format!("run {CASE} --adapter cpu --force --out {out}"),
        format!("bench perf/matrix/clear/* --rounds 1 --adapter cpu --force --out {out}"),
        format!("fuzz --adapter cpu --count 1 --force --out {out}"),
        format!("mutants cull/* --case {CASE} --force --out {out}"),
    ] {
        let script = format!("ulimit -f 0; exec \"$0\" {words}");
        let mut command = std::process::Command::new("bash");
        for name in REMOVED {
            command.env_remove(name);
        }
        let output = command.args(["-c", &script, BINARY]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{words}: {said}");
        assert!(files(&run) == before, "{words}: {said}");
    }
}

/// What is in the place of an output, each below a new folder.
#[cfg(unix)]
fn places(work: &Path) -> Vec<(&'static str, PathBuf)> {
    let made = |program: &str, path: &Path, more: &[&str]| {
        let mut command = std::process::Command::new(program);
        let status = command.arg(path).args(more).status().unwrap();
        // Only root makes a device; for others, a second pipe is as good.
        if !status.success() {
            let status = std::process::Command::new("mkfifo").arg(path).status();
            assert!(status.unwrap().success());
        }
    };
    let path = |name: &str| work.join(name);
    fs::write(path("file"), "mine").unwrap();
    made("mkfifo", &path("pipe"), &[]);
    made("mknod", &path("device"), &["c", "1", "3"]);
    std::os::unix::fs::symlink("nowhere", path("dead-link")).unwrap();
    std::os::unix::fs::symlink("loop", path("loop")).unwrap();
    vec![
        ("file", path("file")),
        ("pipe", path("pipe")),
        ("device", path("device")),
        ("dead-link", path("dead-link")),
        ("loop", path("loop")),
        ("file", path("file/below")),
        ("dead-link", path("dead-link/below")),
        ("/proc/none", "/proc/none".into()),
    ]
}

/// The table: each command that writes a folder or a file, and each kind of place where it cannot. Such a place is bad
/// input, and stays as it is.
#[cfg(unix)]
#[test]
fn a_place_that_cannot_be_written_is_named_as_bad_input_and_stays() {
    let work = tempfile::tempdir().unwrap();
    let mut commands = writing(work.path());
    let path = |name: &str| work.path().join(name).display().to_string();
    let run = path("run");
    let file = |arguments: &[&str]| Writing::new("", arguments);
    let bless = [
        "--bless",
        "--force",
        "--out",
        &path("blessed"),
        "--expect",
        "OUT",
    ];
    let order = [
        "mutants",
        "cull/*",
        "--full",
        "--case",
        CASE,
        "--out",
        &path("hunt"),
    ];
    let files = [
        file(&["diff", &run, &run, "--out", "OUT"]),
        file(&[&FAILING[..], &bless].concat()),
        file(&[&order[..], &["--order", "OUT"]].concat()),
        file(&["show", CASE, "--png", "OUT"]),
        file(&["history", "add", &run, "--db", "OUT"]),
        file(&["history", "show", CASE, "--db", "OUT"]),
        file(&["report", "OUT"]),
    ];
    let first_file = commands.len();
    commands.extend(files);
    let places = places(work.path());
    let kinds = || {
        let kind = |name: &str| {
            fs::symlink_metadata(work.path().join(name))
                .unwrap()
                .file_type()
        };
        ["file", "pipe", "device", "dead-link", "loop"].map(kind)
    };
    let before = kinds();
    for command in &commands {
        for (name, place) in &places {
            // A database can be made behind a link, as by SQLite itself.
            let has = |word: &str| command.arguments.iter().any(|argument| argument == word);
            if has("add") && place.ends_with("dead-link") {
                continue;
            }
            let (code, said) = command.run(place, false);
            let what = format!("{:?} into {}: {said}", command.arguments, place.display());
            assert_eq!(code, 64, "{what}");
            assert!(said.contains(name), "{what}");
            let says = ["name ", "remove it", "needs adapter", "makes one"]
                .iter()
                .any(|word| said.contains(word));
            assert!(says || *name == "/proc/none" || *name == "loop", "{what}");
            assert_eq!(kinds(), before, "{what}");
        }
    }
    assert_eq!(
        fs::read_to_string(work.path().join("file")).unwrap(),
        "mine"
    );
    assert!(!work.path().join("nowhere").exists());
    // A folder is made for a folder, but not for a file.
    let (code, said) = commands[first_file].run(&work.path().join("none/page.html"), false);
    assert!(
        code == 64 && said.contains("none is no folder; make it"),
        "{said}"
    );
}
