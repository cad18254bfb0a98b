//! Records in one sentence.

use super::plain::plain;
use super::reason::message;
use super::story::sentence;
use super::texel::{multisampled, texel_line};
use super::verdict::{Tone, meaning, name};
use crate::numbers::duration;
use etalon_record::{ProcessEnd, Record};

/// Returns the loss of a process in one sentence.
pub(crate) fn process_end(end: &ProcessEnd) -> String {
    let cause = end.cause();
    let capital = cause
        .chars()
        .next()
        .into_iter()
        .flat_map(char::to_uppercase);
    let rest = cause.chars().skip(1);
    let cause: String = capital.chain(rest).collect();
    format!("{cause}, after {}.", duration(end.seconds))
}

/// Returns the most informative line about a record, which names what its verdict is about: the ruling of its story,
/// its first wrong texel, or the last line of its message, which names wrong counters and the cause of a crash.
pub(crate) fn headline(record: &Record) -> String {
    let message = message(record);
    let last = message.lines().rev().find(|l| !l.trim().is_empty());
    let text = match (record.wrong.first(), last) {
        _ if Tone::of(record) == Tone::Missed => {
            format!("{}, but the selftest is due to fail", name(record.verdict))
        }
        (_, Some(line)) if record.is_decided_by_counter() => line.trim().to_owned(),
        (Some(texel), _) if record.verdict.is_judged() => {
            let sentence = record.story.as_ref().and_then(sentence);
            sentence.unwrap_or_else(|| texel_line(texel, multisampled(record)))
        }
        (_, Some(line)) => line.trim().to_owned(),
        (Some(texel), None) => texel_line(texel, multisampled(record)),
        (None, None) => meaning(record.verdict).to_owned(),
    };
    plain(&text, 300)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{Band, CounterKind, CounterOutcome, WrongTexel};
    use etalon_record::{Reason, Verdict};

    #[test]
    fn a_proven_counter_is_named_before_a_texel_that_only_the_cts_forbids() {
        let mut record = Record::new("a/b", "gl:x", Verdict::Fail);
        record.wrong = vec![WrongTexel {
            x: 1,
            y: 2,
            sample: 0,
            band: Band::RequiredByCts,
            channels: Vec::new(),
        }];
        let counter = CounterOutcome {
            name: "passed".to_owned(),
            kind: CounterKind::SamplesPassed,
            low: 16,
            high: Some(16),
            actual: 64,
            band: Some(Band::Fail),
        };
        record.counters = vec![counter.clone()];
        record.reasons = vec![Reason::Counters(vec![counter])];
        let text = "counter passed (samples-passed) is 64, 16 is legal";
        assert_eq!(headline(&record), text);
        record.wrong[0].band = Band::Fail;
        assert_ne!(headline(&record), text);
    }

    #[test]
    fn a_lost_process_is_described_in_one_sentence() {
        let mut end = ProcessEnd {
            signal: Some(6),
            seconds: 0.25,
            ..ProcessEnd::default()
        };
        let text = "The worker died of signal 6 (SIGABRT), after 250.0 ms.";
        assert_eq!(process_end(&end), text);
        end.seconds = 1e300;
        assert!(process_end(&end).len() < 120);
    }
}
