//! Symptoms: how a case failed, and what records of one bug have in common before the bug is known.
//!
//! A symptom is derived from the record alone, and names no texel and no value. For a picture, it names the
//! attachment and aspect of the first wrong sample, and the operations that decide the sample's value: the
//! last operation that stores or clears, and operations that reject later draws. If the driver kept the
//! earlier contents, the store decides, whatever was computed for it. A smaller case has fewer draws, so
//! its operations are a subset of the larger case's; a new operation is another symptom. [`Symptom::broad`]
//! leaves out what differs among the cases of one bug: the runner rechecks a limited number of records with
//! the same broad symptom, and reports group by it.

use etalon_frame::{
    Aspect, Band, ChannelMismatch, CounterKind, Effect, ErrorKind, Event, Operation, Rejection,
    Step, Story, Target, WrongTexel,
};
use etalon_record::{LossKind, ProcessEnd, Record, Verdict};
use std::fmt;

/// Operations that every sample goes through, which therefore distinguish no failure.
const COMMON: [Operation; 8] = [
    Operation::ReadBack,
    Operation::Coverage,
    Operation::Viewport,
    Operation::Shade,
    Operation::StoreColor,
    Operation::StoreDepth,
    Operation::StoreStencil,
    Operation::World,
];

/// Operations that compute the stored value.
const COMPUTED: [Operation; 3] = [
    Operation::LogicOperation,
    Operation::AdvancedBlend,
    Operation::Blend,
];

/// Operations that convert a value to the codes of an attachment.
const CONVERTING: [Operation; 4] = [
    Operation::Clear,
    Operation::ReadBack,
    Operation::StoreColor,
    Operation::StoreDepth,
];

/// The most codes by which a wrong conversion misses the allowed values.
const ROUNDED: i64 = 2;

/// Operations that give an attachment its contents before the first draw or between draws.
const INITIAL: [Operation; 3] = [Operation::Clear, Operation::Upload, Operation::Resolve];

/// The way in which a case failed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symptom {
    /// The verdict.
    pub verdict: Verdict,
    /// The part of the result that is wrong.
    pub subject: WrongPart,
    /// For a picture, the name of the attachment.
    pub attachment: Option<String>,
    /// For a picture, the operations that decide the first wrong sample's value, in their order.
    pub operations: Vec<Operation>,
    /// The last operation of the story that not every sample goes through.
    pub last: Option<Operation>,
    /// For a value, whether it is too high or too low.
    pub direction: Option<Direction>,
}

/// The part of a result that is wrong.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WrongPart {
    /// A picture.
    Picture(Aspect),
    /// A counter.
    Counter(CounterKind),
    /// Pictures that must be equal differ; the name of the invariance.
    Relation(String),
    /// The process that drew the case was lost.
    Process {
        /// The way in which the process was lost.
        kind: LossKind,
        /// The signal that ended the process.
        signal: Option<i32>,
        /// The process's exit status.
        exit: Option<i32>,
    },
    /// The backend failed.
    Error(ErrorKind),
    /// Only the verdict is known.
    Unknown,
}

/// The side of the legal values on which a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// All wrong values are too high.
    High,
    /// All wrong values are too low.
    Low,
    /// Some wrong values are too high, and some too low.
    Both,
}

