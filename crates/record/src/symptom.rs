//! The kind of a bad record: what records of one bug have in common before anybody knows the bug.
//!
//! It is made from the record alone and names no texel and no value, so that records of a thousand cases have a few
//! kinds. The runner rechecks so many records of a kind, reports group by it.

use crate::record::{LossKind, Record};
use crate::verdict::Verdict;
use etalon_frame::{Aspect, ChannelMismatch};

/// Operations that every sample passes, and so tell nothing.
const COMMON: [&str; 7] = [
    "read back",
    "coverage",
    "viewport",
    "shade",
    "store color",
    "store depth",
    "store stencil",
];

/// The kind of a bad record.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symptom {
    /// The verdict.
    pub verdict: Verdict,
    /// What is wrong: `color`, `depth`, `stencil`, `counter`, or the end of a process.
    pub subject: String,
    /// The last operation of the story that not every sample passes; empty where there is none.
    pub operation: String,
    /// `too high`, `too low` or `differs`; empty where there is no value.
    pub direction: String,
}

impl Symptom {
    /// Returns the kind of a record.
    pub fn of(record: &Record) -> Self {
        let story = record.story.as_ref();
        let operations = story.map_or(&[][..], |story| story.operations());
        let operation = operations
            .iter()
            .rev()
            .find(|line| !COMMON.contains(&line.operation.as_str()));
        let wrong = record
            .wrong
            .first()
            .and_then(|texel| texel.channels.first());
        let (subject, direction) = match (wrong, &record.process) {
            (_, Some(end)) => (process(end.kind, end.signal), ""),
            (Some(_), None) => value(record),
            (None, None) if record.counters.iter().any(|c| c.band.is_some()) => {
                let wrong = record.counters.iter().find(|c| c.band.is_some());
                let low = wrong.is_some_and(|c| c.actual < c.low);
                (
                    "counter".to_owned(),
                    if low { "too low" } else { "too high" },
                )
            }
            (None, None) => (String::new(), ""),
        };
        Self {
            verdict: record.verdict,
            subject,
            operation: operation.map_or_else(String::new, |line| line.operation.clone()),
            direction: direction.to_owned(),
        }
    }

    /// Returns the kind in words: `color too high after blend`.
    pub fn text(&self) -> String {
        let mut words: Vec<&str> = Vec::new();
        words.extend(
            [&*self.subject, &*self.direction]
                .iter()
                .filter(|w| !w.is_empty()),
        );
        if !self.operation.is_empty() {
            words.extend(["after", &self.operation]);
        }
        words.join(" ")
    }
}

fn process(kind: LossKind, signal: Option<i32>) -> String {
    let what = match kind {
        LossKind::Died => "process died",
        LossKind::Timeout => "no answer",
        LossKind::Memory => "too much memory",
        LossKind::Garbage => "invalid message",
        LossKind::NotStarted => "process not started",
    };
    signal.map_or_else(|| what.to_owned(), |n| format!("{what} by signal {n}"))
}

/// The aspect of the wrong texels and their common direction.
fn value(record: &Record) -> (String, &'static str) {
    let all = || record.wrong.iter().flat_map(|texel| &texel.channels);
    let aspect = all().next().map_or(Aspect::Color, |m| m.aspect);
    let order = |m: &ChannelMismatch, code| m.encoding.order_of_code(code);
    let of_aspect = || all().filter(|m| m.aspect == aspect);
    let high = of_aspect().any(|m| order(m, m.actual) > order(m, m.high));
    let low = of_aspect().any(|m| order(m, m.actual) < order(m, m.low));
    let direction = match (high, low) {
        (true, false) => "too high",
        (false, true) => "too low",
        _ => "differs",
    };
    (aspect.name().to_owned(), direction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{Band, ChannelEncoding, Story, StoryLine, WrongTexel};

    fn record(actual: u32, operations: &[&str]) -> Record {
        let mut record = Record::new("a/b", "cpu", Verdict::Fail);
        let line = |operation: &&str| StoryLine {
            at: "pass 0".to_owned(),
            operation: (*operation).to_owned(),
            detail: String::new(),
            citation: None,
        };
        record.story = Some(Story {
            lines: operations.iter().map(line).collect(),
        });
        record.wrong = vec![WrongTexel {
            x: actual,
            y: 0,
            sample: 0,
            band: Band::Fail,
            channels: vec![ChannelMismatch {
                attachment: "c".to_owned(),
                aspect: Aspect::Color,
                channel: 0,
                encoding: ChannelEncoding::Unorm(8),
                low: 10,
                high: 20,
                actual,
            }],
        }];
        record
    }

    #[test]
    fn records_of_one_bug_are_of_one_kind() {
        let high = Symptom::of(&record(30, &["shade", "blend", "store color", "read back"]));
        assert_eq!(high.text(), "color too high after blend");
        assert_eq!(high, Symptom::of(&record(200, &["blend", "coverage"])));
        assert_ne!(high, Symptom::of(&record(3, &["blend"])));
        assert_ne!(high, Symptom::of(&record(30, &["depth test"])));
        assert_eq!(Symptom::of(&record(3, &[])).text(), "color too low");
        let crash = Record::new("a/b", "cpu", Verdict::Crash);
        assert_eq!(Symptom::of(&crash).text(), "");
    }
}
