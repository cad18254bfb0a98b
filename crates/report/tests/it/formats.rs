//! The files for other programs, read by third-party parsers and schemas.

use crate::deqp::{self, Line};
use crate::markdown::read_markdown;
use crate::synthetic::{self, adapter, header};
use crate::verdicts::{every_verdict, record_all};
use etalon_frame::{Api, Aspect};
use etalon_record::{
    Assertion, LossKind, ProcessEnd, Reason, Record, Run, RunWriter, Verdict, selection_digest,
};
use etalon_report::{RunReport, write};
use pulldown_cmark::{Event, Parser};
use std::fs;
use std::io::Cursor;
use std::path::Path;

const HOSTILE: &str = "\"><script>alert(1)</script>|`a`|![x](http://a.b/c)@me #1\\|&amp;]]>\u{1b}[2J\u{7}\u{202e},\nPass,1";

/// A run whose every text is hostile.
fn hostile(folder: &Path) {
    let mut header = header(3, vec![adapter(HOSTILE, Api::Vulkan)]);
    header.provenance.started = HOSTILE.to_owned();
    header.provenance.command = vec![HOSTILE.to_owned()];
    header.provenance.commit = Some(HOSTILE.to_owned());
    header.provenance.machine.cpu = HOSTILE.to_owned();
    header.absent[0].remedy = HOSTILE.to_owned();
    let mut record = Record::new(format!("{HOSTILE}/{HOSTILE}"), HOSTILE, Verdict::Crash);
    record.reasons = vec![Reason::Text(HOSTILE.to_owned())];
    record.after = vec![HOSTILE.to_owned()];
    record.validation = vec![HOSTILE.to_owned()];
    record.seconds.draw = 1e300;
    record.seconds.judge = -1e301;
    record.process = Some(ProcessEnd {
        kind: LossKind::Garbage,
        signal: Some(i32::MIN),
        exit: Some(i32::MAX),
        stderr: HOSTILE.to_owned(),
        seconds: 1e300,
        ..ProcessEnd::default()
    });
    let mut better = Record::new("# a", HOSTILE, Verdict::Pass);
    better.improves = Some(Verdict::Fail);
    better.seconds.draw = 1e300;
    better.assertions = vec![Assertion {
        aspect: Aspect::Color,
        channels: u64::MAX,
        asserted: u64::MAX,
        exact: 1,
        codes: 1,
        yardstick_exact: 1,
        yardstick_codes: 1,
        yardstick_asserted: 1,
    }];
    let nameless = Record::new("", "", Verdict::Fail);
    record_all(folder, &header, &[record, better, nameless]);
}

/// Three cases: one record is complete, one is cut off.
fn truncated(folder: &Path) {
    let ids = ["a/0", "a/1", "a/2"];
    let mut header = header(3, vec![adapter("cpu", Api::Vulkan)]);
    header.settings.selection = selection_digest(ids);
    let records = ids.map(|id| Record::new(id, "cpu", Verdict::Pass));
    record_all(folder, &header, &records[..2]);
    let path = folder.join("run.jsonl");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 9]).unwrap();
    fs::write(folder.join("cases.txt"), "a/0\na/1\na/2\n").unwrap();
}

/// Runs of every kind that a report must handle.
fn runs() -> Vec<(&'static str, tempfile::TempDir)> {
    let made = |name, make: &dyn Fn(&Path)| {
        let folder = tempfile::tempdir().unwrap();
        make(folder.path());
        (name, folder)
    };
    vec![
        made("every verdict", &|f| {
            every_verdict(f);
        }),
        made("hostile", &hostile),
        made("truncated", &truncated),
        made("empty", &|f| record_all(f, &header(0, Vec::new()), &[])),
        made("believable", &|f| {
            synthetic::write(f, 1);
        }),
        made("methods", &|f| {
            synthetic::methods::write(f);
        }),
    ]
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn lists_of_deqp_runner_are_written_on_request_and_kept_up_to_date() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let run = Run::read(folder.path()).unwrap();
    let written = |deqp| {
        let report = RunReport {
            folder: folder.path(),
            run: &run,
            catalogue: None,
            news: None,
            deqp,
        };
        !report.write().unwrap().results.is_empty()
    };
    assert_eq!([false, true, false].map(written), [false, true, true]);
}

