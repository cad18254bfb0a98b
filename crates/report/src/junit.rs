//! `junit.xml`, for continuous integration.
//!
//! One suite per adapter, one test case per case. What speaks against the run is a failure (Fail,
//! Open, Flaky and a selftest that did not fail) or an error (Crash and its kin); NotSupported is
//! skipped. A bad verdict that was expected or due is a success with a note, since a viewer shows
//! skipped cases as not run, and these did run. A last suite, `etalon`, holds one case that fails
//! when the run is empty or incomplete: what was not run must not look green.

use crate::grid::Grid;
use crate::words::{Tone, headline, name};
use etalon_record::{Record, Run, Verdict};
use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

pub(crate) fn xml(run: &Run) -> Result<String, SerializeError> {
    let grid = Grid::new(run);
    let mut report = Report::new("etalon");
    for (column, adapter) in grid.adapters.iter().enumerate() {
        let mut suite = TestSuite::new(*adapter);
        suite.add_property(("started", run.header.started.as_str()));
        if let Some(facts) = run.header.adapter(adapter) {
            suite.add_property(("device", facts.device.as_str()));
            suite.add_property(("driver", facts.driver_text().as_str()));
            suite.add_property(("api", facts.api_version.as_str()));
        }
        for area in &grid.areas {
            for index in area.on(column) {
                suite.add_test_case(test_case(grid.record(index)));
            }
        }
        report.add_test_suite(suite);
    }
    report.add_test_suite(completeness(run));
    report.to_string()
}

fn test_case(record: &Record) -> TestCase {
    let mut case = TestCase::new(record.case.as_str(), status(record));
    case.set_classname(record.case_file());
    let seconds = record.seconds.draw + record.seconds.judge;
    case.set_time(Duration::try_from_secs_f64(seconds).unwrap_or_default());
    let note = match (&record.expected, record.improves) {
        (Some(expected), _) => Some(format!("expected: {}", expected.reason)),
        (None, Some(verdict)) => Some(format!(
            "better than expected: {} is no longer due",
            name(verdict)
        )),
        _ if Tone::of(record) == Tone::Excused => Some("due to fail, and fails".to_owned()),
        _ if record.verdict == Verdict::Imprecise => Some("legal, not precise".to_owned()),
        _ => None,
    };
    if let Some(note) = note {
        let headline = headline(record);
        case.set_system_out(format!("{}; {note}\n{headline}", name(record.verdict)));
    }
    case
}

fn status(record: &Record) -> TestCaseStatus {
    if !record.unexpected() {
        if !matches!(record.verdict, Verdict::NotSupported | Verdict::Skipped) {
            return TestCaseStatus::success();
        }
        let mut status = TestCaseStatus::skipped();
        status.set_type(record.verdict.name());
        status.set_message(headline(record));
        return status;
    }
    let kind = match record.verdict {
        Verdict::Crash
        | Verdict::Timeout
        | Verdict::DeviceLost
        | Verdict::ResourceError
        | Verdict::InternalError => NonSuccessKind::Error,
        _ => NonSuccessKind::Failure,
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(record.verdict.name());
    status.set_message(format!("{}: {}", name(record.verdict), headline(record)));
    let mut text = record.message.clone();
    if let Some(story) = &record.story {
        if !text.is_empty() {
            text.push_str("\n\n");
        }
        text.push_str(&story.to_string());
    }
    if let Some(frame) = &record.frame {
        text.push_str(&format!("\nframe: {frame}\n"));
    }
    status.set_description(text);
    status
}

fn completeness(run: &Run) -> TestSuite {
    let missing = run.missing();
    let message = if run.records.is_empty() {
        Some("no case was run".to_owned())
    } else if missing > 0 {
        Some(format!(
            "{missing} of {} records are missing",
            run.header.expected_records()
        ))
    } else if run.truncated {
        Some("the last record was cut off".to_owned())
    } else {
        None
    };
    let status = match message {
        None => TestCaseStatus::success(),
        Some(message) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_type("incomplete");
            status.set_message(message);
            status
        }
    };
    let mut suite = TestSuite::new("etalon");
    suite.add_test_case(TestCase::new("the run is complete", status));
    suite
}