impl Symptom {
    /// Returns the symptom of a record.
    pub fn of(record: &Record) -> Self {
        let story = record.story.as_ref();
        let events = story.map_or(&[][..], |story| &story.events[..]);
        let operations = events.iter().rev().map(Event::operation);
        let bare = Self {
            verdict: record.verdict,
            subject: WrongPart::Unknown,
            attachment: None,
            operations: Vec::new(),
            last: last(operations),
            direction: None,
        };
        if let Some(ProcessEnd {
            kind, signal, exit, ..
        }) = record.process
        {
            let subject = WrongPart::Process { kind, signal, exit };
            return Self { subject, ..bare };
        }
        let by_counter = record.is_decided_by_counter();
        if let Some(invariance) = invariance(events).filter(|_| !by_counter) {
            let subject = WrongPart::Relation(invariance);
            return Self { subject, ..bare };
        }
        let is_deciding = |w: &&WrongTexel| w.band > Band::Imprecise && !by_counter;
        let wrong = record.wrong.first().filter(is_deciding);
        if let Some(channel) = wrong.and_then(|w| w.channels.first()) {
            let operations = story.map(|s| deciding(s, &channel.attachment, channel.aspect));
            return Self {
                subject: WrongPart::Picture(channel.aspect),
                attachment: Some(channel.attachment.clone()),
                operations: operations.unwrap_or_default(),
                direction: Some(direction(record, channel.aspect)),
                ..bare
            };
        }
        let counters = record.counters.iter().filter(|c| c.band.is_some());
        if let Some(counter) = counters.max_by_key(|c| c.band) {
            return Self {
                subject: WrongPart::Counter(counter.kind),
                direction: Some(if counter.actual < counter.low {
                    Direction::Low
                } else {
                    Direction::High
                }),
                ..bare
            };
        }
        let error = record.error.clone();
        let subject = error.map_or(WrongPart::Unknown, WrongPart::Error);
        Self { subject, ..bare }
    }

    /// Returns true if the worker draws further cases after the failure, so that the case can be reduced: a frame was
    /// judged, or a shader was not compiled.
    pub fn keeps_worker(&self) -> bool {
        let shader = matches!(self.subject, WrongPart::Error(ErrorKind::Shader(_)));
        self.verdict.is_violation() || shader
    }

    /// Returns true if a smaller case that fails like `other` also fails like this one.
    pub fn covers(&self, other: &Self) -> bool {
        self.attachment == other.attachment && self.covers_elsewhere(other)
    }

    /// Like [`Symptom::covers`], whatever the attachments are called.
    pub fn covers_elsewhere(&self, other: &Self) -> bool {
        let same = self.verdict == other.verdict && self.subject == other.subject;
        let counter = matches!(self.subject, WrongPart::Counter(_));
        same && (!counter || self.direction == other.direction)
            && other.operations.iter().all(|o| self.operations.contains(o))
            && other.operations.is_empty() == self.operations.is_empty()
    }

    /// Returns the symptom that most cases of one bug share: without the attachment of a picture, and
    /// without the kind of an error.
    pub fn broad(self) -> Self {
        let subject = match self.subject {
            WrongPart::Error(_) => WrongPart::Unknown,
            subject => subject,
        };
        Self {
            subject,
            attachment: None,
            operations: Vec::new(),
            ..self
        }
    }

    /// Returns the deciding operations, without operations that set an attachment's contents before the
    /// draws, unless there are no others.
    pub fn of_draws(&self) -> Vec<Operation> {
        let mut drawn = self.operations.clone();
        drawn.retain(|operation| !INITIAL.contains(operation));
        if drawn.is_empty() {
            self.operations.clone()
        } else {
            drawn
        }
    }

    /// Returns the symptom in a few words: `color too high after blend`; empty if only the verdict is
    /// known.
    pub fn text(&self) -> String {
        let mut words = match &self.subject {
            WrongPart::Picture(aspect) => vec![aspect.name().to_owned()],
            WrongPart::Unknown => Vec::new(),
            other => vec![other.to_string()],
        };
        words.extend(self.direction.map(|d| d.words().to_owned()));
        if let Some(last) = self.last {
            words.extend(["after".to_owned(), last.name().to_owned()]);
        }
        words.join(" ")
    }
}

/// Displays the subject and the deciding operations: `color of target (blend, store color)`.
impl fmt::Display for Symptom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.subject, self.direction) {
            (WrongPart::Picture(aspect), _) => {
                let attachment = self.attachment.as_deref().unwrap_or_default();
                let operations = names(&self.operations);
                write!(f, "{} of {attachment} ({operations})", aspect.name())
            }
            (WrongPart::Counter(_), Some(direction)) => {
                write!(f, "{} counts too {}", self.subject, direction.amount())
            }
            (WrongPart::Unknown, _) => f.write_str(self.verdict.name()),
            (subject, _) => subject.fmt(f),
        }
    }
}

impl fmt::Display for WrongPart {
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
            Self::Error(kind) => kind.fmt(f),
            Self::Unknown => f.write_str("unknown"),
        }
    }
}

