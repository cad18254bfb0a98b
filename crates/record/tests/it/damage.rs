//! Damaged files: reading ends with a message, or with the intact part.
//!
//! `PROPTEST_CASES` sets the number of inputs of each test; a million of each take some minutes in a
//! release build.

use crate::spoil::{Spoiling, keep_trying, spoilings};
use etalon_record::{
    Bench, Expectations, FolderKind, Merge, RecordError, Run, RunWriter, read_cases,
};
use flate2::Compression;
use flate2::write::GzEncoder;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::OnceLock;

/// The first lines of a recorded run of methods, which the tests of the reports keep.
fn lines(most: usize) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../report/tests/data/methods.jsonl");
    let text = fs::read_to_string(path).unwrap();
    text.lines().take(most).map(|l| format!("{l}\n")).collect()
}

fn run_text() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| lines(4))
}

fn bench_text() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        let run: Value = serde_json::from_str(run_text().lines().next().unwrap()).unwrap();
        let header = json!({
            "format": 1, "etalon": "0.1.0", "machine": run["machine"], "command": ["etalon"],
            "started": "2026-01-01T00:00:00Z", "profile": "quick", "cases": 1, "rounds": 2,
            "shader_cache": "warm", "ruler": "r", "adapters": [run["adapters"][0]], "absent": []
        });
        let picture = json!({ "picture": {
            "case": "perf/a", "adapter": "cpu", "verdict": "pass", "asserted": 1.0
        } });
        let round = |n: u32| json!({ "round": {
            "case": "perf/a", "adapter": "cpu", "round": n, "at": 0.5, "ruler": [0.1, 0.2], "prepare": 0.1,
            "first": 0.1, "warm_up": 2, "wall": [0.1, 0.2], "cpu": [0.1, 0.2]
        } });
        let lines = [header, picture, round(0), round(1)];
        lines.iter().map(|line| format!("{line}\n")).collect()
    })
}

fn expectations_text() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        r#"{ "entries": [
            { "adapter": "gl*:softpipe", "driver": "*Mesa", "version": ">=22.3, <25.1", "case": "depth/*/{a,b}",
              "verdict": "fail", "reason": "r", "evidence": "e", "link": "https://x", "expires": "2027-01-31" },
            { "adapter": "*", "driver": "*", "case": "[a-z]*", "verdict": "skipped", "reason": "r", "evidence": "e" }
        ] }"#
        .to_owned()
    })
}

/// Checks that a message is there and short.
fn told(error: &impl ToString) {
    let text = error.to_string();
    assert!(!text.is_empty() && text.len() < 4000, "{text}");
}

fn folder_with(name: &str, text: &[u8]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    folder
}

proptest! {
    #[test]
    fn a_spoilt_run_is_read_or_refused(spoilt in spoilings()) {
        let folder = folder_with("run.jsonl", &spoilt.of(run_text()));
        let _ = FolderKind::of(folder.path());
        match Run::read(folder.path()) {
            Err(error) => told(&error),
            Ok(run) => {
                let _ = (run.missing(), run.header.expected_records());
                for record in &run.records {
                    let _ = (record.parts().area(), record.parts().file(), record.unexpected());
                    if let Some(frame) = &record.frame {
                        let _ = Run::read_frame(folder.path(), frame);
                    }
                }
                let _ = read_cases(folder.path(), &run.header);
                if let Err(error) = Merge::read(&[folder.path().to_owned()]) {
                    told(&error);
                }
                // A run that can be read can be resumed without loss.
                let (_, again) = RunWriter::resume(folder.path(), &run.header).unwrap();
                prop_assert_eq!(again.records, run.records);
            }
        }
    }

    #[test]
    fn a_spoilt_frame_is_read_or_refused(spoilt in spoilings()) {
        let folder = folder_with("frame.json", &spoilt.of(FRAME));
        match Run::read_frame(folder.path(), "frame.json") {
            Err(error) => told(&error),
            Ok(file) => {
                let _ = file.images.iter().filter(|i| i.is_whole()).count();
            }
        }
    }

    #[test]
    fn a_spoilt_bench_is_read_or_refused(spoilt in spoilings()) {
        let folder = folder_with("bench.jsonl", &spoilt.of(bench_text()));
        if let Err(error) = Bench::read(folder.path()) {
            told(&error);
        }
    }

    #[test]
    fn spoilt_expectations_are_read_or_refused(spoilt in spoilings()) {
        let bytes = spoilt.of(expectations_text());
        let text = String::from_utf8_lossy(&bytes);
        match Expectations::parse(&text, Path::new("e.json")) {
            Err(error) => told(&error),
            Ok(read) => {
                let _ = read.on("2026-11-22").entries().len();
            }
        }
    }

    #[test]
    fn paths_stay_below_the_folder(path in "[./\\\\a\u{0}:~-]{0,12}") {
        let outside = tempfile::tempdir().unwrap();
        let folder = outside.path().join("run");
        fs::create_dir(&folder).unwrap();
        fs::write(outside.path().join("a"), "secret").unwrap();
        if let Ok(Some(bytes)) = Run::read_picture(&folder, &path, 100) {
            prop_assert!(!bytes.starts_with(b"secret"));
        }
        if let Err(error) = Run::read_frame(&folder, &path) {
            prop_assert!(!error.to_string().contains("secret"));
        }
    }
}

