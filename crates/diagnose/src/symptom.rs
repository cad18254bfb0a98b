//! Symptoms: the way in which a case failed, and what records of one bug have in common before anybody knows the bug.
//!
//! A symptom is made from the record alone and names no texel and no value. A picture's names the attachment and the
//! aspect of the first wrong sample, and the operations that decide what the sample must hold: the last one that
//! stores there or clears, and those that keep later draws away; where the driver left what was there before, it is
//! the store, whatever it had to compute. A smaller case has fewer draws, so that its operations are some of the larger
//! one's; one that is new is another symptom. [`Symptom::broad`] leaves out what differs among the cases of one
//! bug: the runner rechecks so many records of each, reports group by it.

use etalon_frame::{Aspect, Band, ChannelMismatch, CounterKind, Story, StoryLine};
use etalon_record::{LossKind, ProcessEnd, Record, Verdict};
use std::fmt;

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

/// Operations that end a draw at a sample. Coverage stands apart: every draw has primitives elsewhere.
const REJECTIONS: [&str; 14] = [
    "rasterizer discard",
    "viewport",
    "clipping",
    "culling",
    "scissor",
    "sample coverage",
    "sample mask",
    "discard",
    "shader's sample mask",
    "alpha to coverage",
    "depth bounds",
    "stencil test",
    "depth test",
    "early tests",
];

/// Operations that compute what is stored.
const COMPUTED: [&str; 3] = ["logic operation", "advanced blend", "blend"];

/// Operations that give an attachment what it holds before all draws, or without one.
const INITIAL: [&str; 3] = ["clear", "upload", "resolve"];

/// The way in which a case failed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symptom {
    /// The verdict.
    pub verdict: Verdict,
    /// The part of the outcome that is wrong.
    pub subject: Subject,
    /// Of a picture, the name of the attachment.
    pub attachment: Option<String>,
    /// Of a picture, the operations that decide what the first wrong sample must hold, in their order.
    pub operations: Vec<String>,
    /// The last operation of the story that not every sample passes; empty where there is none.
    pub last: String,
    /// Of a value, the side on which it lies.
    pub direction: Option<Direction>,
}

/// The part of an outcome that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Subject {
    /// A picture.
    Picture(Aspect),
    /// A counter.
    Counter(CounterKind),
    /// Pictures that must be the same are not: the name of the invariance.
    Relation(String),
    /// The process that drew was lost.
    Process {
        /// The way in which it was lost.
        kind: LossKind,
        /// The signal that ended it.
        signal: Option<i32>,
        /// Its exit status.
        exit: Option<i32>,
    },
    /// The backend failed: its error without numbers, which are addresses, sizes and times.
    Error(String),
    /// Nothing but the verdict is known.
    Unknown,
}

/// The side of what is allowed on which a value lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// All wrong values are too high.
    High,
    /// All are too low.
    Low,
    /// Some are too high, and some too low.
    Both,
}

impl Symptom {
    /// Returns the symptom of a record.
    pub fn of(record: &Record) -> Self {
        let story = record.story.as_ref();
        let lines = story.map_or(&[][..], |story| story.operations());
        let telling = |line: &&StoryLine| !COMMON.contains(&line.operation.as_str());
        let last = lines.iter().rev().find(telling);
        let bare = Self {
            verdict: record.verdict,
            subject: Subject::Unknown,
            attachment: None,
            operations: Vec::new(),
            last: last.map_or_else(String::new, |line| line.operation.clone()),
            direction: None,
        };
        if let Some(ProcessEnd {
            kind, signal, exit, ..
        }) = record.process
        {
            let subject = Subject::Process { kind, signal, exit };
            return Self { subject, ..bare };
        }
        if let Some(invariance) = invariance(lines) {
            let subject = Subject::Relation(invariance);
            return Self { subject, ..bare };
        }
        let wrong = record.wrong.first().filter(|w| w.band > Band::Imprecise);
        if let Some(channel) = wrong.and_then(|w| w.channels.first()) {
            let operations = story.map(|s| deciding(s, &channel.attachment, channel.aspect));
            return Self {
                subject: Subject::Picture(channel.aspect),
                attachment: Some(channel.attachment.clone()),
                operations: operations.unwrap_or_default(),
                direction: Some(direction(record, channel.aspect)),
                ..bare
            };
        }
        let counters = record.counters.iter().filter(|c| c.band.is_some());
        if let Some(counter) = counters.max_by_key(|c| c.band) {
            return Self {
                subject: Subject::Counter(counter.kind),
                direction: Some(match counter.actual < counter.low {
                    true => Direction::Low,
                    false => Direction::High,
                }),
                ..bare
            };
        }
        let failed = matches!(
            record.verdict,
            Verdict::DeviceLost | Verdict::ResourceError | Verdict::InternalError
        );
        let words = record.message.chars().filter(|c| !c.is_ascii_digit());
        let subject = match failed {
            true => Subject::Error(words.collect()),
            false => Subject::Unknown,
        };
        Self { subject, ..bare }
    }