#[test]
fn all_named_files_exist() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        assert!(written.all().all(Path::is_file), "{name}");
        let mut count = 0;
        for path in written.all() {
            assert!(path.starts_with(folder.path()), "{name}");
            count += 1;
        }
        let methods = usize::from(name == "methods");
        assert_eq!(count, 3 + methods + written.results.len(), "{name}");
        // Nothing half written is left behind.
        let folders = [folder.path().to_owned(), folder.path().join("results")];
        for below in folders.iter().filter(|folder| folder.exists()) {
            let mut names = fs::read_dir(below).unwrap().map(|e| e.unwrap().file_name());
            let is_whole =
                |n: &std::ffi::OsStr| n == ".files" || !n.to_string_lossy().starts_with('.');
            assert!(names.all(|n| is_whole(&n)), "{name}");
        }
    }
}

#[test]
fn junit_is_read_by_another_parser() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        let report = junit_parser::from_reader(Cursor::new(text(&written.junit))).unwrap();
        let cases: usize = report.suites.iter().map(|s| s.cases.len()).sum();
        let run = Run::read(folder.path()).unwrap();
        // One more stands for a run that is incomplete.
        assert!([0, 1].contains(&(cases - run.records.len())), "{name}");
        for suite in &report.suites {
            let count = |is: fn(&junit_parser::TestStatus) -> bool| {
                suite.cases.iter().filter(|c| is(&c.status)).count() as u64
            };
            assert_eq!(suite.tests, suite.cases.len() as u64, "{name}");
            assert_eq!(suite.failures, count(junit_parser::TestStatus::is_failure));
            assert_eq!(suite.errors, count(junit_parser::TestStatus::is_error));
            assert!(
                suite
                    .cases
                    .iter()
                    .all(|c| c.time >= 0.0 && c.time.is_finite())
            );
        }
        let complete = &report.suites.last().unwrap().cases[0];
        assert_eq!(complete.original_name, "the run is complete");
        let is_complete = matches!(name, "every verdict" | "hostile" | "believable" | "methods");
        assert_eq!(complete.status.is_success(), is_complete, "{name}");
    }
}

#[test]
fn junit_describes_the_ends_of_processes_and_the_repetitions() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let written = write(folder.path()).unwrap();
    let report = junit_parser::from_reader(Cursor::new(text(&written.junit))).unwrap();
    let case = |name: &str| {
        let cases = report.suites.iter().flat_map(|s| &s.cases);
        let mut found = cases.filter(|c| c.original_name == name);
        found.next().unwrap().clone()
    };
    let lost = case("depth/lost");
    assert!(lost.status.is_error());
    assert_eq!(
        lost.system_err.as_deref(),
        Some("LLVM ERROR\nout of registers")
    );
    let error = &lost.status.error_as_ref().text;
    assert!(error.contains("signal 6"), "{error}");
    assert!(
        error.contains("only after depth/first, then depth/second"),
        "{error}"
    );
    let repeated = case("depth/repeated");
    assert!(repeated.status.is_success());
    let output = repeated.system_out.unwrap();
    assert!(
        output.contains("repeated in fresh processes: 4 × pass"),
        "{output}"
    );
    assert!(output.contains("validation: VUID-1: something"), "{output}");
    assert!(case("depth/all/verdict=skipped").status.is_skipped());
    assert!(case("depth/all/verdict=not-supported").status.is_skipped());
}

