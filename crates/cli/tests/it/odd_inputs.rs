//! Inputs that people have but no program writes: byte-order marks, links, pipes, repeated keys, huge scenes;
//! and machines that refuse what a run needs.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED, etalon};
use etalon_record::{Expectations, Reason, Record, Run, Verdict};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const POINTS: &str = include_str!("../../../../cases/cull/points.json");

/// A folder with one case file in `cases`.
fn cases(text: &str) -> (TempDir, PathBuf) {
    let work = tempfile::tempdir().unwrap();
    let cases = work.path().join("cases");
    fs::create_dir(&cases).unwrap();
    fs::write(cases.join("a.json"), text).unwrap();
    (work, cases)
}

fn list(cases: &Path) -> assert_cmd::assert::Assert {
    let mut command = etalon(&["list", "--cases"]);
    command.arg(cases).timeout(Duration::from_secs(60)).assert()
}

fn lines(assert: &assert_cmd::assert::Assert) -> usize {
    let out = &assert.get_output().stdout;
    out.iter().filter(|byte| **byte == b'\n').count()
}

#[test]
fn a_byte_order_mark_changes_nothing() {
    let mark = '\u{feff}';
    let (plain, marked) = (cases(POINTS), cases(&format!("{mark}{POINTS}")));
    let listed = lines(&list(&plain.1).success());
    assert!(listed > 1);
    assert_eq!(lines(&list(&marked.1).success()), listed);
    etalon(&["check"])
        .arg(marked.1.join("a.json"))
        .assert()
        .success();
    let work = marked.0.path();
    let adapters = work.join("adapters.json");
    fs::write(
        &adapters,
        format!("{mark}[{{\"name\":\"mine\",\"backend\":\"cpu\"}}]"),
    )
    .unwrap();
    let expect = work.join("expect.json");
    fs::write(&expect, format!("{mark}[]")).unwrap();
    etalon(&["run", "--adapter", "mine", "--adapters"])
        .arg(&adapters)
        .arg("--expect")
        .arg(&expect)
        .arg("--cases")
        .arg(&marked.1)
        .arg("--out")
        .arg(work.join("run"))
        .assert()
        .success();
}

#[test]
fn links_and_pipes_among_case_files_are_named() {
    let (work, folder) = cases(POINTS);
    let listed = lines(&list(&folder).success());
    symlink(&folder, folder.join("again")).unwrap();
    list(&folder)
        .code(64)
        .stderr(contains("again").and(contains("link")));
    fs::remove_file(folder.join("again")).unwrap();
    // A link to a folder works like the folder.
    let other = cases(POINTS);
    symlink(&other.1, folder.join("other")).unwrap();
    assert_eq!(lines(&list(&folder).success()), 2 * listed);
    let pipe = folder.join("x.json");
    let made = Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    list(&folder)
        .code(64)
        .stderr(contains("x.json").and(contains("not a regular file")));
    drop(work);
}

#[test]
fn json_that_parsers_read_differently_is_refused() {
    for (from, to, words) in [
        (
            "\"about\":",
            "\"about\": \"twice\", \"about\":",
            "duplicate key `about`",
        ),
        (
            "\"clear\": [",
            "\"clear\": [1e39, ",
            "overflows a 32-bit float",
        ),
    ] {
        let text = POINTS.replacen(from, to, 1);
        assert_ne!(text, POINTS, "{from}");
        let (_work, folder) = cases(&text);
        list(&folder)
            .code(64)
            .stderr(contains("a.json:").and(contains(words)));
    }
}

#[test]
fn a_scene_of_very_many_draws_is_refused_and_one_of_many_is_listed() {
    let scene = |draws: usize| {
        let draw = json!({ "mesh": { "kind": "full" }, "shader": "uniform_color" });
        json!({
            "about": "t", "spec": ["t"],
            "scene": {
                "attachments": { "color": { "format": "rgba8unorm", "size": [16, 16], "clear": [0, 0, 0, 0] } },
                "passes": [{ "color": ["color"], "draws": vec![draw; draws] }],
                "read": ["color"]
            }
        })
        .to_string()
    };
    let (_work, folder) = cases(&scene(200_000));
    let begun = Instant::now();
    list(&folder)
        .code(64)
        .stderr(contains("at most 65536 draws"));
    let (_work, folder) = cases(&scene(60_000));
    assert_eq!(lines(&list(&folder).success()), 1);
    assert!(
        begun.elapsed() < Duration::from_secs(40),
        "{:?}",
        begun.elapsed()
    );
}

#[test]
fn error_messages_quote_the_argument() {
    etalon(&["fuzz", "--adapter", "cpu", "--count", "0"])
        .assert()
        .code(64)
        .stderr(contains("--count"));
    etalon(&["list", ""])
        .assert()
        .code(4)
        .stderr(contains("no case matches ''"));
}

