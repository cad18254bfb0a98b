//! The reasons of a record in words.

use crate::numbers::{bytes, duration};
use etalon_frame::{Api, ApiVersion, Band, CounterOutcome, Requirement, WrongTexel};
use etalon_record::{ComparedPair, Denial, FailedRoundTrip, Fresh, ProcessEnd, Reason, Record};

/// Returns why a record has its verdict: the end of its process and its reasons; empty if there is nothing to say.
pub fn message(record: &Record) -> String {
    told(record.process.as_ref(), &record.reasons)
}

/// Returns reasons in words.
pub fn reasons_text(reasons: &[Reason]) -> String {
    told(None, reasons)
}

fn told(end: Option<&ProcessEnd>, reasons: &[Reason]) -> String {
    // Before format 6, the text names the end of the process too.
    let told_by_text = reasons.iter().any(|r| matches!(r, Reason::Text(_)));
    let end = end.filter(|_| !told_by_text).map(ProcessEnd::to_string);
    let (mut circumstances, mut facts, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for reason in reasons {
        let list = match reason {
            Reason::Variant(_)
            | Reason::AfterOthers(_)
            | Reason::WhileTimed
            | Reason::AfterLastCase
            | Reason::WhenResumed => &mut circumstances,
            Reason::Flaky { .. } => &mut facts,
            _ => &mut others,
        };
        list.push(text(reason));
    }
    facts.extend(end);
    facts.append(&mut others);
    if !facts.is_empty() {
        circumstances.push(facts.join("; "));
    }
    circumstances.join(": ")
}

/// Returns a reason in words. One arm per reason.
fn text(reason: &Reason) -> String {
    match reason {
        Reason::Text(text) | Reason::Unfit(text) => text.clone(),
        Reason::Skipped(reason) => format!("not drawn: {reason}"),
        Reason::OutOfTime(seconds) => format!("not drawn within {seconds} s"),
        Reason::LongFrames(seconds) => {
            format!(
                "not timed: a smaller frame already takes {}",
                duration(*seconds)
            )
        }
        Reason::LargeFrames(size) => {
            format!(
                "not drawn: {} of attachments, texels and vertices, more than a worker may use",
                bytes(*size)
            )
        }
        Reason::Missing(requirement) => requirement.to_string(),
        Reason::NotRequired(api, version) => {
            format!("no requirement of {}", version_text(*api, *version))
        }
        Reason::Denied(denial) => denied(denial, &denial.needed.to_string()),
        Reason::BlockedByDenial(denial) => {
            // Tables group cases by these words, so they name no format.
            let needed = match denial.needed {
                Requirement::Samples(_, n) => format!("{n} samples per texel"),
                needed => needed.to_string(),
            };
            format!("not drawn: {}", denied(denial, &needed))
        }
        Reason::FailedRoundTrips(trips) => {
            let trips: Vec<String> = trips.iter().map(failed_round_trip).collect();
            format!("not drawn: {}", trips.join("; "))
        }
        Reason::UncheckedRoundTrip { format, reason } => {
            format!("the round trip of {format} was skipped and not checked ({reason})")
        }
        Reason::Counters(counters) => {
            let counters: Vec<String> = counters.iter().map(wrong_counter).collect();
            counters.join("; ")
        }
        Reason::LineGap {
            origin: [pass, draw, primitive],
            fragments: [least, most],
            citation,
        } => format!(
            "the line of primitive {primitive} of draw {draw} of pass {pass} has at most {most} fragments, at least {least} are legal: {citation}"
        ),
        Reason::Share { judged, total } => {
            let share = *judged as f64 / *total as f64 * 100.0;
            format!(
                "{share:.1} % of the picture is judged: {judged} of {total} samples, on a lattice"
            )
        }
        Reason::IllegalLiteral {
            value,
            channel,
            at: [x, y],
        } => format!(
            "the literal {value} of channel {channel} at ({x}, {y}) is outside the legal set"
        ),
        Reason::MissedLiteral([x, y]) => {
            format!("texel ({x}, {y}) is not the literal value of the case")
        }
        Reason::Difference {
            samples,
            pair,
            citation,
        } => {
            let pair = match pair {
                ComparedPair::Variant(name) => format!("the scene in variant {name}"),
                ComparedPair::Attachments(first, other) => {
                    format!("attachment {first} in attachment {other}")
                }
                ComparedPair::Operands => "samples with the same source and destination".to_owned(),
            };
            format!("{samples} samples differ from {pair}: {citation}")
        }
        Reason::NoFrame => "no frame came back".to_owned(),
        Reason::Validation {
            messages,
            otherwise,
            first,
        } => format!(
            "validation, {messages} messages (the picture would be {}): {first}",
            otherwise.name()
        ),
        Reason::Flaky { verdicts, fresh } => {
            let verdicts: Vec<&str> = verdicts.iter().map(|v| v.name()).collect();
            let fresh = match fresh {
                Fresh::Process => "in a fresh process",
                Fresh::Device => "on a fresh device",
            };
            format!("{}, each {fresh}", verdicts.join(", then "))
        }
        Reason::ChangedPicture(citation) => {
            format!("the picture after a round is not the one that was judged: {citation}")
        }
        Reason::NoAnswer(seconds) => format!("the device did not answer within {seconds} s"),
        Reason::Process(end) => end.to_string(),
        Reason::FirstWrong {
            samples,
            at: [x, y],
        } => format!("{samples} samples, the first at ({x}, {y})"),
        Reason::Expired { day, reason } => format!("the expectation expired on {day}: {reason}"),
        Reason::OtherSymptom(reason) => format!("not the expected symptom: {reason}"),
        Reason::PartsDisagree(first, other) => {
            format!("{} in one part, {} in another", first.name(), other.name())
        }
        Reason::Variant(name) => format!("variant {name}"),
        Reason::AfterOthers(1) => "only after another case in the same process".to_owned(),
        Reason::AfterOthers(n) => format!("only after {n} other cases in the same process"),
        Reason::WhileTimed => "while its frames were timed".to_owned(),
        Reason::AfterLastCase => "after its last case".to_owned(),
        Reason::WhenResumed => "when the bench was resumed".to_owned(),
    }
}

fn denied(denial: &Denial, needed: &str) -> String {
    let version = version_text(denial.api, denial.version);
    format!(
        "the adapter denies {needed}, which {version} requires ({})",
        denial.citation
    )
}

/// Returns the API, with its version if it has one.
fn version_text(api: Api, version: ApiVersion) -> String {
    match version {
        ApiVersion::UNKNOWN => api.to_string(),
        version => format!("{api} {version}"),
    }
}

/// Describes a failed round trip in a few words: `capabilities/round-trip/format=r8uint is fail: texel 3,0 of
/// color: channel 0 holds 4, expected 3`.
fn failed_round_trip(trip: &FailedRoundTrip) -> String {
    let failed = format!("{} is {}", trip.case, trip.verdict.name());
    let first = trip
        .wrong
        .as_ref()
        .and_then(|w| Some((w, w.channels.first()?)));
    match first {
        Some((WrongTexel { x, y, .. }, c)) => {
            let expected = if c.low == c.high {
                c.low.to_string()
            } else {
                format!("{} to {}", c.low, c.high)
            };
            format!(
                "{failed}: texel {x},{y} of {}: channel {} holds {}, expected {expected}",
                c.attachment, c.channel, c.actual
            )
        }
        None => match reasons_text(&trip.why).as_str() {
            "" => failed,
            why => format!("{failed}: {why}"),
        },
    }
}

fn wrong_counter(counter: &CounterOutcome) -> String {
    let legal = counter.range();
    let expected = match counter.band {
        Some(Band::Fail) => format!("{legal} is legal"),
        Some(Band::RequiredByCts) => {
            format!("the text leaves it open, but the Khronos CTS requires {legal}")
        }
        Some(Band::Disputed) => format!("a disputed reading of the text requires {legal}"),
        _ => format!("{legal} is legal, but the yardstick wants another"),
    };
    format!(
        "counter {} ({}) is {}, {expected}",
        counter.name,
        counter.kind.name(),
        counter.actual
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_record::Verdict;

    #[test]
    fn circumstances_come_first_and_the_end_of_the_process_before_other_facts() {
        let mut record = Record::new("a/b", "cpu", Verdict::Crash);
        record.process = Some(ProcessEnd {
            signal: Some(6),
            stderr: "a planted abort".to_owned(),
            ..ProcessEnd::default()
        });
        let died = "the worker died of signal 6 (SIGABRT); stderr ends with: a planted abort";
        assert_eq!(message(&record), died);
        record.reasons = vec![
            Reason::AfterOthers(1),
            Reason::OtherSymptom("bug 12".to_owned()),
        ];
        let text = format!(
            "only after another case in the same process: {died}; not the expected symptom: bug 12"
        );
        assert_eq!(message(&record), text);
        record.reasons = vec![Reason::Flaky {
            verdicts: vec![Verdict::Pass, Verdict::Crash],
            fresh: Fresh::Process,
        }];
        let text = format!("pass, then crash, each in a fresh process; {died}");
        assert_eq!(message(&record), text);
        // As formats before 6 have it.
        record.reasons = vec![Reason::Text(
            "the worker died of signal 6 (abort)".to_owned(),
        )];
        assert_eq!(message(&record), "the worker died of signal 6 (abort)");
        record.reasons = vec![Reason::WhileTimed];
        record.process = None;
        assert_eq!(message(&record), "while its frames were timed");
    }
}
