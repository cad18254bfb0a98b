//! `ctrf.json`, in the Common Test Report Format (<https://ctrf.io>, specification 0.0).
//!
//! There is one test per case and adapter; its suite is the adapter, the area and the case file. A last test
//! fails if the run is empty or incomplete. `rawStatus` is the verdict. The status is
//!
//! | status | records |
//! |---|---|
//! | `failed` | unexpected records: a bad verdict that no expectation names, and a selftest that did not fail |
//! | `passed` | Pass, Imprecise, and selftests that failed as they should |
//! | `other` | Measured, which is no judgement, and bad verdicts that the expectations name or triage settled |
//! | `skipped` | NotSupported and Skipped |
//!
//! `flaky` marks the verdict Flaky. Records have no time of day, so tests have only durations. The run's end
//! is its start plus the sum of the durations, which is too late if several adapters drew at the same time.

use crate::error::ReportError;
use crate::export::status::{Conclusion, account, incomplete, note, particulars, seconds};
use crate::run::grid::Grid;
use crate::words::headline;
use etalon_record::{Record, Run, Verdict};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::time::UNIX_EPOCH;

/// The version of the specification that the file follows.
const SPEC_VERSION: &str = "0.0.0";

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Document<'a> {
    report_format: &'static str,
    spec_version: &'static str,
    generated_by: String,
    results: Results<'a>,
}

#[derive(Serialize)]
struct Results<'a> {
    tool: Value,
    summary: Summary,
    tests: Vec<Test<'a>>,
    environment: Environment<'a>,
}

#[derive(Default, Serialize)]
struct Summary {
    tests: u64,
    passed: u64,
    failed: u64,
    skipped: u64,
    pending: u64,
    other: u64,
    flaky: u64,
    suites: u64,
    start: u64,
    stop: u64,
    duration: u64,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    #[default]
    Passed,
    Failed,
    Skipped,
    Other,
}

#[derive(Default, Serialize)]
#[serde(rename_all = "camelCase")]
struct Test<'a> {
    name: &'a str,
    status: Status,
    duration: u64,
    suite: Vec<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    trace: Option<String>,
    raw_status: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    flaky: Option<bool>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    stdout: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    stderr: Vec<&'a str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    attachments: Vec<Attachment<'a>>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    extra: Map<String, Value>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Attachment<'a> {
    name: &'static str,
    content_type: &'static str,
    path: &'a str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Environment<'a> {
    report_name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    commit: Option<&'a str>,
    os_version: &'a str,
    healthy: bool,
    extra: Value,
}

/// Returns the file.
pub(crate) fn json(run: &Run, grid: &Grid<'_>) -> Result<Vec<u8>, ReportError> {
    let h = &run.header;
    let mut summary = Summary {
        suites: grid.adapters.len() as u64 + 1,
        start: milliseconds_of(&h.started),
        ..Summary::default()
    };
    let mut tests = Vec::with_capacity(run.records.len() + 1);
    let mut total = 0.0;
    for column in 0..grid.adapters.len() {
        for record in grid.on(column) {
            total += seconds(record);
            tests.push(test(record));
        }
    }
    let incomplete = incomplete(run);
    tests.push(completeness(incomplete.clone()));
    for test in &tests {
        summary.tests += 1;
        summary.flaky += u64::from(test.flaky == Some(true));
        let counter = match test.status {
            Status::Passed => &mut summary.passed,
            Status::Failed => &mut summary.failed,
            Status::Skipped => &mut summary.skipped,
            Status::Other => &mut summary.other,
        };
        *counter += 1;
    }
    summary.duration = milliseconds(total);
    summary.stop = summary.start.saturating_add(summary.duration);
    let adapters = h.adapters.iter().map(|a| {
        json!({ "name": a.name, "device": a.device, "driver": a.driver_text(), "apiVersion": a.api_version })
    });
    let document = Document {
        report_format: "CTRF",
        spec_version: SPEC_VERSION,
        generated_by: format!("etalon {}", h.etalon),
        results: Results {
            tool: json!({ "name": "etalon", "version": h.etalon }),
            summary,
            tests,
            environment: Environment {
                report_name: "etalon",
                commit: h.commit.as_deref(),
                os_version: &h.machine.os,
                healthy: incomplete.is_none(),
                extra: json!({
                    "started": h.started,
                    "command": h.command,
                    "cpu": h.machine.cpu,
                    "cores": h.machine.cores,
                    "adapters": adapters.collect::<Vec<_>>(),
                    "settings": h.settings,
                }),
            },
        },
    };
    let mut text = serde_json::to_vec(&document).map_err(ReportError::Json)?;
    text.push(b'\n');
    Ok(text)
}