#[test]
fn deqp_runner_reads_its_lists() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        let mut lines = 0;
        for path in &written.results {
            lines += deqp::read(&text(path)).unwrap().len();
        }
        let expected = match name {
            // deqp-runner cannot read two of the three ids, nor the third, which is empty.
            "hostile" => 0,
            // Two missing ones are listed as missing.
            "truncated" => 3,
            _ => Run::read(folder.path()).unwrap().records.len(),
        };
        assert_eq!(lines, expected, "{name}");
    }
}

#[test]
fn deqp_runner_understands_every_status() {
    let folder = tempfile::tempdir().unwrap();
    let records = every_verdict(folder.path());
    let written = write(folder.path()).unwrap();
    assert!(written.results[0].ends_with("results/gl_a.csv"));
    let list = text(&written.results[0]);
    assert_eq!(list, deqp::LIST, "the list that deqp-runner read");
    let read = deqp::read(&list).unwrap();
    for record in &records {
        let plain = match record.verdict {
            Verdict::Pass => "Pass",
            Verdict::Imprecise => "Warn",
            Verdict::Fail
            | Verdict::RequiredByCts
            | Verdict::Disputed
            | Verdict::Blocked
            | Verdict::Open
            | Verdict::ResourceError
            | Verdict::InternalError => "Fail",
            Verdict::Measured | Verdict::NotSupported | Verdict::Skipped => "Skip",
            Verdict::Flaky => "Flake",
            Verdict::Crash | Verdict::DeviceLost => "Crash",
            Verdict::Timeout => "Timeout",
        };
        let expected = match record.case.as_str() {
            "blend/expected/verdict=flaky" => "KnownFlake",
            case if case.starts_with("blend/expected") => "ExpectedFail",
            "blend/better/verdict=pass" => "UnexpectedImprovement(Pass)",
            "blend/better/verdict=imprecise" => "UnexpectedImprovement(Warn)",
            "selftest/due/verdict=fail" => "ExpectedFail",
            "selftest/due/verdict=pass" => "Fail",
            _ => plain,
        };
        let Line { status, regression } = deqp::recorded(&record.case);
        assert_eq!(status, expected, "{record:?}");
        assert_eq!(read[record.case.as_str()], expected, "{record:?}");
        // Everything that fails the run fails it there too, except flakes, which deqp-runner passes.
        let flake = record.verdict == Verdict::Flaky;
        assert_eq!(regression, record.unexpected() && !flake);
    }
}

#[test]
fn ids_that_deqp_runner_cannot_read_are_left_out_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let ids = ["a/b", "a,b", "#a", "a\nb", "a\rb", ""];
    let records = ids.map(|id| Record::new(id, "cpu", Verdict::Pass));
    let header = header(ids.len() as u64, vec![adapter("cpu", Api::Vulkan)]);
    record_all(folder.path(), &header, &records);
    let written = write(folder.path()).unwrap();
    let list = text(&written.results[0]);
    assert!(list.starts_with("# 5 records left out"), "{list}");
    assert_eq!(list.lines().last(), Some("a/b,Pass,0"));
    assert_eq!(deqp::read(&text(&written.results[0])).unwrap().len(), 1);
}

#[test]
fn missing_records_are_marked_in_lists_of_deqp_runner() {
    let folder = tempfile::tempdir().unwrap();
    truncated(folder.path());
    let written = write(folder.path()).unwrap();
    let list = text(&written.results[0]);
    assert_eq!(list, "a/0,Pass,0\na/1,Missing,0\na/2,Missing,0\n");
    // Without the list of cases, missing ones are only counted.
    fs::remove_file(folder.path().join("cases.txt")).unwrap();
    let list = text(&write(folder.path()).unwrap().results[0]);
    assert!(
        list.starts_with("# incomplete: 2 records missing"),
        "{list}"
    );
}

