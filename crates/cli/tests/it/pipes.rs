//! Standard output and standard error without a reader: they change no exit code, no record and no report.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::{BINARY, REMOVED};
use crate::sample;
use etalon_record::{Bench, Run, Verdict};
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// An adapter that refuses some of these cases, always the same ones.
const RED: &str = "cull/* --adapter cpu:fault=refused --adapter cpu";

/// Places without a reader, as redirections of a shell. A pipe without a reader is there from the start;
/// `head` goes away in the middle.
const SINKS: [&str; 10] = [
    ">/dev/full",
    "2>/dev/full",
    ">/dev/full 2>/dev/full",
    ">&-",
    "2>&-",
    ">&- 2>&-",
    "| head -n 1",
    "2>&1 | head -n 1",
    "2>&1 >/dev/null | head -n 1",
    "| :",
];

/// Returns the output of a shell line, whose exit code is that of the first command in its pipe. `$0` is the binary.
fn shell(line: &str) -> Output {
    let mut command = Command::new("bash");
    let line = format!("{line}\nexit ${{PIPESTATUS[0]}}");
    command.args(["-c", &line, BINARY]);
    for name in REMOVED {
        command.env_remove(name);
    }
    command.output().unwrap()
}

fn verdicts(folder: &Path) -> Vec<(String, String, Verdict, bool)> {
    let run = Run::read(folder).unwrap();
    assert_eq!(run.missing(), 0);
    let mut rows: Vec<_> = run
        .records
        .into_iter()
        .map(|r| {
            let bad = r.unexpected();
            (r.adapter, r.case, r.verdict, bad)
        })
        .collect();
    rows.sort();
    rows
}

#[test]
fn a_run_whose_output_is_not_read_ends_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let expected_folder = folder.path().join("due");
    let line =
        |out: &Path, more: &str| format!("\"$0\" run {RED} --force --out {} {more}", out.display());
    let output = shell(&line(&expected_folder, ""));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let expected = verdicts(&expected_folder);
    assert!(
        expected.iter().filter(|(.., bad)| *bad).count() >= 4,
        "{expected:?}"
    );
    let rounds = sample::count("rounds of red runs that nobody reads", 2, 25);
    for (sink, format) in SINKS
        .iter()
        .flat_map(|sink| vec![sink; rounds])
        .zip(["", "--format json"].into_iter().cycle())
    {
        let out = tempfile::tempdir_in(folder.path()).unwrap();
        let output = shell(&line(out.path(), &format!("{format} {sink}")));
        // A program that reads the summary must not take its absence for an answer.
        let lost = !format.is_empty() && sink.starts_with(">/dev/full");
        let code = if lost { 3 } else { 1 };
        assert_eq!(output.status.code(), Some(code), "{sink}: {output:?}");
        assert_eq!(verdicts(out.path()), expected, "{sink}: {output:?}");
        for file in ["index.html", "junit.xml", "summary.md"] {
            assert!(out.path().join(file).is_file(), "{sink}: {file}");
        }
    }
}

#[test]
fn a_bench_whose_output_is_not_read_ends_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for sink in SINKS {
        let out = folder.path().join("bench");
        // The rasterizer that draws some pictures wrong, so that the bench is red.
        let line = format!(
            "\"$0\" bench cull/* --adapter cpu:fault=refused --rounds 1 --seconds 0.001 --out {} {sink}",
            out.display()
        );
        let output = shell(&line);
        assert_eq!(output.status.code(), Some(1), "{sink}: {output:?}");
        let bench = Bench::read(&out).unwrap();
        assert!(!bench.records.is_empty(), "{sink}");
        assert!(out.join("index.html").is_file(), "{sink}");
        fs::remove_dir_all(&out).unwrap();
    }
}

#[test]
fn a_reader_that_goes_away_turns_nothing_green() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    for (adapter, name, code) in [("cpu", "good", 0), ("cpu:fault=refused", "bad", 1)] {
        let output = shell(&format!(
            "\"$0\" run cull/* --adapter {adapter} --out {}",
            path(name)
        ));
        assert_eq!(output.status.code(), Some(code), "{output:?}");
    }
    let (good, bad, merged) = (path("good"), path("bad"), path("merged"));
    let compared = format!("--adapter-before cpu --adapter-after cpu:fault=refused {good} {bad}");
    for (command, code) in [
        (format!("diff {compared}"), 1),
        (format!("diff --format json {compared}"), 1),
        (format!("merge {bad} --force --out {merged}"), 1),
        (format!("merge {good} --force --out {merged}"), 0),
        ("list".to_owned(), 0),
        ("schema".to_owned(), 0),
        ("list no/such/case".to_owned(), 4),
        ("list --no-such-flag".to_owned(), 64),
    ] {
        for sink in ["| :", "2>&1 | :", "| head -n 1", "2>&-"] {
            let output = shell(&format!("\"$0\" {command} {sink}"));
            assert_eq!(
                output.status.code(),
                Some(code),
                "{command} {sink}: {output:?}"
            );
        }
    }
}

#[test]
fn output_that_is_the_product_must_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder_path = folder.path().join("run").display().to_string();
    shell(&format!(
        "\"$0\" run cull/* --adapter cpu --out {folder_path}"
    ));
    let diff = format!("diff {folder_path} {folder_path}");
    for command in [
        "list",
        "schema",
        "adapters",
        "adapters --format json",
        "completions bash",
        "man",
        "mutants --list",
        "--help",
        "run --help",
        "--version",
        "explain cull --texel 0,0",
        &diff,
    ] {
        let command = if command.starts_with("explain") {
            let output = shell("\"$0\" list cull/*");
            let text = String::from_utf8(output.stdout).unwrap();
            format!("explain {} --texel 0,0", text.lines().next().unwrap())
        } else {
            command.to_owned()
        };
        // Without a path no browser is found, and none is started.
        let fine = shell(&format!("PATH=/none \"$0\" {command}"));
        assert_eq!(fine.status.code(), Some(0), "{command}: {fine:?}");
        let full = shell(&format!("PATH=/none \"$0\" {command} >/dev/full"));
        assert_eq!(full.status.code(), Some(3), "{command}: {full:?}");
        let stderr = String::from_utf8(full.stderr).unwrap();
        assert!(!stderr.contains("panicked"), "{command}: {stderr}");
    }
}

#[test]
fn a_descriptor_for_reading_takes_no_output() {
    let mut command = Command::new(BINARY);
    let read_only: Stdio = File::open("/dev/null").unwrap().into();
    let status = command.arg("schema").stdout(read_only).status().unwrap();
    assert_eq!(status.code(), Some(3));
    // A pipe without a reader from the start.
    let (reader, writer) = io::pipe().unwrap();
    drop(reader);
    let mut command = Command::new(BINARY);
    let status = command.arg("schema").stdout(writer).status().unwrap();
    assert_eq!(status.code(), Some(0));
}
