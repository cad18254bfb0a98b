//! The changes since the last run: each adapter is compared with its previous run; the worst changes come
//! first.

use super::model::Model;
use super::times::{CaseTimes, Timed};
use crate::lists::grouped;
use crate::numbers::{between, change, count};
use etalon_history::{TriageEntry, TriageState, TriageSubject};
use etalon_stats::{Cause, ChangePoint, Happening, VerdictEvent};
use std::collections::BTreeMap;

/// The maximum number of lines of news on the start page.
const LINES: usize = 24;
/// The number of runs for which a change of times stays news, unless triage settles it.
const RECENT: usize = 20;

/// The kind of a line, worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum NewsLineKind {
    Broken,
    Flaky,
    Set,
    Fixed,
    Times,
    /// Triage says that the change is known or does not matter.
    Known,
}

/// The kinds, each with the class that colours its lines and the maximum number of lines if other kinds need
/// room.
const KINDS: [(NewsLineKind, &str, usize); 6] = [
    (NewsLineKind::Broken, "f", 10),
    (NewsLineKind::Flaky, "o", 3),
    (NewsLineKind::Set, "n", 3),
    (NewsLineKind::Fixed, "p", 3),
    (NewsLineKind::Times, "b", 4),
    (NewsLineKind::Known, "u", 1),
];

impl NewsLineKind {
    /// Returns the class that colours a line.
    pub(super) fn colour(self) -> &'static str {
        KINDS[self as usize].1
    }
}

/// A line of the news.
pub(super) struct Item {
    pub(super) kind: NewsLineKind,
    /// The sign and the word: `✗ broken`.
    pub(super) word: &'static str,
    /// The case, or the family of cases.
    pub(super) subject: String,
    /// True if the subject is a family.
    pub(super) is_family: bool,
    /// The event and its adapters.
    pub(super) text: String,
    /// The state of triage with its reason, or `expected`.
    pub(super) chip: String,
    /// The order within the kind.
    rank: i64,
}

/// The news and their counts per timeline.
pub(super) struct News {
    /// All lines, worst first.
    pub(super) items: Vec<Item>,
    /// Broken, flaky, fixed, appeared and gone cases by timeline.
    pub(super) counts: Vec<[u64; 5]>,
}

/// The events in the order of [`News::counts`] and of the data files, each with its kind of line and the label
/// of these lines.
const EVENTS: [(VerdictEvent, NewsLineKind, &str); 5] = [
    (VerdictEvent::Broken, NewsLineKind::Broken, "✗ broken"),
    (VerdictEvent::Flaky, NewsLineKind::Flaky, "⇄ flaky"),
    (VerdictEvent::Fixed, NewsLineKind::Fixed, "✓ fixed"),
    (VerdictEvent::Appeared, NewsLineKind::Set, "+ appeared"),
    (VerdictEvent::Gone, NewsLineKind::Set, "− gone"),
];

/// Returns the index of an event in [`EVENTS`].
pub(super) fn number(event: VerdictEvent) -> usize {
    let place = EVENTS.iter().position(|(known, ..)| *known == event);
    place.unwrap_or_default()
}

struct NewsHit {
    line: usize,
    text: String,
    unexpected: bool,
}

impl News {
    pub(super) fn find(model: &Model<'_>) -> Self {
        let (families, looks) = (&model.families, &model.looks);
        let mut counts = vec![[0; 5]; model.timelines.len()];
        let mut hits: BTreeMap<(usize, usize), Vec<NewsHit>> = BTreeMap::new();
        let mut sets: BTreeMap<(usize, u32), BTreeMap<usize, u64>> = BTreeMap::new();
        for (line, timeline) in model.timelines.iter().enumerate() {
            let is_last = |event: &&Happening<u32>| event.at as usize == timeline.last;
            for (case, course) in timeline.courses.of.iter().enumerate() {
                let Some(course) = course else { continue };
                for event in course.events.iter().filter(is_last) {
                    let kind = number(event.event);
                    counts[line][kind] += 1;
                    if kind > 2 {
                        let of_family = sets.entry((kind, families.of[case])).or_default();
                        *of_family.entry(line).or_default() += 1;
                        continue;
                    }
                    let (before, now) = (course.look(event.after), course.look(event.at));
                    hits.entry((kind, case)).or_default().push(NewsHit {
                        line,
                        text: format!("{} → {}", looks.text(before), looks.text(now)),
                        unexpected: looks.is_unexpected(now),
                    });
                }
            }
        }
        let of_case = |((kind, case), hits): (&(usize, usize), &Vec<NewsHit>)| {
            of_case(model, *kind, &model.cases[*case], hits)
        };
        let mut items: Vec<Item> = hits.iter().map(of_case).collect();
        items.extend(sets.iter().map(|((kind, family), lines)| {
            of_set(model, *kind, &families.names[*family as usize], lines)
        }));
        for series in &model.series {
            items.extend(
                series
                    .times
                    .iter()
                    .flat_map(|timed| of_times(model, series, timed)),
            );
        }
        items.sort_by(|a, b| (a.kind, a.rank, &a.subject).cmp(&(b.kind, b.rank, &b.subject)));
        Self { items, counts }
    }