#[test]
fn json_that_is_not_written_is_no_success() {
    let work = tempfile::tempdir().unwrap();
    for command in [
        &["run", "cull/points", "--adapter", "cpu", "--format", "json"][..],
        &[
            "fuzz",
            "--adapter",
            "cpu",
            "--count",
            "1",
            "--format",
            "json",
        ],
    ] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let mut child = Command::new(BINARY);
        for name in REMOVED {
            child.env_remove(name);
        }
        let out = work.path().join(command[0]);
        let status = child
            .args(command)
            .arg("--out")
            .arg(out)
            .stdout(full)
            .status();
        assert_eq!(status.unwrap().code(), Some(3), "{command:?}");
    }
}

/// Runs on `cpu` as a user with at most this many processes and threads; `None` if the machine cannot limit
/// them.
fn limited(processes: u32, out: &Path) -> Option<(Option<i32>, String)> {
    let mut command = Command::new("setpriv");
    let limit = format!("--nproc={processes}");
    command.args(["--reuid=64999", "--clear-groups", "prlimit", &limit, BINARY]);
    command.args([
        "run",
        "cull/points",
        "--adapter",
        "cpu",
        "--jobs",
        "1",
        "--out",
    ]);
    for name in REMOVED {
        command.env_remove(name);
    }
    let output = command.arg(out).stdin(Stdio::null()).output().ok()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let refused = said.contains("setpriv:") || said.contains("prlimit:");
    (!refused && output.status.code() != Some(126)).then(|| (output.status.code(), said))
}

#[test]
fn without_processes_nothing_is_drawn_and_nothing_passes() {
    use std::os::unix::fs::PermissionsExt;
    let work = tempfile::tempdir().unwrap();
    fs::set_permissions(work.path(), fs::Permissions::from_mode(0o777)).unwrap();
    let Some((code, said)) = limited(500, &work.path().join("free")) else {
        eprintln!("this machine does not limit processes of another user");
        return;
    };
    assert_eq!(code, Some(0), "{said}");
    for processes in 1..12 {
        let out = work.path().join(format!("{processes}"));
        let Some((code, said)) = limited(processes, &out) else {
            continue;
        };
        assert!(!said.contains("panicked"), "{processes}: {said}");
        let records = Run::read(&out).map_or(0, |run| {
            run.records
                .iter()
                .filter(|r| r.verdict == Verdict::Pass)
                .count()
        });
        assert!(
            code != Some(0) || records > 0,
            "{processes}: {code:?}: {said}"
        );
        assert_ne!(code, Some(101), "{processes}: {said}");
        assert_ne!(code, None, "{processes}: {said}");
    }
}

/// A case whose picture is wrong with each fault, with different values.
const TRIP: &str = "capabilities/round-trip/format=rgba8unorm";

fn with_fault(fault: &str, more: &[&str], out: &Path, code: i32) -> Record {
    let adapter = format!("gl:llvmpipe:read-fault={fault}");
    let mut command = etalon(&[
        "run",
        TRIP,
        "--recheck",
        "off",
        "--adapter",
        &adapter,
        "--force",
    ]);
    command.args(more).arg("--out").arg(out).assert().code(code);
    Run::read(out).unwrap().records.remove(0)
}

fn entry(more: Value) -> Value {
    let mut entry = json!({
        "adapter": "gl:llvmpipe*", "driver": "*", "case": TRIP, "verdict": "fail",
        "reason": "red is lost", "evidence": "none"
    });
    let more = more.as_object().unwrap().clone();
    entry.as_object_mut().unwrap().extend(more);
    entry
}

#[test]
fn another_wrong_value_of_an_expected_case_is_news() {
    let work = tempfile::tempdir().unwrap();
    let (out, file) = (work.path().join("run"), work.path().join("expect.json"));
    let expect = ["--expect", file.to_str().unwrap()];
    let record = with_fault("zero-channel", &[], &out, 1);
    let channel = &record.wrong[0].channels[0];
    let symptom = json!({
        "attachment": channel.attachment, "aspect": channel.aspect, "codes": [channel.actual]
    });
    let write = |more: Value| fs::write(&file, json!([entry(more)]).to_string()).unwrap();
    write(json!({ "symptom": symptom }));
    let known = with_fault("zero-channel", &expect, &out, 0);
    assert_eq!(known.expected.unwrap().reason, "red is lost");
    let other = with_fault("off-by-one", &expect, &out, 1);
    assert_eq!((other.verdict, &other.expected), (Verdict::Fail, &None));
    let reason = Reason::OtherSymptom("red is lost".to_owned());
    assert!(other.reasons.contains(&reason), "{other:?}");
    // Without a symptom, the entry is only about the verdict.
    write(json!({}));
    with_fault("off-by-one", &expect, &out, 0);
    // A processor and labels also limit an entry.
    write(json!({ "labels": ["branch=main"] }));
    with_fault("off-by-one", &expect, &out, 1);
    let labelled = [&expect[..], &["--label", "branch=main", "--label", "x=y"]].concat();
    with_fault("off-by-one", &labelled, &out, 0);
    write(json!({ "processor": "no such processor" }));
    with_fault("off-by-one", &expect, &out, 1);
    write(json!({ "processor": "*" }));
    with_fault("off-by-one", &expect, &out, 0);
}

