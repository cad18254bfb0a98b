//! Expectations: skips, expiry, blessing, lists of deqp-runner.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use etalon_record::{Expectations, Grade, KnownSource, Reason, Run, Verdict};
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// An adapter that crashes on some of these cases, always on the same ones.
const CRASHING: [&str; 4] = ["run", "cull/*", "--adapter", "cpu:fault=abort"];

struct Work {
    folder: tempfile::TempDir,
}

impl Work {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn out(&self) -> PathBuf {
        self.path("out")
    }

    fn run(&self, arguments: &[&str], file: &Path) -> assert_cmd::assert::Assert {
        let mut command = etalon(arguments);
        command.args(["--force", "--out"]).arg(self.out());
        command.arg("--expect").arg(file).assert()
    }

    fn records(&self) -> Vec<etalon_record::Record> {
        Run::read(&self.out()).unwrap().records
    }
}

fn entry(case: &str, verdict: &str, more: Value) -> Value {
    let mut entry = json!({
        "adapter": "cpu*", "driver": "*", "case": case, "verdict": verdict,
        "reason": "it is a test", "evidence": "none"
    });
    let more = more.as_object().unwrap().clone();
    entry.as_object_mut().unwrap().extend(more);
    entry
}

fn write(path: &Path, entries: &[Value]) {
    fs::write(path, json!({ "entries": entries }).to_string()).unwrap();
}

#[test]
fn a_skipped_case_is_not_drawn_and_is_no_pass() {
    let work = Work::new();
    let file = work.path("e.json");
    write(&file, &[entry("cull/*", "skipped", json!({}))]);
    work.run(&CRASHING, &file).code(3);
    for record in work.records() {
        assert_eq!(record.verdict, Verdict::Skipped);
        let reason = Reason::Skipped("it is a test".to_owned());
        assert_eq!(record.reasons, [reason]);
        assert_eq!(record.texels.total, 0);
    }
    write(
        &file,
        &[entry(
            "cull/*",
            "skipped",
            json!({ "expires": "2000-01-31" }),
        )],
    );
    work.run(&CRASHING, &file).code(1);
    assert!(work.records().iter().all(|r| r.verdict != Verdict::Skipped));
}

#[test]
fn versions_and_days_bound_what_is_expected() {
    let work = Work::new();
    let file = work.path("e.json");
    let with = |more: Value, code: i32| {
        write(&file, &[entry("cull/*", "crash", more)]);
        work.run(&CRASHING, &file).code(code);
    };
    // Cases that pass although all are expected to crash are improvements.
    with(json!({}), 2);
    with(json!({ "version": ">=0.2, <7" }), 2);
    with(json!({ "version": ">=7" }), 1);
    with(
        json!({ "expires": "9999-12-31", "link": "https://example.org/1" }),
        2,
    );
    with(json!({ "expires": "2000-01-31" }), 1);
    let late = work.records().into_iter().find(|r| r.unexpected()).unwrap();
    let expired = Reason::Expired {
        day: "2000-01-31".to_owned(),
        reason: "it is a test".to_owned(),
    };
    assert!(late.reasons.contains(&expired), "{late:?}");
    with(json!({ "expires": "31.1.2000" }), 64);
}

#[test]
fn a_flake_excuses_whatever_happens_and_nothing_else() {
    let work = Work::new();
    let file = work.path("e.json");
    write(&file, &[entry("cull/*", "flaky", json!({}))]);
    work.run(&CRASHING, &file).code(0);
    write(&file, &[entry("depth/*", "flaky", json!({}))]);
    work.run(&CRASHING, &file).code(1);
}

