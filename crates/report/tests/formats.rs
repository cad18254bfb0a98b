//! The files for other programs, read by somebody else's parsers and schemas.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod synthetic;

use deqp_runner::{RunnerResults, RunnerStatus, TestStatus};
use etalon_frame::{Api, Aspect};
use etalon_record::{
    Assertion, Expected, Header, LossKind, ProcessEnd, Record, RunWriter, Verdict, selection_digest,
};
use etalon_report::{Written, write};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use serde_json::Value;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use synthetic::{adapter, header};

const HOSTILE: &str = "\"><script>alert(1)</script>|`a`|![x](http://a.b/c)@me #1\\|&amp;]]>\u{1b}[2J\u{7}\u{202e},\nPass,1";

/// One record per verdict on `gl:a`, and one more for each way in which it can be taken.
fn every_verdict(folder: &Path) -> Vec<Record> {
    let mut records: Vec<Record> = Verdict::ALL
        .into_iter()
        .map(|v| Record::new(format!("depth/all/verdict={v}"), "gl:a", v))
        .collect();
    for verdict in Verdict::ALL.into_iter().filter(|v| v.is_bad()) {
        let mut record = Record::new(format!("blend/expected/verdict={verdict}"), "gl:a", verdict);
        record.expected = Some(Expected {
            reason: "bug 12 of the driver".to_owned(),
        });
        records.push(record);
    }
    for (verdict, due) in [
        (Verdict::Pass, Verdict::Fail),
        (Verdict::Imprecise, Verdict::Flaky),
    ] {
        let mut record = Record::new(format!("blend/better/verdict={verdict}"), "gl:a", verdict);
        record.improves = Some(due);
        records.push(record);
    }
    // Better than a crash, and bad all the same.
    let mut still_bad = Record::new("blend/still-bad", "gl:a", Verdict::Fail);
    still_bad.improves = Some(Verdict::Crash);
    records.push(still_bad);
    for verdict in [Verdict::Fail, Verdict::Pass, Verdict::Crash] {
        let mut record = Record::new(format!("selftest/due/verdict={verdict}"), "gl:a", verdict);
        record.due_fail = true;
        records.push(record);
    }
    let mut lost = Record::new("depth/lost", "gl:a", Verdict::Crash);
    lost.message = "worker lost".to_owned();
    lost.process = Some(ProcessEnd {
        kind: LossKind::Died,
        signal: Some(6),
        exit: None,
        stderr: "LLVM ERROR\nout of registers".to_owned(),
        seconds: 1.5,
    });
    lost.after = vec!["depth/first".to_owned(), "depth/second".to_owned()];
    let mut repeated = Record::new("depth/repeated", "gl:a", Verdict::Pass);
    repeated.repeats = vec![Verdict::Pass; 4];
    repeated.validation = vec!["VUID-1: something".to_owned()];
    records.extend([lost, repeated]);
    let header = header(records.len() as u64, vec![adapter("gl:a", Api::OpenGl)]);
    record_all(folder, &header, &records);
    records
}

fn record_all(folder: &Path, header: &Header, records: &[Record]) {
    let mut writer = RunWriter::create(folder, header).unwrap();
    records.iter().for_each(|r| writer.append(r).unwrap());
}

/// A run whose every text is hostile.
fn hostile(folder: &Path) {
    let mut header = header(3, vec![adapter(HOSTILE, Api::Vulkan)]);
    header.started = HOSTILE.to_owned();
    header.command = vec![HOSTILE.to_owned()];
    header.commit = Some(HOSTILE.to_owned());
    header.machine.cpu = HOSTILE.to_owned();
    header.absent[0].remedy = HOSTILE.to_owned();
    let mut record = Record::new(format!("{HOSTILE}/{HOSTILE}"), HOSTILE, Verdict::Crash);
    record.message = HOSTILE.to_owned();
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

/// Three cases, of which one is recorded whole and one is cut off.
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

/// Runs of every kind that a report has to stand.
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

fn ctrf(written: &Written) -> Value {
    serde_json::from_slice(&fs::read(&written.ctrf).unwrap()).unwrap()
}

#[test]
fn all_files_are_named_and_there() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        assert!(written.all().all(Path::is_file), "{name}");
        let mut count = 0;
        for path in written.all() {
            assert!(path.starts_with(folder.path()), "{name}");
            count += 1;
        }
        let methods = usize::from(name == "methods");
        assert_eq!(count, 4 + methods + written.results.len(), "{name}");
        // Nothing half written is left behind.
        for below in [folder.path().to_owned(), folder.path().join("results")] {
            let mut names = fs::read_dir(below).unwrap().map(|e| e.unwrap().file_name());
            assert!(
                names.all(|n| !n.to_string_lossy().starts_with('.')),
                "{name}"
            );
        }
    }
}