#[test]
fn expectations_of_several_files_add_up_and_expired_ones_give_a_warning() {
    let work = tempfile::tempdir().unwrap();
    let out = work.path().join("run");
    let [first, second] = ["one.json", "two.json"].map(|name| work.path().join(name));
    let write = |path: &Path, more: Value| {
        fs::write(path, json!([entry(more)]).to_string()).unwrap();
    };
    write(&first, json!({ "case": "depth/*" }));
    write(&second, json!({}));
    let [first_path, second_path] = [&first, &second].map(|path| path.to_str().unwrap());
    with_fault("zero-channel", &["--expect", first_path], &out, 1);
    with_fault(
        "zero-channel",
        &["--expect", first_path, "--expect", second_path],
        &out,
        0,
    );
    // The built-in findings stay.
    let softpipe = |more: &[&str]| {
        let known = [
            "run",
            "cull/points",
            "--adapter",
            "gl:softpipe",
            "--force",
            "--expect",
            first_path,
        ];
        let mut command = etalon(&known);
        command.args(more).arg("--out").arg(&out).assert()
    };
    softpipe(&[]).code(0);
    softpipe(&["--expect-only"]).code(1);

    write(&second, json!({ "expires": "2020-02-29" }));
    let mut command = etalon(&["run", "cull/points", "--adapter", "cpu", "--force"]);
    command
        .args(["--expect", second_path, "--out"])
        .arg(&out)
        .assert()
        .code(0)
        .stderr(contains("expired").and(contains("2020-02-29")));
    write(&second, json!({ "expires": "2027-02-30" }));
    with_bad_day(&second, &out);
    assert!(Expectations::read(&second).is_err());
}

fn with_bad_day(file: &Path, out: &Path) {
    etalon(&[
        "run",
        "cull/points",
        "--adapter",
        "cpu",
        "--force",
        "--expect",
    ])
    .arg(file)
    .arg("--out")
    .arg(out)
    .assert()
    .code(64)
    .stderr(contains("2027-02-30"));
}

