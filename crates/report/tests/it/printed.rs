//! The text of every report of small fixed runs, as snapshots.

use crate::bench;
use crate::runs_made::{Two, one_adapter, record_all, rich};
use crate::synthetic;
use crate::verdicts::every_verdict;
use etalon_record::{Hunt, Run, Time, Verdict};
use etalon_report::{
    TableOptions, bench_table, diff, diff_table, hunt_table, runs, table, write, write_bench,
    write_diff, write_hunt,
};
use insta::assert_snapshot;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const WIDE: TableOptions = TableOptions {
    width: 160,
    color: false,
};
const NARROW: TableOptions = TableOptions {
    width: 60,
    color: true,
};

/// A page with an element per line, without its style sheet and its script.
fn page(path: &Path) -> String {
    let mut html = fs::read_to_string(path).unwrap();
    for (start, end) in [("<style>", "</style>"), ("<script>", "</script>")] {
        if let Some((before, rest)) = html.split_once(start) {
            let (_, after) = rest.split_once(end).unwrap();
            html = format!("{before}{start}{end}{after}");
        }
    }
    // The digest of the script, which changes with the script.
    let mut parts = html.split("'sha256-");
    let first = parts.next().unwrap_or_default().to_owned();
    let html = parts.fold(first, |before, rest| {
        format!("{before}'sha256-…'{}", rest.split_once('\'').unwrap().1)
    });
    html.replace("><", ">\n<")
}

/// Coloured text with a visible sign for each escape character.
fn colored(text: &str) -> String {
    text.replace('\u{1b}', "␛")
}

fn pretty(path: &Path) -> String {
    let value: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    serde_json::to_string_pretty(&value).unwrap()
}

/// A hunt with a bug of each outcome.
pub(crate) fn hunt() -> Hunt {
    let bug = |name: &str, outcome: &str, areas: Value| {
        json!({
            "mutant": {
                "name": name,
                "about": "Depth is not written.",
                "source": "a driver",
                "area": "depth",
            },
            "outcome": outcome,
            "areas": areas,
        })
    };
    let area = |area: &str, [pass, imprecise, fail, broken]: [u64; 4]| json!({ "area": area, "pass": pass, "imprecise": imprecise, "fail": fail, "broken": broken });
    let mut caught = bug(
        "depth/write-ignored",
        "caught",
        json!([area("depth", [3, 1, 2, 0]), area("blend", [4, 0, 1, 0])]),
    );
    caught["first"] = json!({ "case": "depth/compare/compare=less", "verdict": "fail" });
    let hunt = json!({
        "format": 2,
        "etalon": "0.1.0",
        "machine": { "os": "Linux", "cpu": "A processor", "cores": 2 },
        "started": "2026-01-02T03:04:05Z",
        "command": ["etalon", "mutants"],
        "seconds": 12.5,
        "cases": 11,
        "full": false,
        "mutants": [
            caught,
            bug("depth/elsewhere", "caught", json!([area("depth", [6, 0, 0, 0]), area("blend", [4, 0, 1, 0])])),
            bug("depth/rounds-down", "noticed", json!([area("depth", [3, 3, 0, 0])])),
            bug("depth/survivor", "survived", json!([area("depth", [6, 0, 0, 0])])),
            bug("depth/panics", "broken", json!([area("depth", [0, 0, 0, 6])])),
        ],
        "innocents": [
            {
                "innocent": {
                    "name": "freedom/slope-root", "about": "It takes the root.", "source": "the text",
                    "permissions": ["slope_root"], "is_itself": false, "is_profile": false,
                },
                "changed": 4,
                "specifications": [
                    { "specification": "Vulkan 1.4", "imprecise": 4, "violations": 0 },
                    { "specification": "WebGPU (draft)", "forbidden": "disputed", "imprecise": 0, "violations": 4,
                      "worst": { "case": "depth/bias", "verdict": "fail" } },
                ],
            },
        ],
    });
    serde_json::from_value(hunt).unwrap()
}

#[test]
fn a_run_prints_as_recorded_in_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let run = Run::read(folder.path()).unwrap();
    assert_snapshot!("run-wide", table(&run, WIDE));
    assert_snapshot!("run-narrow", colored(&table(&run, NARROW)));
    let methods = folder.path().join("methods");
    synthetic::methods::write(&methods);
    let run = Run::read(&methods).unwrap();
    assert_snapshot!("run-methods", table(&run, WIDE));
}

#[test]
fn a_run_is_written_to_files_as_recorded() {
    let folder = tempfile::tempdir().unwrap();
    every_verdict(folder.path());
    let written = write(folder.path()).unwrap();
    assert_snapshot!("junit", fs::read_to_string(&written.junit).unwrap());
    assert_snapshot!("summary", fs::read_to_string(&written.summary).unwrap());
    assert_snapshot!("results", fs::read_to_string(&written.results[0]).unwrap());
    assert_snapshot!("index", page(&written.html));
}

#[test]
fn compared_runs_print_as_recorded() {
    let two = Two::new();
    let old: Vec<_> = (0..4).map(|i| rich(&format!("blend/f/case={i}"))).collect();
    let mut new = old.clone();
    new[1].verdict = Verdict::Fail;
    new[1].texels.wrong = 2;
    new[2].verdict = Verdict::Pass;
    new[2].counters[0].actual = 143;
    new[3].measured.as_mut().unwrap().distance.rmse = 0.02;
    record_all(&two.before(), &one_adapter(4), &old);
    record_all(&two.after(), &one_adapter(4), &new);
    let found = two.diff();
    assert_snapshot!("runs-table", runs::table(&found, WIDE));
    assert_snapshot!("runs-narrow", colored(&runs::table(&found, NARROW)));
    assert_snapshot!("runs-json", serde_json::to_string_pretty(&found).unwrap());
    two.page(&found);
    assert_snapshot!("runs-page", page(&two.folder.path().join("diff.html")));
}

#[test]
fn benches_print_as_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let [before, after] = ["before", "after"].map(|name| folder.path().join(name));
    let old = bench::write(&before, &bench::header(), 2e-3, Verdict::Pass);
    let new = bench::write(&after, &bench::header(), 2.2e-3, Verdict::Fail);
    let written = write_bench(&after).unwrap();
    assert_snapshot!("bench-table", bench_table(&new, WIDE));
    assert_snapshot!("bench-page", page(&written.html));
    assert_snapshot!("bencher", pretty(&written.bencher));
    assert_snapshot!("benchmark-action", pretty(&written.action));
    let found = diff(&old, &new, Time::Wall);
    assert_snapshot!("benches-table", diff_table(&found, WIDE));
    assert_snapshot!("benches-narrow", colored(&diff_table(&found, NARROW)));
    let path = write_diff(&folder.path().join("diff.html"), &found).unwrap();
    assert_snapshot!("benches-page", page(&path));
}

#[test]
fn hunts_print_as_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let written = write_hunt(folder.path(), &hunt()).unwrap();
    assert_snapshot!("hunt-table", hunt_table(&hunt(), WIDE));
    assert_snapshot!("hunt-narrow", colored(&hunt_table(&hunt(), NARROW)));
    assert_snapshot!("hunt-page", page(&written.html));
}