#[test]
fn junit_is_read_by_another_parser() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        let report = junit_parser::from_reader(Cursor::new(text(&written.junit))).unwrap();
        let results = ctrf(&written);
        let tests = results["results"]["tests"].as_array().unwrap().len();
        let cases: usize = report.suites.iter().map(|s| s.cases.len()).sum();
        assert_eq!(cases, tests, "{name}");
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
        let whole = matches!(name, "every verdict" | "hostile" | "believable" | "methods");
        assert_eq!(complete.status.is_success(), whole, "{name}");
    }
}

#[test]
fn junit_tells_what_became_of_processes_and_repetitions() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let written = write(folder.path()).unwrap();
    let report = junit_parser::from_reader(Cursor::new(text(&written.junit))).unwrap();
    let case = |name: &str| {
        let all = report.suites.iter().flat_map(|s| &s.cases);
        let mut found = all.filter(|c| c.original_name == name);
        found.next().unwrap().clone()
    };
    let lost = case("depth/lost");
    assert!(lost.status.is_error());
    assert_eq!(
        lost.system_err.as_deref(),
        Some("LLVM ERROR\nout of registers")
    );
    let told = &lost.status.error_as_ref().text;
    assert!(told.contains("signal 6"), "{told}");
    assert!(
        told.contains("only after depth/first, then depth/second"),
        "{told}"
    );
    let repeated = case("depth/repeated");
    assert!(repeated.status.is_success());
    let told = repeated.system_out.unwrap();
    assert!(
        told.contains("repeated in fresh processes: 4 × pass"),
        "{told}"
    );
    assert!(told.contains("validation: VUID-1: something"), "{told}");
    assert!(case("depth/all/verdict=skipped").status.is_skipped());
    assert!(case("depth/all/verdict=not-supported").status.is_skipped());
}