/// Opening a pipe waits until another process writes to it, so nothing in a folder may be one.
#[test]
fn a_pipe_in_place_of_a_frame_is_named_and_not_waited_for() {
    let work = tempfile::tempdir().unwrap();
    let path = |name: &str| work.path().join(name);
    let run = path("run");
    etalon(&[
        "run",
        "cull/lines",
        "--adapter",
        "cpu:fault=misread",
        "--keep-frames",
        "all",
    ])
    .args(["--recheck", "off", "--out"])
    .arg(path("unused"))
    .assert()
    .code(0);
    etalon(&[
        "run",
        "selftest/depth*",
        "--adapter",
        "cpu",
        "--keep-frames",
        "all",
        "--out",
    ])
    .arg(&run)
    .assert()
    .code(0);
    let read = Run::read(&run).unwrap();
    let record = read.records.iter().find(|r| r.frame.is_some()).unwrap();
    let frame = run.join(record.frame.as_ref().unwrap());
    fs::remove_file(&frame).unwrap();
    assert!(
        Command::new("mkfifo")
            .arg(&frame)
            .status()
            .unwrap()
            .success()
    );
    let ended = |words: &[&str]| {
        let mut command = etalon(words);
        let assert = command.timeout(Duration::from_secs(60)).assert();
        let output = assert.get_output();
        assert!(output.status.code().is_some(), "{words:?} waits");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let (run, out) = (run.to_str().unwrap(), path("out"));
    let out = out.to_str().unwrap();
    ended(&["report", run]);
    ended(&["diff", run, run]);
    ended(&["site", &format!("{out}-site"), run]);
    let merged = ended(&["merge", run, "--out", &format!("{out}-merged")]);
    let explained = ended(&["explain", &record.case, "--texel", "0,0", "--run", run]);
    let bundled = ended(&[
        "bundle",
        &record.case,
        "--adapter",
        "cpu",
        "--run",
        run,
        "--out",
        &format!("{out}-bundle"),
    ]);
    for said in [merged, explained, bundled] {
        let names = said.contains("no regular file") || said.contains("unexpected argument");
        assert!(names, "{said}");
    }
}

#[test]
fn expectations_come_through_a_pipe() {
    let work = tempfile::tempdir().unwrap();
    let script = format!(
        "exec \"$0\" run cull/lines --adapter cpu --expect <(echo '[]') --out {}",
        work.path().join("out").display()
    );
    let status = Command::new("bash").args(["-c", &script, BINARY]).status();
    assert_eq!(status.unwrap().code(), Some(0));
}

/// What a full disk at the start does, too: the first file that a command writes cannot have a byte.
#[test]
fn a_file_that_may_not_grow_exits_with_the_code_of_a_full_disk() {
    let work = tempfile::tempdir().unwrap();
    let run = work.path().join("run");
    etalon(&["run", "cull/lines", "--adapter", "cpu", "--out"])
        .arg(&run)
        .assert()
        .code(0);
    let run = run.to_str().unwrap();
    let out = work.path().join("out").display().to_string();
    let list = work.path().join("list");
    fs::write(&list, "cull/lines\n").unwrap();
    for words in [
        format!("run cull/lines --adapter cpu --out {out}-1"),
        format!("bench perf/* --rounds 3 --adapter cpu --out {out}-2"),
        format!("fuzz --adapter cpu --count 1 --out {out}-3"),
        format!("merge {run} --out {out}-4"),
        format!("report {run}"),
        format!("history add {run} --db {out}-5.db"),
        format!("site {out}-6 {run}"),
        format!("run cull/lines --adapter cpu --force --out {run}"),
    ] {
        let script = format!("ulimit -f 0; exec \"$0\" {words}");
        let mut command = Command::new("bash");
        for name in REMOVED {
            command.env_remove(name);
        }
        let output = command.args(["-c", &script, BINARY]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{words}: {said}");
        assert!(said.contains("etalon: "), "{words}: {said}");
    }
}

/// Fails on softpipe.
const POINT: &str = "cull/points/cull=none/front_face=cw";

#[test]
fn a_folder_without_findings_is_no_folder_of_findings() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("passwd"), "root").unwrap();
    let refused = || {
        let mut command = etalon(&["run", POINT, "--adapter", "cpu", "--expect"]);
        command.arg(work.path()).arg("--out");
        command.arg(work.path().join("run"));
        command
    };
    refused()
        .assert()
        .code(64)
        .stderr(contains("none is a finding"));
    // The last finding of a folder can go, and leave its README.
    fs::remove_file(work.path().join("passwd")).unwrap();
    fs::write(work.path().join("README.md"), "none yet").unwrap();
    refused().assert().code(0);
}

#[cfg(unix)]
#[test]
fn a_list_that_is_a_link_stays_a_link_when_it_is_blessed() {
    let work = tempfile::tempdir().unwrap();
    let [real, link] = ["real.json", "link.json"].map(|name| work.path().join(name));
    fs::write(&real, "[]").unwrap();
    symlink(&real, &link).unwrap();
    etalon(&["run", POINT, "--adapter", "gl:softpipe", "--expect-only"])
        .args(["--bless", "--expect"])
        .arg(&link)
        .arg("--out")
        .arg(work.path().join("run"))
        .assert()
        .code(0);
    assert!(link.is_symlink());
    let text = fs::read_to_string(&real).unwrap();
    assert!(text.contains("gl:softpipe"), "{text}");
}

#[test]
fn a_damaged_frame_and_a_path_that_leaves_the_folder_are_named_with_their_place() {
    let work = tempfile::tempdir().unwrap();
    let run = work.path().join("run");
    etalon(&["run", POINT, "--adapter", "gl:softpipe", "--expect-only"])
        .arg("--out")
        .arg(&run)
        .assert()
        .code(1);
    let recorded = Run::read(&run).unwrap();
    let frame = recorded.records[0].frame.clone().unwrap();
    fs::write(run.join(&frame), b"\x1f\x8bno gzip").unwrap();
    let explain = || {
        let mut command = etalon(&["explain", POINT, "--texel", "0,0", "--run"]);
        command.arg(&run);
        command
    };
    explain()
        .assert()
        .code(64)
        .stderr(contains(&*frame).and(contains("copy the file anew")));
    let text = fs::read_to_string(run.join("run.jsonl")).unwrap();
    for other in ["../x", "run.jsonl", "frames/a.svg", "/etc/passwd"] {
        fs::write(run.join("run.jsonl"), text.replace(&frame, other)).unwrap();
        let merged = work.path().join("merged");
        let mut merge = etalon(&["merge", "--out"]);
        merge.arg(&merged).arg(&run);
        for mut command in [explain(), merge] {
            let refused = command.assert().code(64);
            refused.stderr(contains("run.jsonl:2:").and(contains(other)));
        }
        assert!(!merged.exists(), "{other}");
    }
}
