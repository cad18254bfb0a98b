//! `junit.xml`, for continuous integration.
//!
//! There is one suite per adapter and one test case per case. Unexpected records are failures (Fail,
//! RequiredByCts, Disputed, Open, Flaky and a selftest that did not fail) or errors (Blocked, Crash and other
//! verdicts without a frame). NotSupported and Skipped are skipped. A bad verdict that was expected, due or
//! settled by triage is a success with a note, because viewers show skipped cases as not run, and these did
//! run.
//!
//! The loss of a process, the verdicts of repetitions, the cases that must be drawn before and validation
//! messages are part of the failure, or of `system-out` without a failure. The standard error of a lost
//! process is `system-err`. A last suite, `etalon`, has one case that fails if the run is empty or
//! incomplete, so that an unfinished run does not look green.

use crate::export::status::{CiConclusion, account, incomplete, note, particulars, seconds};
use crate::run::grid::RunGrid;
use crate::words::{headline, name};
use etalon_record::{Record, Run};
use quick_junit::{NonSuccessKind, Report, SerializeError, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

pub(crate) fn xml(run: &Run, grid: &RunGrid<'_>) -> Result<String, SerializeError> {
    let mut report = Report::new("etalon");
    for (column, adapter) in grid.adapters.iter().enumerate() {
        let mut suite = TestSuite::new(*adapter);
        suite.add_property(("started", run.header.provenance.started.as_str()));
        if let Some(facts) = run.header.adapter(adapter) {
            suite.add_property(("device", facts.info.device.as_str()));
            suite.add_property(("driver", facts.driver_text().as_str()));
            suite.add_property(("api", facts.info.api_version.as_str()));
        }
        suite.add_test_cases(grid.on(column).map(test_case));
        let beside = run.beside.iter().filter(|r| r.adapter == *adapter);
        suite.add_test_cases(beside.map(test_case));
        report.add_test_suite(suite);
    }
    report.add_test_suite(completeness(run));
    Ok(well_formed(&report.to_string()?))
}

/// Replaces the characters that XML 1.0 forbids even as references (section 2.2).
fn well_formed(xml: &str) -> String {
    let is_allowed = |c: char| matches!(c, '\t' | '\n' | '\r' | '\u{20}'..='\u{fffd}' | '\u{10000}'..='\u{10ffff}');
    xml.replace(|c| !is_allowed(c), "\u{fffd}")
}

fn test_case(record: &Record) -> TestCase {
    let conclusion = CiConclusion::of(record);
    let mut case = TestCase::new(record.case.as_str(), status(record, conclusion));
    case.set_classname(record.parts().file());
    case.set_time(Duration::try_from_secs_f64(seconds(record)).unwrap_or_default());
    let against = matches!(conclusion, CiConclusion::Failed | CiConclusion::Broken);
    let mut lines = Vec::new();
    if let Some(note) = note(record) {
        lines.push(format!("{}; {note}", name(record.verdict)));
        lines.push(headline(record));
    }
    if !against {
        lines.extend(particulars(record));
    }
    if !lines.is_empty() {
        case.set_system_out(lines.join("\n"));
    }
    let stderr = record.process.as_ref().map(|end| end.stderr.as_str());
    if let Some(stderr) = stderr.filter(|text| !text.is_empty()) {
        case.set_system_err(stderr);
    }
    case
}

fn status(record: &Record, conclusion: CiConclusion) -> TestCaseStatus {
    let kind = match conclusion {
        CiConclusion::Broken => NonSuccessKind::Error,
        CiConclusion::Failed => NonSuccessKind::Failure,
        CiConclusion::Skipped => {
            let mut status = TestCaseStatus::skipped();
            status.set_type(record.verdict.name());
            status.set_message(headline(record));
            return status;
        }
        CiConclusion::Passed
        | CiConclusion::Due
        | CiConclusion::Excused
        | CiConclusion::Measured => {
            return TestCaseStatus::success();
        }
    };
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(record.verdict.name());
    status.set_message(format!("{}: {}", name(record.verdict), headline(record)));
    status.set_description(account(record));
    status
}

fn completeness(run: &Run) -> TestSuite {
    let status = match incomplete(run) {
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