#[test]
fn ctrf_keeps_to_the_schema_of_the_format() {
    let schema: Value =
        serde_json::from_str(include_str!("data/ctrf/ctrf-schema-0.0.json")).unwrap();
    let validator = jsonschema::options()
        .should_validate_formats(true)
        .build(&schema)
        .unwrap();
    for (name, folder) in runs() {
        let document = ctrf(&write(folder.path()).unwrap());
        let errors: Vec<String> = validator
            .iter_errors(&document)
            .take(3)
            .map(|e| format!("{}: {e}", e.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        let results = &document["results"];
        let tests = results["tests"].as_array().unwrap();
        let summary = &results["summary"];
        assert_eq!(summary["tests"], tests.len());
        for status in ["passed", "failed", "skipped", "other", "pending"] {
            let count = tests.iter().filter(|t| t["status"] == status).count();
            assert_eq!(summary[status], count, "{name} {status}");
        }
        let (start, stop) = (&summary["start"], &summary["stop"]);
        assert!(start.as_u64().unwrap() <= stop.as_u64().unwrap(), "{name}");
    }
    // The schema is not one that takes anything.
    let mut wrong = ctrf(&write(runs()[0].1.path()).unwrap());
    wrong["results"]["tests"][0]["status"] = "expected".into();
    assert!(!validator.is_valid(&wrong));
}

#[test]
fn ctrf_statuses_are_those_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let records = every_verdict(folder.path());
    let document = ctrf(&write(folder.path()).unwrap());
    let tests = document["results"]["tests"].as_array().unwrap();
    for record in &records {
        let test = tests.iter().find(|t| t["name"] == record.case).unwrap();
        let due = match record.verdict {
            _ if record.unexpected() => "failed",
            Verdict::NotSupported | Verdict::Skipped => "skipped",
            Verdict::Measured => "other",
            _ if record.expected.is_some() => "other",
            _ => "passed",
        };
        assert_eq!(test["status"], due, "{record:?}");
        assert_eq!(test["rawStatus"], record.verdict.name());
        assert_eq!(test["suite"][0], "gl:a");
        let flaky = record.verdict == Verdict::Flaky;
        assert_eq!(test["flaky"] == true, flaky, "{record:?}");
    }
    let lost = tests.iter().find(|t| t["name"] == "depth/lost").unwrap();
    assert_eq!(lost["stderr"][1], "out of registers");
    assert_eq!(lost["extra"]["process"]["signal"], 6);
    assert_eq!(lost["extra"]["after"][1], "depth/second");
    assert_eq!(document["results"]["summary"]["flaky"], 2);
    assert_eq!(document["results"]["environment"]["healthy"], true);
    assert_eq!(
        document["results"]["summary"]["start"],
        1_767_323_045_000_u64
    );
}

fn deqp(path: &Path) -> RunnerResults {
    RunnerResults::from_csv(&mut fs::File::open(path).unwrap()).unwrap()
}

#[test]
fn deqp_runner_reads_its_lists() {
    for (name, folder) in runs() {
        let written = write(folder.path()).unwrap();
        let document = ctrf(&written);
        let mut lines = 0;
        for path in &written.results {
            lines += deqp(path).tests.len();
        }
        // One test of the other format stands for the run itself.
        let tests = document["results"]["tests"].as_array().unwrap().len() - 1;
        let due = match name {
            // Two of three ids are none that deqp-runner can read, and so is the third, which is empty.
            "hostile" => 0,
            // Two that are missing are listed as such.
            "truncated" => 3,
            _ => tests,
        };
        assert_eq!(lines, due, "{name}");
    }
}

#[test]
fn deqp_runner_understands_every_status() {
    let folder = tempfile::tempdir().unwrap();
    let records = every_verdict(folder.path());
    let written = write(folder.path()).unwrap();
    assert!(written.results[0].ends_with("results/gl_a.csv"));
    let results = deqp(&written.results[0]);
    for record in &records {
        let plain = match record.verdict {
            Verdict::Pass => RunnerStatus::Pass,
            Verdict::Imprecise => RunnerStatus::Warn,
            Verdict::Fail | Verdict::Open | Verdict::ResourceError | Verdict::InternalError => {
                RunnerStatus::Fail
            }
            Verdict::Measured | Verdict::NotSupported | Verdict::Skipped => RunnerStatus::Skip,
            Verdict::Flaky => RunnerStatus::Flake,
            Verdict::Crash | Verdict::DeviceLost => RunnerStatus::Crash,
            Verdict::Timeout => RunnerStatus::Timeout,
        };
        let due = match record.case.as_str() {
            "blend/expected/verdict=flaky" => RunnerStatus::KnownFlake,
            case if case.starts_with("blend/expected") => RunnerStatus::ExpectedFail,
            "blend/better/verdict=pass" => RunnerStatus::UnexpectedImprovement(TestStatus::Pass),
            "blend/better/verdict=imprecise" => {
                RunnerStatus::UnexpectedImprovement(TestStatus::Warn)
            }
            "selftest/due/verdict=fail" => RunnerStatus::ExpectedFail,
            "selftest/due/verdict=pass" => RunnerStatus::Fail,
            _ => plain,
        };
        let found = results.get(&record.case).unwrap();
        assert_eq!(found.status, due, "{record:?}");
        // What speaks against the run speaks against it there, but for flakes, which deqp-runner lets pass.
        let flake = record.verdict == Verdict::Flaky;
        assert_eq!(found.status.is_regression(), record.unexpected() && !flake);
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
    assert_eq!(deqp(&written.results[0]).tests.len(), 1);
}

#[test]
fn missing_records_are_missing_in_lists_of_deqp_runner() {
    let folder = tempfile::tempdir().unwrap();
    truncated(folder.path());
    let written = write(folder.path()).unwrap();
    let list = text(&written.results[0]);
    assert_eq!(list, "a/0,Pass,0\na/1,Missing,0\na/2,Missing,0\n");
    // Without the list of cases they are counted.
    fs::remove_file(folder.path().join("cases.txt")).unwrap();
    let list = text(&write(folder.path()).unwrap().results[0]);
    assert!(
        list.starts_with("# incomplete: 2 records missing"),
        "{list}"
    );
}

/// What a reader of Markdown makes of a summary.
#[derive(Default)]
struct Read {
    /// Rows of all tables, their heads included, as the text of their cells.
    rows: Vec<Vec<String>>,
    /// Items of lists.
    items: usize,
    /// All text, code included.
    text: String,
}

fn read_markdown(markdown: &str) -> Read {
    let mut read = Read::default();
    let mut in_cell = false;
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH | Options::ENABLE_MATH;
    for event in Parser::new_ext(markdown, options) {
        match event {
            Event::Html(html) | Event::InlineHtml(html) => panic!("HTML: {html}"),
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                panic!("link to {dest_url}")
            }
            Event::Start(Tag::Strikethrough | Tag::CodeBlock(_) | Tag::BlockQuote(_))
            | Event::InlineMath(_)
            | Event::DisplayMath(_) => panic!("{event:?}"),
            Event::Start(Tag::TableHead | Tag::TableRow) => read.rows.push(Vec::new()),
            Event::Start(Tag::TableCell) => {
                read.rows.last_mut().unwrap().push(String::new());
                in_cell = true;
            }
            Event::End(TagEnd::TableCell) => in_cell = false,
            Event::Start(Tag::Item) => read.items += 1,
            Event::End(TagEnd::Table) => read.text.push('\n'),
            Event::Text(text) | Event::Code(text) => {
                read.text.push_str(&text);
                if in_cell {
                    read.rows
                        .last_mut()
                        .unwrap()
                        .last_mut()
                        .unwrap()
                        .push_str(&text);
                }
            }
            Event::SoftBreak | Event::HardBreak => read.text.push('\n'),
            _ => {}
        }
    }
    read
}

#[test]
fn the_summary_holds_no_markup_of_others() {
    for (name, folder) in runs() {
        let summary = text(&write(folder.path()).unwrap().summary);
        let read = read_markdown(&summary);
        assert!(!summary.contains(['\u{1b}', '\u{7}', '\u{202e}']), "{name}");
        // A mention is one when a letter follows; in code there are none.
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
fn the_summary_tells_counts_records_and_commands() {
    let folder = tempfile::tempdir().unwrap();
    let mut records = every_verdict(folder.path());
    let header = header(records.len() as u64, vec![adapter("gl:a", Api::OpenGl)]);
    let writer = RunWriter::create(folder.path(), &header).unwrap();
    let at = records
        .iter()
        .position(|r| r.case == "depth/all/verdict=fail")
        .unwrap();
    records[at] = synthetic::record(&writer, "depth/all/verdict=fail", "gl:a", Verdict::Fail, 1);
    record_all(folder.path(), &header, &records);
    let summary = text(&write(folder.path()).unwrap().summary);
    let read = read_markdown(&summary);
    let adapters = &read.rows[1];
    assert_eq!(adapters[0], "gl:a");
    let unexpected = records.iter().filter(|r| r.unexpected()).count();
    assert_eq!(*adapters.last().unwrap(), unexpected.to_string());
    // Each unexpected record and each improvement, and the adapter that is absent.
    assert_eq!(read.items, unexpected + 2 + 1);
    let (x, y) = (records[at].wrong[0].x, records[at].wrong[0].y);
    for due in [
        format!("{unexpected} unexpected records"),
        format!("etalon explain depth/all/verdict=fail --texel {x},{y} --adapter gl:a"),
        "etalon run depth/lost --adapter gl:a".to_owned(),
        "only after depth/first, then depth/second".to_owned(),
        "2 improvements".to_owned(),
        "What was asserted".to_owned(),
    ] {
        let told = read.text.replace('\u{2060}', "");
        assert!(told.contains(&due), "{due}: {told}");
    }
}

#[test]
fn files_of_a_huge_run_keep_their_limits() {
    let folder = tempfile::tempdir().unwrap();
    // Ids long enough that a list of them would not fit, were they not cut.
    let long = "x|".repeat(500);
    let adapters: Vec<_> = (0..10)
        .map(|i| adapter(&format!("a:{i}"), Api::Vulkan))
        .collect();
    let names: Vec<String> = adapters.iter().map(|a| a.name.clone()).collect();
    let mut writer = RunWriter::create(folder.path(), &header(8000, adapters)).unwrap();
    for case in 0..8000 {
        for (at, name) in names.iter().enumerate() {
            let verdict = Verdict::ALL[(case + at) % Verdict::ALL.len()];
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
    assert_eq!(deqp(&written.results[9]).tests.len(), 8000);
    assert_eq!(ctrf(&written)["results"]["summary"]["tests"], 80_001);
}