    /// Returns the lines for a screen: each kind gets an equal part, and the worst kinds get the room that is
    /// left.
    pub(super) fn screen(&self) -> Vec<&Item> {
        let items = |kind: NewsLineKind| self.items.iter().filter(move |item| item.kind == kind);
        let mut room = LINES;
        let mut counts = KINDS.map(|(kind, _, most)| {
            let lines = items(kind).count().min(most).min(room);
            room -= lines;
            lines
        });
        for (lines, (kind, ..)) in counts.iter_mut().zip(KINDS) {
            let more = (items(kind).count() - *lines).min(room);
            *lines += more;
            room -= more;
        }
        let lines = KINDS.into_iter().zip(counts);
        lines
            .flat_map(|((kind, ..), lines)| items(kind).take(lines))
            .collect()
    }
}

fn of_case(model: &Model<'_>, kind: usize, case: &str, hits: &[NewsHit]) -> Item {
    let unexpected = hits.iter().any(|hit| hit.unexpected);
    let entry = |hit: &NewsHit| {
        model.states.get(&TriageSubject {
            case: case.to_owned(),
            timeline: model.name(hit.line).to_owned(),
            step: None,
        })
    };
    let entries: Vec<_> = hits.iter().map(entry).collect();
    let is_known = kind < 2
        && entries.iter().all(|entry| {
            entry.is_some_and(|e| matches!(e.state, TriageState::Ignored | TriageState::Real))
        });
    let chip = match entries.iter().flatten().next() {
        Some(entry) => said(entry),
        None if kind < 2 && !unexpected => "expected".to_owned(),
        None => String::new(),
    };
    // Adapters with the same change are listed together.
    let texts = grouped(hits.iter().map(|hit| (&*hit.text, model.name(hit.line))));
    let texts = texts.iter();
    let texts: Vec<String> = texts
        .map(|(text, names)| format!("{text} on {}", named(names)))
        .collect();
    let (_, kind, word) = EVENTS[kind];
    Item {
        kind: if is_known { NewsLineKind::Known } else { kind },
        word,
        subject: case.to_owned(),
        is_family: false,
        text: texts.join("; "),
        chip,
        rank: i64::from(!unexpected) * 1_000_000 - hits.len() as i64,
    }
}

fn of_set(model: &Model<'_>, kind: usize, family: &str, lines: &BTreeMap<usize, u64>) -> Item {
    let most = lines.values().max().copied().unwrap_or(0);
    let names: Vec<&str> = lines.keys().map(|line| model.name(*line)).collect();
    let (event, kind, word) = EVENTS[kind];
    let verb = match event {
        VerdictEvent::Appeared => "new",
        _ => "without a verdict",
    };
    Item {
        kind,
        word,
        subject: family.to_owned(),
        is_family: true,
        text: format!("{} {verb} on {}", count(most, "case"), named(&names)),
        chip: String::new(),
        rank: -(most as i64),
    }
}

/// Returns the state of triage with its reason.
fn said(entry: &TriageEntry) -> String {
    let reason = if entry.reason.is_empty() { "" } else { ": " };
    format!("{}{reason}{}", entry.state.name(), entry.reason)
}

fn named(names: &[&str]) -> String {
    match names {
        [a] => (*a).to_owned(),
        [a, b] => format!("{a} and {b}"),
        [a, b, more @ ..] => format!("{a}, {b} and {}", count(more.len() as u64, "other")),
        [] => String::new(),
    }
}

/// Returns the changes of one series that are news.
fn of_times(model: &Model<'_>, series: &CaseTimes, timed: &Timed) -> Vec<Item> {
    let line = &model.timelines[series.line].line.runs;
    // The end of a series that is no longer measured is not news.
    let is_measured = timed.runs.last() == line.last().map(|run| &run.place);
    let recent = |point: &ChangePoint| {
        let place = timed.runs[point.index];
        line.partition_point(|run| run.place < place) + RECENT >= line.len()
    };
    let mut items = Vec::new();
    for (point, state, fresh) in timed.told() {
        let is_open = state.is_none_or(|entry| entry.state == TriageState::New);
        let fresh = fresh && is_measured;
        if !(fresh || is_open && recent(point)) {
            continue;
        }
        let known = !is_open || point.cause == Cause::Machine || point.returns;
        let run = |index: usize| {
            let index = index.min(timed.runs.len() - 1);
            model.places.day(timed.runs[index])
        };
        let ratio = &point.ratio;
        let size = ratio.estimate.ln().abs();
        items.push(Item {
            kind: if known {
                NewsLineKind::Known
            } else {
                NewsLineKind::Times
            },
            word: if ratio.estimate > 1.0 {
                "▲ slower"
            } else {
                "▼ faster"
            },
            subject: model.cases[series.case].to_string(),
            is_family: false,
            text: format!(
                "{} {} ({}), p {}, between {} and {} on {}; a change of {} would be visible; {}{}",
                timed.time.name(),
                change(ratio.estimate),
                between([ratio.low, ratio.high], change),
                probability(point.p),
                run(point.between[0]),
                run(point.between[1]),
                model.name(series.line),
                change(point.visible),
                point.cause.text(),
                if point.returns {
                    "; it goes back and forth"
                } else {
                    ""
                },
            ),
            chip: match state {
                Some(entry) => said(entry),
                None if fresh => "found with this run".to_owned(),
                None => "new".to_owned(),
            },
            rank: i64::from(ratio.estimate < 1.0) * 1_000_000_000 - (size * 1e6) as i64,
        });
    }
    items
}

/// Returns a probability with few digits, or a bound if it is very small.
pub(super) fn probability(p: f64) -> String {
    match p {
        p if p < 1e-9 => "< 1e-9".to_owned(),
        p if p < 0.001 => format!("{p:.0e}"),
        p => format!("{p:.3}"),
    }
}