fn test(record: &Record) -> Test<'_> {
    let conclusion = Conclusion::of(record);
    let status = match conclusion {
        Conclusion::Passed | Conclusion::Due => Status::Passed,
        Conclusion::Measured | Conclusion::Excused => Status::Other,
        Conclusion::Skipped => Status::Skipped,
        Conclusion::Failed | Conclusion::Broken => Status::Failed,
    };
    let against = status == Status::Failed;
    let plain_pass = conclusion == Conclusion::Passed && note(record).is_none();
    let stderr = record.process.as_ref().map(|end| end.stderr.lines());
    Test {
        name: named(&record.case),
        status,
        duration: milliseconds(seconds(record)),
        suite: vec![
            &record.adapter,
            record.parts().area(),
            record.parts().file(),
        ],
        message: match note(record) {
            _ if against => Some(headline(record)),
            Some(note) => Some(format!("{note}; {}", headline(record))),
            None => (!plain_pass).then(|| headline(record)),
        },
        trace: Some(account(record)).filter(|text| against && !text.is_empty()),
        raw_status: record.verdict.name(),
        flaky: (record.verdict == Verdict::Flaky).then_some(true),
        stdout: if against {
            Vec::new()
        } else {
            particulars(record)
        },
        stderr: stderr.into_iter().flatten().collect(),
        attachments: record
            .frame
            .as_deref()
            .map(|path| Attachment {
                name: "frame",
                content_type: "application/gzip",
                path,
            })
            .into_iter()
            .collect(),
        extra: extra(record),
    }
}

/// Returns the facts of a record that the format has no field for.
fn extra(record: &Record) -> Map<String, Value> {
    let channels: u64 = record.assertions.iter().map(|a| a.channels).sum();
    let asserted: u64 = record.assertions.iter().map(|a| a.asserted).sum();
    let t = &record.texels;
    let process = record.process.as_ref().map(|end| {
        json!({ "kind": end.kind, "signal": end.signal, "exit": end.exit, "seconds": end.seconds })
    });
    let facts = json!({
        "adapter": record.adapter,
        "texels": (t.total > 0).then_some(t),
        "asserted": (channels > 0).then(|| asserted as f64 / channels as f64),
        "expected": record.expected.as_ref().map(|expected| &expected.reason),
        "improves": record.improves,
        "dueFail": record.due_fail.then_some(true),
        "repeats": listed(&record.repeats),
        "after": listed(&record.after),
        "blockedBy": listed(&record.blocked_by),
        "process": process,
    });
    match facts {
        Value::Object(mut facts) => {
            facts.retain(|_, value| !value.is_null());
            facts
        }
        _ => Map::new(),
    }
}

/// Returns a list if it is not empty.
fn listed<T>(list: &[T]) -> Option<&[T]> {
    (!list.is_empty()).then_some(list)
}

fn completeness(incomplete: Option<String>) -> Test<'static> {
    let (status, raw_status) = match incomplete {
        None => (Status::Passed, "complete"),
        Some(_) => (Status::Failed, "incomplete"),
    };
    Test {
        name: "the run is complete",
        status,
        suite: vec!["etalon"],
        raw_status,
        message: incomplete,
        ..Test::default()
    }
}

/// Returns a test's name: the case, or a placeholder, because the format requires a name.
fn named(case: &str) -> &str {
    if case.is_empty() { "(no name)" } else { case }
}

fn milliseconds(seconds: f64) -> u64 {
    // The cast saturates if the number is too large. JSON readers with 64-bit floats represent integers up to
    // 2^53.
    ((seconds * 1e3).round() as u64).min(1 << 53)
}

/// Returns the start of a run in milliseconds since 1970, or 0 if the header has none.
fn milliseconds_of(started: &str) -> u64 {
    let time = humantime::parse_rfc3339(started).ok();
    let since = time.and_then(|t| t.duration_since(UNIX_EPOCH).ok());
    since.map_or(0, |d| milliseconds(d.as_secs_f64()))
}