#[test]
fn the_summary_holds_no_markup_of_others() {
    for (name, folder) in runs() {
        let summary = text(&write(folder.path()).unwrap().summary);
        let read = read_markdown(&summary);
        assert!(!summary.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{name}");
        // A mention needs a following letter; code has no mentions.
        let mentions = Parser::new(&summary).any(|e| match e {
            Event::Text(text) => text.contains("@me") || text.contains("#1"),
            _ => false,
        });
        assert!(!mentions, "{name}: {summary}");
        let widths: Vec<usize> = read.rows.iter().map(Vec::len).collect();
        assert!(widths.iter().all(|w| *w >= 3), "{name}: {widths:?}");
        let incomplete = matches!(name, "truncated" | "empty");
        assert_eq!(
            summary.starts_with("# etalon\n\n**✗ Incomplete"),
            incomplete,
            "{name}"
        );
        assert_eq!(name == "empty", read.rows.is_empty(), "{name}");
    }
}

#[test]
fn the_summary_has_counts_records_and_commands() {
    let folder = tempfile::tempdir().unwrap();
    let mut records = every_verdict(folder.path());
    let header = header(records.len() as u64, vec![adapter("gl:a", Api::OpenGl)]);
    let writer = RunWriter::create(folder.path(), &header).unwrap();
    let index = records
        .iter()
        .position(|r| r.case == "depth/all/verdict=fail")
        .unwrap();
    records[index] = synthetic::record(&writer, "depth/all/verdict=fail", "gl:a", Verdict::Fail, 1);
    record_all(folder.path(), &header, &records);
    let summary = text(&write(folder.path()).unwrap().summary);
    let read = read_markdown(&summary);
    let adapters = &read.rows[1];
    assert_eq!(adapters[0], "gl:a");
    let unexpected = records.iter().filter(|r| r.unexpected()).count();
    assert_eq!(*adapters.last().unwrap(), unexpected.to_string());
    // Each unexpected record and each improvement, and the adapter that is absent.
    assert_eq!(read.items, unexpected + 2 + 1);
    let (x, y) = (records[index].wrong[0].x, records[index].wrong[0].y);
    for words in [
        format!("{unexpected} unexpected records"),
        format!("etalon explain depth/all/verdict=fail --texel {x},{y} --adapter gl:a"),
        "etalon run depth/lost --adapter gl:a".to_owned(),
        "only after depth/first, then depth/second".to_owned(),
        "2 improvements".to_owned(),
        "What was asserted".to_owned(),
    ] {
        let text = read.text.replace('\u{2060}', "");
        assert!(text.contains(&words), "{words}: {text}");
    }
}

#[test]
fn files_of_a_huge_run_keep_their_limits() {
    let folder = tempfile::tempdir().unwrap();
    // Ids so long that a list of them fits only if they are cut.
    let long = "x|".repeat(500);
    let adapters: Vec<_> = (0..10)
        .map(|i| adapter(&format!("a:{i}"), Api::Vulkan))
        .collect();
    let names: Vec<String> = adapters.iter().map(|a| a.info.name.clone()).collect();
    let mut writer = RunWriter::create(folder.path(), &header(8000, adapters)).unwrap();
    for case in 0..8000 {
        for (index, name) in names.iter().enumerate() {
            let verdict = Verdict::ALL[(case + index) % Verdict::ALL.len()];
            let end = if case % 8 == 0 { long.as_str() } else { "x" };
            let mut record = Record::new(format!("a{}/{case}/{end}", case % 700), name, verdict);
            if case % 7 == 0 {
                record.improves = Some(Verdict::Fail);
            }
            writer.append(&record).unwrap();
        }
    }
    let written = write(folder.path()).unwrap();
    let summary = text(&written.summary);
    assert!(summary.len() < 1_000_000, "{}", summary.len());
    assert!(summary.contains("more left out of this summary"));
    let read = read_markdown(&summary);
    assert!(read.items >= 200, "{}", read.items);
    let report = junit_parser::from_reader(Cursor::new(text(&written.junit))).unwrap();
    assert_eq!(report.suites.len(), 11);
    assert_eq!(written.results.len(), 10);
    assert_eq!(deqp::read(&text(&written.results[9])).unwrap().len(), 8000);
}