    /// True if a smaller case that fails like `other` fails like this one.
    pub fn covers(&self, other: &Self) -> bool {
        self.attachment == other.attachment && self.covers_elsewhere(other)
    }

    /// The same, whatever the attachments are called.
    pub fn covers_elsewhere(&self, other: &Self) -> bool {
        let same = self.verdict == other.verdict && self.subject == other.subject;
        let counter = matches!(self.subject, Subject::Counter(_));
        same && (!counter || self.direction == other.direction)
            && other.operations.iter().all(|o| self.operations.contains(o))
            && other.operations.is_empty() == self.operations.is_empty()
    }

    /// Returns the symptom that all cases of one bug have, in most of its cases: that of a picture in any attachment,
    /// of an error in any words.
    pub fn broad(self) -> Self {
        let subject = match self.subject {
            Subject::Error(_) => Subject::Unknown,
            subject => subject,
        };
        Self {
            subject,
            attachment: None,
            operations: Vec::new(),
            ..self
        }
    }

    /// Returns the operations that decide, without those that give an attachment what it holds before all draws,
    /// unless there are no others.
    pub fn of_draws(&self) -> Vec<&str> {
        let all = || self.operations.iter().map(String::as_str);
        let drawn: Vec<&str> = all().filter(|o| !INITIAL.contains(o)).collect();
        match drawn.is_empty() {
            true => all().collect(),
            false => drawn,
        }
    }

    /// Returns the symptom in a few words: `color too high after blend`; nothing where only the verdict is known.
    pub fn text(&self) -> String {
        let mut words = match &self.subject {
            Subject::Picture(aspect) => vec![aspect.name().to_owned()],
            Subject::Error(words) => vec![words.clone()],
            Subject::Unknown => Vec::new(),
            other => vec![other.to_string()],
        };
        words.extend(self.direction.map(|d| d.words().to_owned()));
        if !self.last.is_empty() {
            words.extend(["after".to_owned(), self.last.clone()]);
        }
        words.join(" ")
    }
}

/// The subject and what decides: `color of target (blend, store color)`.
impl fmt::Display for Symptom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.subject, self.direction) {
            (Subject::Picture(aspect), _) => {
                let attachment = self.attachment.as_deref().unwrap_or_default();
                let operations = self.operations.join(", ");
                write!(f, "{} of {attachment} ({operations})", aspect.name())
            }
            (Subject::Counter(_), Some(direction)) => {
                let much = match direction {
                    Direction::Low => "little",
                    Direction::High | Direction::Both => "much",
                };
                write!(f, "{} counts too {much}", self.subject)
            }
            (Subject::Unknown, _) => f.write_str(self.verdict.name()),
            (subject, _) => subject.fmt(f),
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Picture(aspect) => f.write_str(aspect.name()),
            Self::Counter(kind) => write!(f, "counter {}", kind.name()),
            Self::Relation(name) if name.is_empty() => f.write_str("relation"),
            Self::Relation(name) => write!(f, "relation {name}"),
            Self::Process { kind, signal, exit } => {
                f.write_str(match kind {
                    LossKind::Died => "process died",
                    LossKind::Timeout => "no answer",
                    LossKind::Memory => "too much memory",
                    LossKind::Garbage => "invalid message",
                    LossKind::NotStarted => "process not started",
                })?;
                match (signal, exit) {
                    (Some(signal), _) => write!(f, " by signal {signal}"),
                    (None, Some(exit)) => write!(f, " with exit status {exit}"),
                    (None, None) => Ok(()),
                }
            }
            Self::Error(words) => f.write_str(words),
            Self::Unknown => f.write_str("unknown"),
        }
    }
}

impl Direction {
    fn words(self) -> &'static str {
        match self {
            Self::High => "too high",
            Self::Low => "too low",
            Self::Both => "differs",
        }
    }
}

/// Returns the name of the invariance of a story about two pictures that must be the same; no name where it was
/// told by an earlier version.
fn invariance(lines: &[StoryLine]) -> Option<String> {
    let of = |operation| lines.iter().find(|l| l.operation == operation);
    let named = of("relation").map(|line| line.detail.clone());
    named.or_else(|| of("alone").map(|_| String::new()))
}