#[test]
fn blessing_expects_what_was_seen_and_removes_what_is_better() {
    let work = Work::new();
    let file = work.path("e.json");
    let bless = |arguments: &[&str]| {
        let mut blessing = arguments.to_vec();
        blessing.push("--bless");
        work.run(&blessing, &file)
    };
    bless(&CRASHING).code(0).stderr(contains("entries added"));
    let crashed = work.records();
    let crashed = crashed.iter().filter(|r| r.verdict == Verdict::Crash);
    let read = || Expectations::read(&file).unwrap();
    assert_eq!(read().entries().len(), crashed.count());
    for entry in read().entries() {
        assert!(entry.reason.contains("Not explained yet"), "{entry:?}");
        assert!(entry.evidence.contains("signal 6"), "{entry:?}");
        assert!(entry.version.is_some());
    }
    work.run(&CRASHING, &file).code(0);
    // The same cases on an adapter that draws them right: the entries are about another adapter.
    let before = fs::read(&file).unwrap();
    work.run(&["run", "cull/*", "--adapter", "cpu"], &file)
        .code(0);
    // An entry whose cases all improved is removed; an entry with cases that were not drawn stays.
    let mut entries: Vec<Value> = serde_json::from_slice::<Value>(&before).unwrap()["entries"]
        .as_array()
        .unwrap()
        .clone();
    let mut better = entry("cull/lines/*", "fail", json!({}));
    better["adapter"] = json!("cpu:fault=lost");
    let mut wide = entry("*", "fail", json!({}));
    wide["adapter"] = json!("cpu:fault=flaky");
    entries.push(better);
    entries.push(wide);
    write(&file, &entries);
    bless(&[
        "run",
        "cull/lines",
        "--profile",
        "full",
        "--adapter",
        "cpu:fault=flaky",
    ])
    .code(0)
    .stderr(contains("narrow by hand"));
    assert!(
        read()
            .entries()
            .iter()
            .any(|e| e.adapter == "cpu:fault=flaky")
    );
    let in_ci = |value: &str| {
        let mut command = etalon(&CRASHING);
        command
            .arg("--bless")
            .arg("--expect")
            .arg(&file)
            .arg("--out")
            .arg(work.path("ci"));
        command.env("CI", value).assert()
    };
    let before = fs::read(&file).unwrap();
    in_ci("true").code(64).stderr(contains("CI never"));
    assert_eq!(fs::read(&file).unwrap(), before);
    assert!(!work.path("ci").exists());
    // Without a file to write there is nothing to bless.
    etalon(&["run", "cull/lines", "--adapter", "cpu", "--bless"])
        .current_dir(work.folder.path())
        .assert()
        .code(64)
        .stderr(contains("--expect"));
}

#[test]
fn lists_of_deqp_runner_go_in_and_out() {
    let work = Work::new();
    let listed = etalon(&["list", "cull/*"]).assert();
    let text = String::from_utf8_lossy(&listed.get_output().stdout).into_owned();
    let ids: Vec<&str> = text.lines().collect();
    let write = |name: &str, text: String| {
        fs::write(work.path(name), text).unwrap();
        work.path(name)
    };
    let fails = write(
        "fails.txt",
        format!("# known\n{},Crash\n{}\nno/such,Fail\n", ids[0], ids[1]),
    );
    let flakes = write("flakes.txt", "^cull/lines/\n".to_owned());
    let skips = write("skips.txt", "^blend/.*logic\n".to_owned());
    let results = write(
        "results.csv",
        format!(
            "{},Pass,0.1\n{},Timeout,9.0\n{},Skip,0.0\n",
            ids[0], ids[2], ids[3]
        ),
    );
    let file = work.path("e.json");
    let import = |more: &[&str]| {
        let mut command = etalon(&["expectations", "import", "--adapter", "cpu", "--out"]);
        command.arg(&file);
        for (flag, path) in [
            ("--fails", &fails),
            ("--flakes", &flakes),
            ("--skips", &skips),
            ("--results", &results),
        ] {
            command.arg(flag).arg(path);
        }
        command
            .args(["--reason", "imported", "--evidence", "lists"])
            .args(more)
            .assert()
    };
    import(&[])
        .code(0)
        .stderr(contains("no case matches: no/such,Fail"));
    let read = Expectations::read(&file).unwrap();
    let count = |v: Verdict| read.entries().iter().filter(|e| e.verdict == v).count();
    assert_eq!(
        (
            count(Verdict::Crash),
            count(Verdict::Fail),
            count(Verdict::Timeout)
        ),
        (1, 1, 1)
    );
    assert!(count(Verdict::Flaky) > 3 && count(Verdict::Skipped) > 10);
    // A second import adds nothing.
    import(&[]).code(0).stdout(contains("0 entries added"));
    let lists = work.path("lists");
    let mut export = etalon(&["expectations", "export", "--adapter", "cpu", "--out"]);
    export
        .arg(&lists)
        .arg("--expect")
        .arg(&file)
        .assert()
        .code(0);
    let lines = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(lists.join(name)).unwrap();
        text.lines().map(str::to_owned).collect()
    };
    let mut expected = vec![
        format!("{},Crash", ids[0]),
        format!("{},Fail", ids[1]),
        format!("{},Timeout", ids[2]),
    ];
    expected.sort();
    let mut found = lines("fails.txt");
    found.sort();
    assert_eq!(found, expected);
    assert_eq!(lines("flakes.txt").len(), count(Verdict::Flaky));
    assert_eq!(lines("skips.txt").len(), count(Verdict::Skipped));
    // The results of a run can become the expectations of the next.
    work.run(&CRASHING, &file).code(1);
    etalon(&["report", "--deqp"])
        .arg(work.out())
        .assert()
        .code(1);
    let mut results = fs::read_dir(work.out().join("results")).unwrap();
    let csv = results.next().unwrap().unwrap().path();
    let next = work.path("next.json");
    etalon(&[
        "expectations",
        "import",
        "--adapter",
        "cpu:fault=abort",
        "--results",
    ])
    .arg(csv)
    .args(["--reason", "known", "--evidence", "a run", "--out"])
    .arg(&next)
    .assert()
    .code(0);
    work.run(&CRASHING, &next).code(0);

    let broken = write(
        "broken.txt",
        format!("{},Fail\n{},Broken\n", ids[0], ids[1]),
    );
    etalon(&["expectations", "import", "--adapter", "cpu", "--fails"])
        .arg(broken)
        .args(["--reason", "r", "--evidence", "e", "--out"])
        .arg(work.path("none.json"))
        .assert()
        .code(64)
        .stderr(contains("broken.txt:2: ").and(contains("Broken")));
    assert!(!work.path("none.json").exists());
}