impl Direction {
    /// Returns `little` or `much`, for a counter that counts too little or too much.
    pub(crate) fn amount(self) -> &'static str {
        match self {
            Self::Low => "little",
            Self::High | Self::Both => "much",
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::High => "too high",
            Self::Low => "too low",
            Self::Both => "differs",
        }
    }
}

/// Returns the names of operations: `blend, store color`.
pub(crate) fn names(operations: &[Operation]) -> String {
    let names: Vec<&str> = operations.iter().map(|o| o.name()).collect();
    names.join(", ")
}

/// Returns the clause that the driver violates: the clause of the last operation that cites one and can have made the
/// value wrong. Operations that convert a value are off by its rounding at most. Coverage cites a clause even for
/// primitives elsewhere, so its clause is used only if no other operation cites any. `None` if pictures must be
/// equal, because no single operation decides that.
pub fn violated_clause(record: &Record) -> Option<&str> {
    let story = record.story.as_ref()?;
    if invariance(&story.events).is_some() {
        return None;
    }
    let cited = |operations: &dyn Fn(Operation) -> bool| {
        let mut events = story.events.iter().rev();
        events.find_map(|event| {
            let counts = operations(event.operation());
            event.citation.as_deref().filter(|_| counts)
        })
    };
    let covers = |operation| operation == Operation::Coverage;
    let converts = |operation| CONVERTING.contains(&operation);
    let decides = |operation| !covers(operation) && !converts(operation);
    if story.keeps_earlier_contents() {
        // The draw was lost before its value was converted.
        return cited(&decides)
            .or_else(|| cited(&covers))
            .or_else(|| cited(&converts));
    }
    if is_rounded(record) {
        return cited(&|operation| !covers(operation)).or_else(|| cited(&covers));
    }
    cited(&decides)
        .or_else(|| cited(&converts))
        .or_else(|| cited(&covers))
}

/// Returns true if the first wrong sample is at most as far from the allowed values as a conversion can be.
fn is_rounded(record: &Record) -> bool {
    let mut channels = record
        .wrong
        .first()
        .into_iter()
        .flat_map(|texel| &texel.channels);
    channels.all(|m| {
        let [low, actual, high] =
            [m.low, m.actual, m.high].map(|code| m.encoding.order_of_code(code));
        actual + ROUNDED >= low && actual <= high + ROUNDED
    })
}

/// Returns the last operation that not every sample goes through. A value that a draw gives was last shaded, not cleared.
fn last(mut operations: impl Iterator<Item = Operation>) -> Option<Operation> {
    let mut is_shaded = false;
    let found = operations.find(|operation| {
        is_shaded |= *operation == Operation::Shade;
        !COMMON.contains(operation)
    })?;
    Some(if is_shaded && INITIAL.contains(&found) {
        Operation::Shade
    } else {
        found
    })
}

/// Returns the name of the invariance, if a story is about two pictures that must be equal.
fn invariance(events: &[Event]) -> Option<String> {
    events.iter().find_map(|event| match &event.step {
        Step::Relation(name) => Some(name.clone()),
        _ => None,
    })
}

/// Returns whether the wrong values of an aspect are too high or too low.
fn direction(record: &Record, aspect: Aspect) -> Direction {
    let channels = record.wrong.iter().flat_map(|texel| &texel.channels);
    let of_aspect = || channels.clone().filter(|m| m.aspect == aspect);
    let order = |m: &ChannelMismatch, code| m.encoding.order_of_code(code);
    let high = of_aspect().any(|m| order(m, m.actual) > order(m, m.high));
    let low = of_aspect().any(|m| order(m, m.actual) < order(m, m.low));
    match (high, low) {
        (true, false) => Direction::High,
        (false, true) => Direction::Low,
        _ => Direction::Both,
    }
}