/// Returns the side on which the wrong values of an aspect lie.
fn direction(record: &Record, aspect: Aspect) -> Direction {
    let all = record.wrong.iter().flat_map(|texel| &texel.channels);
    let of_aspect = || all.clone().filter(|m| m.aspect == aspect);
    let order = |m: &ChannelMismatch, code| m.encoding.order_of_code(code);
    let high = of_aspect().any(|m| order(m, m.actual) > order(m, m.high));
    let low = of_aspect().any(|m| order(m, m.actual) < order(m, m.low));
    match (high, low) {
        (true, false) => Direction::High,
        (false, true) => Direction::Low,
        _ => Direction::Both,
    }
}

/// Returns the operations that decide what an aspect of an attachment holds at the sample of a story.
fn deciding(story: &Story, attachment: &str, aspect: Aspect) -> Vec<String> {
    let [stores, keeps] = ["store", "keep"].map(|word| format!("{word} {}", aspect.name()));
    let mut deciding: Vec<String> = Vec::new();
    let add = |deciding: &mut Vec<String>, operation: &str| {
        if !deciding.iter().any(|o| o == operation) {
            deciding.push(operation.to_owned());
        }
    };
    let mut drawn = false;
    let lines = story.operations();
    for group in lines.chunk_by(|a, b| a.at == b.at) {
        let place = group[0].at.as_str();
        if !is_draw(place) {
            // Clears, resolves and uploads, of which stories tell those of all attachments.
            let other = place.strip_prefix("attachment ");
            if other.is_some_and(|name| name != attachment) {
                continue;
            }
            let initial = |line: &&StoryLine| INITIAL.contains(&line.operation.as_str());
            for line in group.iter().filter(initial) {
                if other.is_some() || names(&line.detail, attachment) {
                    deciding = vec![line.operation.clone()];
                    drawn = false;
                } else if line.detail.contains("outside its rectangle") {
                    add(&mut deciding, &line.operation);
                }
            }
            continue;
        }
        // Several attachments are stored one after the other, each behind what computes it.
        let of = |line: &StoryLine, operation: &str| {
            let own = aspect != Aspect::Color || names(&line.detail, attachment);
            line.operation == operation && own
        };
        let stored = group.iter().position(|line| of(line, &stores));
        drawn = true;
        if let Some(at) = stored {
            deciding.clear();
            let ends = |l: &&StoryLine| l.operation == stores || l.operation == keeps;
            let before = group[..at].iter().rev().take_while(|l| !ends(l));
            if aspect == Aspect::Color
                && let Some(line) = before.clone().find(is_computed)
            {
                add(&mut deciding, &line.operation);
            }
            add(&mut deciding, &stores);
        } else if group.iter().any(|line| of(line, &keeps)) {
            add(&mut deciding, &keeps);
        } else if let Some(line) = rejection(group) {
            add(&mut deciding, &line.operation);
        }
    }
    // Where the driver left what was there, nothing was computed that could be wrong.
    let kept = story.verdict();
    if kept.is_some_and(|v| v.detail.contains("the driver kept ")) {
        deciding.retain(|o| !COMPUTED.contains(&o.as_str()));
    }
    // Every draw has primitives elsewhere: coverage decides where nothing else does.
    if drawn && deciding.iter().all(|o| INITIAL.contains(&o.as_str())) {
        add(&mut deciding, "coverage");
    }
    deciding
}

/// True if a line says what an attachment holds: `target holds 1, 0, 0, 1`, `write mask 0x0: target still holds 0`,
/// `samples into target, average`.
fn names(detail: &str, attachment: &str) -> bool {
    let stored = detail.strip_prefix(attachment);
    stored.is_some_and(|rest| rest.starts_with(" holds "))
        || detail.contains(&format!(": {attachment} still holds "))
        || detail.contains(&format!(" into {attachment}, "))
}

fn is_computed(line: &&StoryLine) -> bool {
    COMPUTED.contains(&line.operation.as_str())
}