#[test]
fn dead_entries_are_named_and_strictness_makes_them_count() {
    let work = Work::new();
    let file = work.path("e.json");
    let cpu = [
        "run",
        "cull/triangle-list/*",
        "--profile",
        "full",
        "--adapter",
        "cpu",
    ];
    let strict = [&cpu[..], &["--strict-expectations"]].concat();
    fs::write(&file, "").unwrap();
    work.run(&strict, &file).code(0);
    fs::write(&file, "[]").unwrap();
    work.run(&strict, &file).code(0);
    let mut elsewhere = entry("cull/triangle-list/*", "crash", json!({}));
    elsewhere["adapter"] = json!("cpu:no-such");
    let mut flaky = entry("cull/lines/*", "flaky", json!({}));
    flaky["adapter"] = json!("cpu");
    let narrow = entry("cull/lines/*", "flaky", json!({ "adapter": "cpu" }));
    for (alive, dead, word) in [
        (
            None,
            entry("cull/faecs/*", "fail", json!({})),
            "no case matches",
        ),
        (None, elsewhere, "no adapter matches"),
        (Some(flaky), narrow, "entry 2: "),
        (
            None,
            entry("cull/triangle-list/*", "crash", json!({})),
            "never matched",
        ),
    ] {
        let entries: Vec<Value> = alive.into_iter().chain([dead]).collect();
        write(&file, &entries);
        // Entries whose verdict never occurs are improvements.
        let code = if word == "never matched" { 2 } else { 0 };
        work.run(&cpu, &file)
            .code(code)
            .stderr(contains("1 dead expectation\n").and(contains(word)))
            .stderr(contains("--strict-expectations"));
        let page = fs::read_to_string(work.out().join("index.html")).unwrap();
        assert!(page.contains("Dead expectations"), "{word}");
        work.run(&strict, &file).code(1).stderr(contains(word));
    }
    // Nothing is known about cases that were not selected.
    write(&file, &[entry("cull/*", "crash", json!({}))]);
    work.run(&strict, &file)
        .code(2)
        .stderr(contains("dead").not());
    // The list is replaced together with its run.
    write(&file, &[]);
    work.run(&cpu, &file).code(0);
    assert!(!work.out().join("dead-expectations.json").exists());
}

