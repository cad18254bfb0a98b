//! The conclusion of a record in files for other programs, and the texts that go with its verdict.

use crate::numbers::count;
use crate::words::{message, name, plain, process_end, repetitions, story_text};
use etalon_record::{Record, Run, Verdict};

/// The conclusion that continuous integration draws from a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CiConclusion {
    /// The frame is right by the API's specification.
    Passed,
    /// A selftest that was due to fail, and failed.
    Due,
    /// A bad verdict that the expectations name.
    Excused,
    /// Drawn but not judged.
    Measured,
    /// The case was not drawn.
    Skipped,
    /// Unexpected: a wrong frame, or a selftest that did not fail.
    Failed,
    /// Unexpected: there is no frame.
    Broken,
}

impl CiConclusion {
    pub(crate) fn of(record: &Record) -> Self {
        let verdict = record.verdict;
        if record.unexpected() {
            return match verdict {
                Verdict::Blocked
                | Verdict::Crash
                | Verdict::Timeout
                | Verdict::DeviceLost
                | Verdict::ResourceError
                | Verdict::InternalError => Self::Broken,
                _ => Self::Failed,
            };
        }
        match verdict {
            Verdict::NotSupported | Verdict::Skipped => Self::Skipped,
            Verdict::Measured => Self::Measured,
            bad if record.due_fail && bad.is_violation() => Self::Due,
            bad if bad.is_bad() => Self::Excused,
            _ => Self::Passed,
        }
    }
}

/// Returns the seconds of drawing and judging a case, from 0 to a year, even for a damaged record.
pub(crate) fn seconds(record: &Record) -> f64 {
    const YEAR: f64 = 366.0 * 86_400.0;
    let both = record.seconds.draw + record.seconds.judge;
    // NaN counts as 0.
    if both > 0.0 { both.min(YEAR) } else { 0.0 }
}

/// Returns the reason why the run is incomplete, or `None` if it is complete. An incomplete run must not look
/// green.
pub(crate) fn incomplete(run: &Run) -> Option<String> {
    let missing = run.missing();
    // A shard can be empty if the other shards have all cases.
    let empty_shard = run.header.settings.shard.is_some() && run.header.cases == 0;
    if run.records.is_empty() && !empty_shard {
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
    }
}

/// Returns a remark on an expected record, unless it is a plain pass.
pub(crate) fn note(record: &Record) -> Option<String> {
    match (&record.expected, record.improves) {
        (Some(expected), _) => Some(format!("expected: {}", expected.reason)),
        (None, Some(verdict)) => Some(format!(
            "better than expected: {} is no longer due",
            name(verdict)
        )),
        _ if CiConclusion::of(record) == CiConclusion::Due => {
            Some("due to fail, and fails".to_owned())
        }
        _ if record.verdict == Verdict::Imprecise => Some("legal, not precise".to_owned()),
        _ => None,
    }
}

/// Returns the facts of a record other than its verdict, message and texels, one line each: the loss of its
/// process, the verdicts of repetitions, the cases that must be drawn before, and validation messages.
pub(crate) fn particulars(record: &Record) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(end) = &record.process {
        lines.push(process_end(end));
    }
    if !record.repeats.is_empty() {
        lines.push(format!(
            "repeated in fresh processes: {}",
            repetitions(&record.repeats)
        ));
    }
    if !record.after.is_empty() {
        lines.push(format!("only after {}", record.after.join(", then ")));
    }
    for message in &record.validation {
        lines.push(format!("validation: {}", plain(message, 4000)));
    }
    lines
}

/// Returns all facts of an unexpected record, for people.
pub(crate) fn account(record: &Record) -> String {
    let mut parts = Vec::new();
    let message = message(record);
    if !message.is_empty() {
        parts.push(message);
    }
    let particulars = particulars(record);
    if !particulars.is_empty() {
        parts.push(particulars.join("\n"));
    }
    if record.texels.wrong > 0 {
        parts.push(format!(
            "{} of {} outside the legal set",
            record.texels.wrong,
            count(record.texels.total, "sample")
        ));
    }
    if let Some(story) = &record.story {
        parts.push(story_text(story));
    }
    if let Some(frame) = &record.frame {
        parts.push(format!("frame: {frame}"));
    }
    parts.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::{Expected, Seconds};

    #[test]
    fn exactly_unexpected_records_are_failed_or_broken() {
        for verdict in Verdict::ALL {
            for (is_due, expected) in [(false, false), (true, false), (false, true), (true, true)] {
                let mut record = Record::new("a/b", "cpu", verdict);
                record.due_fail = is_due;
                record.expected = expected.then(|| Expected {
                    reason: "known".to_owned(),
                });
                let conclusion = CiConclusion::of(&record);
                let against = matches!(conclusion, CiConclusion::Failed | CiConclusion::Broken);
                assert_eq!(against, record.unexpected(), "{record:?}");
                if matches!(conclusion, CiConclusion::Passed) {
                    assert!(matches!(verdict, Verdict::Pass | Verdict::Imprecise));
                }
            }
        }
    }

    #[test]
    fn seconds_are_finite() {
        let mut record = Record::new("a", "b", Verdict::Pass);
        for (draw, expected) in [
            (f64::NAN, 0.0),
            (-1.0, 0.0),
            (f64::INFINITY, 366.0 * 86_400.0),
            (0.5, 0.5),
        ] {
            record.seconds = Seconds { draw, judge: 0.0 };
            assert_eq!(seconds(&record), expected);
        }
    }
}