/// True if a place is a draw: `pass 0, draw 2, primitive 1`, in a frame that may be named before.
fn is_draw(at: &str) -> bool {
    let number = |word: &str| {
        let rest = at.split_once(word).map(|(_, rest)| rest);
        rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    number("pass ") && number(", draw ")
}

/// Returns the last operation of a group of lines that ends the draw. Tests that pass are told too.
fn rejection(group: &[StoryLine]) -> Option<&StoryLine> {
    let passes = |line: &StoryLine| match line.operation.as_str() {
        "stencil test" => line.detail.contains(" passes"),
        "depth test" => line.detail.ends_with(" is true"),
        _ => false,
    };
    let mut lines = group.iter().rev();
    lines.find(|line| REJECTIONS.contains(&line.operation.as_str()) && !passes(line))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{ChannelEncoding, CounterOutcome, WrongTexel};

    fn line(at: &str, operation: &str, detail: &str) -> StoryLine {
        StoryLine {
            at: at.to_owned(),
            operation: operation.to_owned(),
            detail: detail.to_owned(),
            citation: None,
        }
    }

    fn record(actual: u32, lines: Vec<StoryLine>) -> Record {
        let mut record = Record::new("a/b", "cpu", Verdict::Fail);
        record.story = Some(Story { lines });
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

    /// The symptom of a record whose story has these operations.
    fn seen(actual: u32, operations: &[&str]) -> Symptom {
        let lines = operations.iter().map(|o| line("pass 0", o, "")).collect();
        Symptom::of(&record(actual, lines))
    }

    #[test]
    fn records_of_one_bug_have_one_broad_symptom() {
        let of = |actual, operations: &[&str]| seen(actual, operations).broad();
        let high = of(30, &["shade", "blend", "store color", "read back"]);
        assert_eq!(high.text(), "color too high after blend");
        assert_eq!(high, of(200, &["blend", "coverage"]));
        assert_ne!(high, of(3, &["blend"]));
        assert_ne!(high, of(30, &["depth test"]));
        assert_eq!(of(3, &[]).text(), "color too low");
    }

    #[test]
    fn processes_and_errors_are_told_without_their_numbers() {
        let mut crash = Record::new("a/b", "cpu", Verdict::Crash);
        assert_eq!(Symptom::of(&crash).text(), "");
        crash.process = Some(ProcessEnd {
            kind: LossKind::Died,
            signal: Some(6),
            exit: None,
            stderr: "at 0x7ffe".to_owned(),
            seconds: 1.0,
        });
        let died = Symptom::of(&crash);
        assert_eq!(died.text(), "process died by signal 6");
        if let Some(end) = &mut crash.process {
            end.stderr.clear();
            assert!(died.covers(&Symptom::of(&crash)));
        }
        crash.process.as_mut().unwrap().signal = Some(11);
        assert!(!died.covers(&Symptom::of(&crash)));

        let error = |message: &str| {
            let mut record = Record::new("a/b", "cpu", Verdict::InternalError);
            record.message = message.to_owned();
            Symptom::of(&record)
        };
        assert!(error("slot 3 is free").covers(&error("slot 12 is free")));
        assert!(!error("slot 3 is free").covers(&error("slot 3 is taken")));
        assert_eq!(error("a").broad(), error("b").broad());
    }

    /// The operations that decide a colour of the attachment `c`.
    fn found(lines: &[(&str, &str, &str)]) -> Vec<String> {
        let lines = lines.iter().map(|(at, o, detail)| line(at, o, detail));
        let story = Story {
            lines: lines.collect(),
        };
        deciding(&story, "c", Aspect::Color)
    }

    #[test]
    fn the_last_store_and_later_rejections_decide() {
        let clear = ("attachment c", "clear", "");
        let draw = "pass 0, draw 0, primitive 0";
        let logic = (draw, "logic operation", "xor onto 0");
        let store = (draw, "store color", "c holds 1");
        let upload = ("attachment d", "upload", "");
        let scissor = ("pass 0, draw 1", "scissor", "");
        let coverage = ("pass 0, draw 2", "coverage", "");
        assert_eq!(found(&[clear]), ["clear"]);
        let worked = ["logic operation", "store color"];
        assert_eq!(found(&[clear, logic, store]), worked);
        assert_eq!(found(&[clear, scissor, logic, store]), worked);
        assert_eq!(
            found(&[clear, logic, store, scissor, coverage]),
            ["logic operation", "store color", "scissor"]
        );
        assert_eq!(found(&[clear, upload, scissor]), ["clear", "scissor"]);
        assert_eq!(found(&[clear, coverage]), ["clear", "coverage"]);
        let before = ("pass 0, before draw 1", "clear", "c holds color 1");
        assert_eq!(found(&[clear, logic, store, before]), ["clear"]);
        let resolve = |detail| ("after pass 0", "resolve", detail);
        let own = resolve("d into c, sample 0");
        assert_eq!(found(&[store, own]), ["resolve"]);
        assert_eq!(
            found(&[store, resolve("c into d, sample 0")]),
            ["store color"]
        );
        let beside = (
            "pass 0, at the end",
            "clear",
            "the texel lies outside its rectangle",
        );
        assert_eq!(found(&[store, beside]), ["store color", "clear"]);
        let plain = ("pass 0, draw 2, primitive 1", "store color", "c holds 1");
        assert_eq!(found(&[clear, logic, store, plain]), ["store color"]);
    }

    #[test]
    fn what_computes_one_attachment_is_not_told_of_another() {
        let draw = "in variant twice: pass 0, draw 0, primitive 0";
        let blended = [
            (draw, "blend", ""),
            (draw, "store color", "d holds 1"),
            (draw, "store color", "c holds 1"),
        ];
        assert_eq!(found(&blended), ["store color"]);
        let kept = [
            (draw, "store color", "d holds 1"),
            (draw, "keep color", "write mask 0x0: c still holds 1"),
        ];
        assert_eq!(found(&kept), ["keep color"]);
    }

    #[test]
    fn a_draw_that_does_not_arrive_is_the_same_however_it_blends() {
        let of = |detail: &str, last: (&str, &str)| {
            let [at, by] = ["texel 0,0", "judged"].map(str::to_owned);
            let draw = "pass 0, draw 0, primitive 0";
            let lines = vec![
                StoryLine::verdict(at, detail.to_owned(), by),
                line("attachment c", "clear", ""),
                line(draw, "logic operation", "xor onto 0"),
                line(draw, last.0, last.1),
            ];
            deciding(&Story { lines }, "c", Aspect::Color)
        };
        let kept = "must be 1; the driver kept the clear colour 0";
        let store = ("store color", "c holds 1");
        assert_eq!(of(kept, store), ["store color"]);
        assert_eq!(of(kept, ("scissor", "")), ["clear", "scissor"]);
        assert_eq!(
            of("must be 1; the driver wrote 0", store),
            ["logic operation", "store color"]
        );
    }

    #[test]
    fn a_test_that_passes_rejects_nothing() {
        let mut lines = vec![
            line(
                "pass 0, draw 1",
                "depth test",
                "0 greater stored 1 is false",
            ),
            line(
                "pass 0, draw 1",
                "stencil test",
                "reference 0 always stored 0 passes, depth fails",
            ),
        ];
        let ends = rejection(&lines).map(|l| l.operation.as_str());
        assert_eq!(ends, Some("depth test"));
        lines[0].detail = "1 greater stored 0 is true".to_owned();
        assert_eq!(rejection(&lines), None);
    }

    #[test]
    fn a_smaller_case_has_no_new_operation() {
        let symptom = |operations: &[&str], attachment: &str, verdict| Symptom {
            verdict,
            subject: Subject::Picture(Aspect::Color),
            attachment: Some(attachment.to_owned()),
            operations: operations.iter().map(|o| (*o).to_owned()).collect(),
            last: operations.concat(),
            direction: Some(match operations.len() {
                1 => Direction::High,
                _ => Direction::Low,
            }),
        };
        let fail = |operations: &[&str]| symptom(operations, "c", Verdict::Fail);
        let whole = fail(&["blend", "scissor"]);
        assert!(whole.covers(&whole));
        assert!(whole.covers(&fail(&["blend"])));
        assert!(!whole.covers(&fail(&["store color"])));
        assert!(!whole.covers(&fail(&["blend", "store color"])));
        assert!(!whole.covers(&fail(&[])));
        assert!(!fail(&["blend"]).covers(&whole));
        assert!(!whole.covers(&symptom(&["blend"], "d", Verdict::Fail)));
        assert!(!whole.covers(&symptom(&["blend"], "c", Verdict::Disputed)));
        let counter = |actual| {
            let mut record = Record::new("a/b", "cpu", Verdict::Fail);
            record.counters = vec![CounterOutcome {
                name: "runs".to_owned(),
                kind: CounterKind::ShaderRuns,
                low: 4,
                high: Some(8),
                actual,
                band: Some(Band::Fail),
            }];
            Symptom::of(&record)
        };
        let [low, high] = [counter(3), counter(9)];
        assert!(low.covers(&counter(2)) && !low.covers(&high) && !whole.covers(&low));
        assert_eq!(high.to_string(), "counter shader-runs counts too much");
    }

    #[test]
    fn a_relation_is_one_whatever_its_pictures_hold() {
        let scene = "in the scene: pass 0, draw 0, primitive 0";
        let told = |invariance: Option<&str>| {
            let mut lines = vec![line("in the scene", "alone", "texel 0,0 may be 1")];
            lines.extend(invariance.map(|name| line("in the scene", "relation", name)));
            lines.push(line(scene, "store color", "c holds 1"));
            Symptom::of(&record(3, lines)).to_string()
        };
        assert_eq!(told(Some("repeat")), "relation repeat");
        assert_eq!(told(None), "relation");
    }
}