#[test]
fn a_share_that_was_not_asserted_is_not_green() {
    let work = Work::new();
    let file = work.path("e.json");
    write(&file, &[entry("cull/lines/*", "skipped", json!({}))]);
    let run = |least: &str| {
        let arguments = [
            "run",
            "cull/triangle-list/*",
            "cull/lines/*",
            "--adapter",
            "cpu",
            "--min-asserted",
            least,
        ];
        work.run(&arguments, &file)
    };
    run("100")
        .code(1)
        .stderr(contains("records asserted something"));
    run("0").code(0);
    let records = work.records();
    let asserted = records.iter().filter(|r| r.asserts()).count();
    let share = 100.0 * asserted as f64 / records.len() as f64;
    assert!(share > 10.0 && share < 90.0, "{share}");
    run(&format!("{}", share - 0.1)).code(0);
    run(&format!("{}", share + 0.1)).code(1);
    run("101").code(64);
    // Measured cases do not count; a run of only these asserts nothing.
    etalon(&[
        "run",
        "methods/depth-precision/*",
        "--adapter",
        "cpu",
        "--min-asserted",
        "1",
        "--sizes",
        "none",
        "--out",
    ])
    .arg(work.path("methods"))
    .assert()
    .code(1)
    .stderr(contains("no selected case is judged"));
}

#[test]
fn a_folder_of_findings_is_read_and_blessed() {
    let work = Work::new();
    let folder = work.path("findings");
    fs::create_dir(&folder).unwrap();
    work.run(&CRASHING, &folder).code(1);
    let bless = [&CRASHING[..], &["--bless"]].concat();
    work.run(&bless, &folder)
        .code(0)
        .stderr(contains("findings added"));
    let read = Expectations::read(&folder).unwrap();
    assert!(!read.all().is_empty());
    for known in read.all() {
        assert_eq!(known.verdict, Verdict::Crash);
        match &known.source {
            KnownSource::Finding(finding) => assert_eq!(finding.grade, Grade::Unread),
            KnownSource::Entry { .. } => panic!("an entry of a list"),
        }
    }
    work.run(&CRASHING, &folder).code(0);
    let expected = work.records();
    let titles: Vec<&str> = read.all().iter().map(|k| k.reason.as_str()).collect();
    let named = expected.iter().filter_map(|r| r.expected.as_ref());
    assert!(named.clone().count() > 0);
    assert!(named.clone().all(|e| titles.contains(&e.reason.as_str())));
    // A single finding excuses only its own cases.
    let path = &read.all()[0].path;
    work.run(&CRASHING, path)
        .code(if titles.len() == 1 { 0 } else { 1 });
    // A finding is removed once all its cases improved.
    let text = fs::read_to_string(path).unwrap();
    fs::write(path, text.replace("fault=abort", "fault=lost")).unwrap();
    let cpu = ["run", "cull/triangle-list/*", "--adapter", "cpu"];
    let fixed = json!({
        "title": "t", "adapters": ["cpu"], "driver": "*", "cases": ["cull/triangle-list/*"],
        "grade": "disputed", "clause": "c", "evidence": "e"
    });
    fs::write(folder.join("fixed.json"), fixed.to_string()).unwrap();
    let full = [&cpu[..], &["--profile", "full", "--bless"]].concat();
    work.run(&full, &folder)
        .code(0)
        .stderr(contains("1 removed"));
    assert!(!folder.join("fixed.json").exists());
    // An invalid finding is reported with its place.
    fs::write(folder.join("z.json"), "{\n\"titel\": 1 }").unwrap();
    work.run(&CRASHING, &folder)
        .code(64)
        .stderr(contains("z.json:2: ").and(contains("titel")));
}

/// Among other bugs, softpipe does not clamp the second source and gives points the wrong facing, so whole
/// axis values fail.
#[test]
fn failures_on_a_driver_are_blessed_by_globs_that_all_match() {
    let work = Work::new();
    let folder = work.path("findings");
    fs::create_dir(&folder).unwrap();
    // Without the built-in findings, since most of these are about softpipe. Its outlines change between runs.
    let alone = "--expect-only";
    let run = [
        "run",
        "blend/*",
        "cull/points",
        "cull/stencil-faces*",
        "--adapter",
        "gl:softpipe",
        alone,
    ];
    work.run(&[&run[..], &["--bless"]].concat(), &folder)
        .code(0);
    let failing = work.records().iter().filter(|r| r.verdict.is_bad()).count();
    assert!(failing > 20, "{failing}");
    let read = Expectations::read(&folder).unwrap();
    let findings = fs::read_dir(&folder).unwrap().count();
    assert!(findings * 2 < failing, "{findings} of {failing}");
    assert!(read.all().len() < failing);
    let text = |known: &etalon_record::Known| fs::read_to_string(&known.path).unwrap();
    assert!(read.all().iter().any(|known| text(known).contains("/*")));
    // In a second run nothing is unexpected, and every glob is used.
    work.run(&[&run[..], &["--strict-expectations"]].concat(), &folder)
        .code(0)
        .stderr(contains("dead").not());
    let better = work.records().into_iter().filter(|r| r.improvement());
    assert_eq!(better.count(), 0);
}