const FRAME: &str = r#"{"case":"a/b","adapter":"cpu","about":"x","spec":["y"],"images":[{"attachment":"color",
    "aspect":"color","size":[1,1],"samples":1,"channels":[{"unorm":8}],"low":[0],"high":[1],
    "actual":[2],"wrong":[2]}]}"#;

/// Reads a folder as every command does.
fn read_all(folder: &Path) {
    let _ = FolderKind::of(folder);
    let _ = Bench::read(folder).map_err(|e| told(&e));
    let _ = Merge::read(&[folder.to_owned()]).map_err(|e| told(&e));
    let Ok(run) = Run::read(folder) else { return };
    for file in run.records.iter().flat_map(|record| record.files()) {
        let _ = Run::read_frame(folder, file).map_err(|e| told(&e));
        let _ = Run::read_picture(folder, file, 1 << 20).map_err(|e| told(&e));
    }
    // What can be read can be replaced.
    RunWriter::create(folder, &run.header).unwrap();
}

#[test]
fn no_run_panics_or_hangs_a_reader() {
    let [run, bench] = [run_text(), bench_text()].map(str::as_bytes);
    keep_trying("runs and benches", &[run, bench], |input| {
        for name in ["run.jsonl", "bench.jsonl"] {
            read_all(folder_with(name, input).path());
        }
    });
}

#[test]
fn no_frame_panics_or_hangs_a_reader() {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(FRAME.as_bytes()).unwrap();
    let packed = packed.finish().unwrap();
    keep_trying("frames", &[FRAME.as_bytes(), &packed], |input| {
        for name in ["frame.json", "frame.json.gz"] {
            let folder = folder_with(name, input);
            let read = Run::read_frame(folder.path(), name).map_err(|e| told(&e));
            let _ = read.map(|file| file.images.iter().filter(|image| image.is_whole()).count());
        }
    });
}

/// Absurd sizes, counts and nesting are refused with a message, at once.
#[test]
fn absurd_sizes_counts_and_nesting_are_refused() {
    let header = run_text().lines().next().unwrap();
    let deep = format!("{}{}", "[".repeat(200_000), "]".repeat(200_000));
    for text in [
        format!("{deep}\n"),
        format!("{header}\n{deep}\n{deep}\n"),
        format!("{header}\n{}\n", "{\"case\":".repeat(5000)),
        header.replacen("\"cases\":", "\"cases\":1e999,\"x\":", 1),
        header.replacen("\"cores\":", "\"cores\":99999999999999999999,\"x\":", 1),
        "{\"format\":4294967295}\n".to_owned(),
        "{\"format\":-1}\n".to_owned(),
    ] {
        let folder = folder_with("run.jsonl", text.as_bytes());
        match Run::read(folder.path()) {
            Err(error) => told(&error),
            Ok(run) => assert!(run.truncated, "{}", &text[..200.min(text.len())]),
        }
    }
    let entries = format!("{{\"entries\":{deep}}}");
    told(&Expectations::parse(&entries, Path::new("e")).unwrap_err());
    let glob = format!("{}x", "{".repeat(50_000));
    let entry = format!(
        r#"{{"entries":[{{"adapter":"*","driver":"*","case":"{glob}","verdict":"fail","reason":"r","evidence":"e"}}]}}"#
    );
    match Expectations::parse(&entry, Path::new("e")).unwrap_err() {
        RecordError::Parse { message, .. } => {
            let start = "entry 1: \"case\": ";
            assert!(message.starts_with(start), "{message:.200}");
        }
        _ => panic!("the entry does not parse"),
    }
}

/// Some spoilt inputs are refused and some accepted, so they get beyond the first brace.
#[test]
fn some_spoilt_inputs_are_accepted_and_some_refused() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut taken, mut refused) = (0, 0);
    for _ in 0..400 {
        let spoilt: Spoiling = spoilings().new_tree(&mut runner).unwrap().current();
        let folder = folder_with("run.jsonl", &spoilt.of(run_text()));
        match Run::read(folder.path()) {
            Ok(_) => taken += 1,
            Err(_) => refused += 1,
        }
    }
    assert!(
        taken > 40 && refused > 40,
        "{taken} taken, {refused} refused"
    );
}