/// Returns the operations that decide the value of an aspect of an attachment at the sample of a story.
fn deciding(story: &Story, attachment: &str, aspect: Aspect) -> Vec<Operation> {
    let mut deciding: Vec<Operation> = Vec::new();
    let add = |deciding: &mut Vec<Operation>, operation: Operation| {
        if !deciding.contains(&operation) {
            deciding.push(operation);
        }
    };
    let mut drawn = false;
    for group in story.events.chunk_by(Event::is_beside) {
        if group[0].origin.draw().is_none() {
            for event in group {
                if gives(event, attachment) {
                    deciding = vec![event.operation()];
                    drawn = false;
                } else if event.step == Step::ClearElsewhere {
                    add(&mut deciding, event.operation());
                }
            }
            continue;
        }
        // Several attachments are stored one after another, each after the operations that compute it.
        let concerns = |target: &Target| {
            target.aspect == aspect && (aspect != Aspect::Color || target.attachment == attachment)
        };
        let stores = |e: &Event| matches!(&e.effect, Effect::Stores(target) if concerns(target));
        let keeps = |e: &Event| matches!(&e.effect, Effect::Keeps(target) if concerns(target));
        drawn = true;
        if let Some(stored) = group.iter().position(stores) {
            deciding.clear();
            let ends = |e: &&Event| match &e.effect {
                Effect::Stores(target) | Effect::Keeps(target) => target.aspect == aspect,
                _ => false,
            };
            let before = group[..stored].iter().rev().take_while(|e| !ends(e));
            let mut before = before.map(Event::operation);
            if aspect == Aspect::Color
                && let Some(operation) = before.find(|o| COMPUTED.contains(o))
            {
                add(&mut deciding, operation);
            }
            add(&mut deciding, group[stored].operation());
        } else if let Some(kept) = group.iter().find(|e| keeps(e)) {
            add(&mut deciding, kept.operation());
        } else if let Some(event) = rejection(group) {
            add(&mut deciding, event.operation());
        }
    }
    // If the driver kept earlier contents, no computation could be wrong.
    if story.keeps_earlier_contents() {
        deciding.retain(|o| !COMPUTED.contains(o));
    }
    // Every draw has primitives elsewhere, so coverage decides only if nothing else does.
    if drawn && deciding.iter().all(|o| INITIAL.contains(o)) {
        add(&mut deciding, Operation::Coverage);
    }
    deciding
}

/// Returns true if an operation between draws sets an attachment's contents.
fn gives(event: &Event, attachment: &str) -> bool {
    match &event.step {
        Step::Upload(contents) | Step::Clear(contents) => {
            contents.iter().any(|c| c.attachment == attachment)
        }
        Step::Resolve { to, .. } | Step::ResolveDepthStencil { to, .. } => to == attachment,
        _ => false,
    }
}