#[test]
fn the_time_grows_with_the_number_of_expectations_and_no_faster() {
    let work = Work::new();
    let run = |file: &Path| {
        let begun = Instant::now();
        work.run(&["run", "cull/lines", "--adapter", "cpu"], file)
            .code(0);
        begun.elapsed()
    };
    let file = work.path("expect.json");
    write(&file, &[]);
    let without = run(&file);
    let letters = |mut number: usize| -> String {
        let letter = |_| {
            let letter = b"abcdefghilmnoprstuw0123456789=/-"[number % 32];
            number /= 32;
            format!("*{}", char::from(letter))
        };
        (0..4).map(letter).collect()
    };
    for (what, count, glob) in [
        ("stars", 4_000, &letters as &dyn Fn(usize) -> String),
        ("numbers", 20_000, &|n| format!("*{n}*a*b*c*")),
        ("prefixes", 20_000, &|n| format!("depth/compare/*{n}*")),
        ("ids", 50_000, &|n| format!("depth/compare/n={n}")),
        ("repeated", 50_000, &|_| "blend/*".to_owned()),
    ] {
        let entries: Vec<Value> = (0..count)
            .map(|n| entry(&glob(n), "crash", json!({})))
            .collect();
        write(&file, &entries);
        let took = run(&file).saturating_sub(without);
        // The tests' build takes some times as long as a release's.
        println!("{count} {what}: {took:?}");
        assert!(took < Duration::from_secs(60), "{what}: {took:?}");
    }
}

#[test]
fn a_long_list_is_imported_at_once() {
    let work = Work::new();
    let ids = etalon(&["list", "--profile", "full"]).assert().code(0);
    let ids = String::from_utf8(ids.get_output().stdout.clone()).unwrap();
    let ids: Vec<&str> = ids.lines().collect();
    let (fails, flakes) = (work.path("fails.txt"), work.path("flakes.txt"));
    let repeated = || ids.iter().cycle().take(50_000);
    fs::write(
        &fails,
        repeated()
            .map(|id| format!("{id},Fail\n"))
            .collect::<String>(),
    )
    .unwrap();
    let regexes = repeated().enumerate().map(|(n, id)| match n % 2 {
        0 => format!("^{id}$\n"),
        _ => format!("{id}.*\n"),
    });
    fs::write(&flakes, regexes.collect::<String>()).unwrap();
    for (flag, list) in [("--fails", &fails), ("--flakes", &flakes)] {
        let begun = Instant::now();
        etalon(&[
            "expectations",
            "import",
            "--adapter",
            "*",
            "--reason",
            "r",
            "--evidence",
            "e",
        ])
        .arg(flag)
        .arg(list)
        .arg("--out")
        .arg(work.path("list.json"))
        .assert()
        .code(0);
        println!("{flag}: {:?}", begun.elapsed());
        assert!(begun.elapsed() < Duration::from_secs(40), "{flag}");
    }
}

#[test]
fn a_finding_that_needs_an_unknown_fact_is_refused() {
    let work = Work::new();
    let file = work.path("finding.json");
    let finding = |need: &str| {
        let finding = json!({
            "title": "t", "adapters": ["*"], "driver": "*", "cases": ["cull/*"], "needs": [need],
            "grade": "proven", "clause": "c", "evidence": "e"
        });
        fs::write(&file, finding.to_string()).unwrap();
    };
    for (need, message) in [
        (
            "scisor",
            "no draw has a fact `scisor`; did you mean `scissor`?",
        ),
        ("samples={2,4", "\"needs\": "),
    ] {
        finding(need);
        work.run(&CRASHING, &file)
            .code(64)
            .stderr(contains(message));
    }
}