/// Returns the last operation of a group that rejects the draw at the sample, except coverage: every draw
/// has primitives elsewhere.
fn rejection(group: &[Event]) -> Option<&Event> {
    group
        .iter()
        .rev()
        .find(|event| match event.effect.rejection() {
            Some(rejection) => rejection != Rejection::Coverage,
            None => event.step == Step::LostAfterEarlyTests,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{
        ChannelEncoding, ContentSource, Contents, CounterOutcome, Coverage, DepthTest, Initial,
        Origin, Returned, Ruling, SceneName, ValueRange, Values, WrongTexel,
    };
    use etalon_frame::{Demand, ResolveChoice};
    use etalon_record::Reason;

    fn event(origin: Origin, step: Step, effect: Effect) -> Event {
        Event {
            scene: None,
            origin,
            step,
            effect,
            citation: None,
        }
    }

    /// Returns an event of the only primitive of a draw.
    fn drawn(draw: usize, step: Step, effect: Effect) -> Event {
        let origin = Origin::Fragment {
            pass: 0,
            draw,
            primitive: 0,
            world: None,
        };
        event(origin, step, effect)
    }

    fn contents(attachment: &str) -> Contents {
        Contents {
            attachment: attachment.to_owned(),
            aspect: Aspect::Color,
            codes: Vec::new(),
        }
    }

    fn target(attachment: &str) -> Target {
        Target {
            attachment: attachment.to_owned(),
            aspect: Aspect::Color,
        }
    }

    fn clear(attachment: &str) -> Event {
        let origin = Origin::Attachment(attachment.to_owned());
        event(
            origin,
            Step::Clear(vec![contents(attachment)]),
            Effect::None,
        )
    }

    fn logic(draw: usize) -> Event {
        let step = Step::Logic {
            operation: "xor".to_owned(),
            stored: contents("c"),
        };
        drawn(draw, step, Effect::None)
    }

    fn blend(draw: usize) -> Event {
        let any = || ValueRange {
            low: 0.0,
            high: 1.0,
        };
        let step = Step::AdvancedBlend {
            operation: "multiply".to_owned(),
            src: [any(); 4],
            dst: [any(); 4],
            result: [any(); 4],
        };
        drawn(draw, step, Effect::None)
    }

    fn store(draw: usize, attachment: &str) -> Event {
        let step = Step::StoreColor {
            contents: contents(attachment),
            write_mask: None,
        };
        drawn(draw, step, Effect::Stores(target(attachment)))
    }

    fn keep(draw: usize, attachment: &str) -> Event {
        let step = Step::KeepColor {
            contents: contents(attachment),
            write_mask: 0,
        };
        drawn(draw, step, Effect::Keeps(target(attachment)))
    }

    fn depth_test(draw: usize, effect: Effect) -> Event {
        let compare = "less".to_owned();
        drawn(draw, Step::DepthTest(DepthTest::Same { compare }), effect)
    }

    fn scissor(draw: usize) -> Event {
        let origin = Origin::Draw {
            pass: 0,
            draw,
            primitives: Vec::new(),
        };
        let effect = Effect::Rejects(Rejection::Scissor);
        event(origin, Step::Scissor([0; 4]), effect)
    }

    fn coverage(draw: usize) -> Event {
        let effect = Effect::Rejects(Rejection::Coverage);
        drawn(draw, Step::Coverage(Coverage::Outside), effect)
    }

    fn read_back() -> Event {
        let step = Step::ReadBack {
            attachment: "c".to_owned(),
            contents: Vec::new(),
            depth_by_shader: false,
        };
        event(Origin::End { world: None }, step, Effect::None)
    }

    fn story(events: Vec<Event>) -> Story {
        Story {
            events,
            ..Story::default()
        }
    }

    fn record(actual: u32, events: Vec<Event>) -> Record {
        let mut record = Record::new("a/b", "cpu", Verdict::Fail);
        record.story = Some(story(events));
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
    fn records_of_one_bug_have_one_broad_symptom() {
        let broad = |actual, events| Symptom::of(&record(actual, events)).broad();
        let high = broad(30, vec![blend(0), store(0, "c"), read_back()]);
        assert_eq!(high.text(), "color too high after advanced blend");
        assert_eq!(high, broad(200, vec![blend(0), coverage(0)]));
        assert_ne!(high, broad(3, vec![blend(0)]));
        assert_ne!(high, broad(30, vec![depth_test(0, Effect::None)]));
        assert_eq!(broad(3, vec![]).text(), "color too low");
    }

    #[test]
    fn a_counter_on_stronger_evidence_than_a_texel_is_the_symptom() {
        let mut counted = record(30, vec![store(0, "c")]);
        counted.counters = vec![CounterOutcome {
            name: "passed".to_owned(),
            kind: CounterKind::SamplesPassed,
            low: 0,
            high: Some(32),
            actual: 64,
            band: Some(Band::Fail),
        }];
        let subject = |record: &Record| Symptom::of(record).subject;
        assert_eq!(subject(&counted), WrongPart::Picture(Aspect::Color));
        counted.wrong[0].band = Band::RequiredByCts;
        let counter = WrongPart::Counter(CounterKind::SamplesPassed);
        assert_eq!(subject(&counted), counter);
    }

    #[test]
    fn a_story_of_an_earlier_format_decides_nothing() {
        let sentences = r#"[{"at":"pass 0, draw 0","operation":"blend","detail":"c holds 1"}]"#;
        let mut old = record(30, Vec::new());
        old.story = Some(serde_json::from_str(sentences).unwrap());
        assert_eq!(Symptom::of(&old).broad().text(), "color too high");
    }

    #[test]
    fn symptoms_of_processes_and_errors_leave_out_addresses_and_numbers() {
        let mut crash = Record::new("a/b", "cpu", Verdict::Crash);
        assert_eq!(Symptom::of(&crash).text(), "");
        crash.process = Some(ProcessEnd {
            signal: Some(6),
            stderr: "at 0x7ffe".to_owned(),
            ..ProcessEnd::default()
        });
        let died = Symptom::of(&crash);
        assert_eq!(died.text(), "process died by signal 6");
        if let Some(end) = &mut crash.process {
            end.stderr.clear();
            assert!(died.covers(&Symptom::of(&crash)));
        }
        crash.process.as_mut().unwrap().signal = Some(11);
        assert!(!died.covers(&Symptom::of(&crash)));

        let error = |condition: &str, message: &str| {
            let mut record = Record::new("a/b", "cpu", Verdict::InternalError);
            let condition = condition.to_owned();
            let code = None;
            record.error = Some(ErrorKind::Internal { condition, code });
            record.reasons = vec![Reason::Text(message.to_owned())];
            Symptom::of(&record)
        };
        let free = error("a slot is free", "slot 3");
        assert!(free.covers(&error("a slot is free", "slot 12")));
        assert!(!free.covers(&error("a slot is taken", "slot 3")));
        assert_eq!(free.clone().broad(), error("b", "").broad());
        assert_eq!(free.to_string(), "a slot is free");
        let mut old = Record::new("a/b", "cpu", Verdict::InternalError);
        old.reasons = vec![Reason::Text("slot 3 is free".to_owned())];
        assert_eq!(Symptom::of(&old), free.broad());
    }

    /// Returns the names of the operations that decide a colour of the attachment `c`.
    fn found(events: &[&Event]) -> String {
        let events = events.iter().map(|event| (*event).clone()).collect();
        names(&deciding(&story(events), "c", Aspect::Color))
    }

    #[test]
    fn the_last_store_and_later_rejections_decide() {
        let [clear, logic, store] = [clear("c"), logic(0), store(0, "c")];
        let upload = event(
            Origin::Attachment("d".to_owned()),
            Step::Upload(vec![contents("d")]),
            Effect::None,
        );
        let [scissor, coverage] = [scissor(1), coverage(2)];
        assert_eq!(found(&[&clear]), "clear");
        let worked = "logic operation, store color";
        assert_eq!(found(&[&clear, &logic, &store]), worked);
        let behind = self::scissor(0);
        assert_eq!(found(&[&clear, &behind, &logic, &store]), worked);
        assert_eq!(
            found(&[&clear, &logic, &store, &scissor, &coverage]),
            "logic operation, store color, scissor"
        );
        assert_eq!(found(&[&clear, &upload, &scissor]), "clear, scissor");
        assert_eq!(found(&[&clear, &coverage]), "clear, coverage");
        let before = Event {
            origin: Origin::BeforeDraw { pass: 0, draw: 1 },
            ..clear.clone()
        };
        assert_eq!(found(&[&clear, &logic, &store, &before]), "clear");
        let resolve = |from: &str, to: &str| {
            let step = Step::Resolve {
                from: from.to_owned(),
                to: to.to_owned(),
                by: ResolveChoice::Average,
                samples: Vec::new(),
                results: Vec::new(),
            };
            event(Origin::AfterPass(0), step, Effect::Stores(target(to)))
        };
        assert_eq!(found(&[&store, &resolve("d", "c")]), "resolve");
        assert_eq!(found(&[&store, &resolve("c", "d")]), "store color");
        let beside = event(Origin::PassEnd(0), Step::ClearElsewhere, Effect::None);
        assert_eq!(found(&[&store, &beside]), "store color, clear");
        let plain = self::store(2, "c");
        assert_eq!(found(&[&clear, &logic, &store, &plain]), "store color");
    }

    #[test]
    fn an_operation_on_one_attachment_does_not_decide_another() {
        let blended = [blend(0), store(0, "d"), store(0, "c")];
        let in_variant = blended.map(|event| Event {
            scene: Some(SceneName::Variant("twice".to_owned())),
            ..event
        });
        assert_eq!(found(&in_variant.each_ref()), "store color");
        assert_eq!(found(&[&store(0, "d"), &keep(0, "c")]), "keep color");
    }

    #[test]
    fn a_draw_that_does_not_arrive_is_the_same_however_it_blends() {
        let with = |returned: Returned, last: Event| {
            let values = Values {
                yardstick: false,
                allowed: Vec::new(),
                more_outcomes: 0,
                reasons: Vec::new(),
                more_draws: 0,
                returned: Some(returned),
                several_colors: false,
                several_passes: false,
            };
            let ruling = Ruling {
                variant: None,
                texel: [0, 0],
                samples: Vec::new(),
                demand: Demand::Values(Box::new(values)),
                rules: "Vulkan".to_owned(),
                after: Vec::new(),
                band: None,
            };
            let story = Story {
                ruling: Some(ruling),
                events: vec![clear("c"), logic(0), last],
                ..Story::default()
            };
            names(&deciding(&story, "c", Aspect::Color))
        };
        let kept = || Returned::Kept {
            contents: contents("c"),
            from: ContentSource::Initial(Initial::Clear),
        };
        assert_eq!(with(kept(), store(0, "c")), "store color");
        assert_eq!(with(kept(), scissor(1)), "clear, scissor");
        assert_eq!(
            with(Returned::Wrote(Vec::new()), store(0, "c")),
            "logic operation, store color"
        );
    }

    #[test]
    fn the_last_cited_operation_is_violated_and_coverage_only_if_no_other_is() {
        let cited = |event: Event, clause: &str| Event {
            citation: Some(clause.to_owned()),
            ..event
        };
        let mut events = vec![cited(coverage(0), "Coverage")];
        let clause = |events: &[Event]| {
            let mut record = Record::new("a/b", "x", Verdict::Fail);
            record.story = Some(story(events.to_vec()));
            violated_clause(&record).map(str::to_owned)
        };
        assert_eq!(clause(&events).as_deref(), Some("Coverage"));
        events.insert(0, cited(blend(0), "Blending"));
        events.push(store(0, "c"));
        assert_eq!(clause(&events).as_deref(), Some("Blending"));
        let relation = Step::Relation("repeat".to_owned());
        events.push(event(Origin::Pass(0), relation, Effect::None));
        assert_eq!(clause(&events), None);
    }

    #[test]
    fn a_test_that_passes_rejects_nothing() {
        let stencil = Step::StencilTest {
            reference: 0,
            exported: false,
            compare: "always".to_owned(),
            stored: 0,
            read_mask: 0xff,
            depth_fails: true,
        };
        let stencil = drawn(0, stencil, Effect::None);
        let ends = |effect| {
            let group = [depth_test(0, effect), stencil.clone()];
            rejection(&group).map(Event::operation)
        };
        let fails = Effect::Rejects(Rejection::Depth);
        assert_eq!(ends(fails), Some(Operation::DepthTest));
        assert_eq!(ends(Effect::None), None);
    }

    #[test]
    fn a_smaller_case_has_no_new_operation() {
        use Operation::{Blend, Scissor, StoreColor};
        let symptom = |operations: &[Operation], attachment: &str, verdict| Symptom {
            verdict,
            subject: WrongPart::Picture(Aspect::Color),
            attachment: Some(attachment.to_owned()),
            operations: operations.to_vec(),
            last: operations.last().copied(),
            direction: Some(match operations.len() {
                1 => Direction::High,
                _ => Direction::Low,
            }),
        };
        let fail = |operations: &[Operation]| symptom(operations, "c", Verdict::Fail);
        let both = fail(&[Blend, Scissor]);
        assert!(both.covers(&both));
        assert!(both.covers(&fail(&[Blend])));
        assert!(!both.covers(&fail(&[StoreColor])));
        assert!(!both.covers(&fail(&[Blend, StoreColor])));
        assert!(!both.covers(&fail(&[])));
        assert!(!fail(&[Blend]).covers(&both));
        assert!(!both.covers(&symptom(&[Blend], "d", Verdict::Fail)));
        assert!(!both.covers(&symptom(&[Blend], "c", Verdict::Disputed)));
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
        assert!(low.covers(&counter(2)) && !low.covers(&high) && !both.covers(&low));
        assert_eq!(high.to_string(), "counter shader-runs counts too much");
    }

    #[test]
    fn a_failed_relation_is_one_symptom_whatever_its_pictures_hold() {
        let relation = Step::Relation("repeat".to_owned());
        let mut events = vec![event(Origin::Pass(0), relation, Effect::None)];
        events.push(store(0, "c"));
        assert_eq!(
            Symptom::of(&record(3, events)).to_string(),
            "relation repeat"
        );
    }
}
