//! A second look: whether a verdict stays in a fresh process, and what it depends on where not.

use super::lane::{Lane, Sight};
use super::lock;
use crate::link::{Drawing, Link};
use crate::loss::{Loss, Obituary};
use crate::process::{Drawn, Worker};
use etalon_record::Verdict;
use std::time::{Duration, Instant};

/// How long it may take to find out what a case must be drawn after.
const SEARCH: Duration = Duration::from_secs(120);
/// How often it is tried that a case goes wrong after others and not alone.
const CONFIRMATIONS: u32 = 5;
/// The most cases that are named; what needs more is told in words.
const NAMED: usize = 8;

/// Draws a case again where that is asked for or its verdict is bad and news, each time in a fresh
/// process. What was seen then, with verdicts that differ as Flaky, unless the case goes wrong for certain
/// after others: then it names them. `None` when the run is to end.
pub(super) fn settle(
    lane: &Lane<'_, '_>,
    number: usize,
    first: Sight,
    before: &[usize],
) -> Option<Sight> {
    let options = lane.shared.options;
    let more = match options.repeat.max(1) - 1 {
        0 if options.look_again && is_news(lane, &first) => 1,
        more if first.record.verdict != Verdict::NotSupported => more,
        _ => 0,
    };
    let mut first = first;
    let mut others = Vec::new();
    for _ in 0..more {
        match draw_alone(lane, &[], number) {
            Alone::Seen(sight) => others.push(*sight),
            Alone::Unable => break,
            Alone::Stopped => return None,
        }
    }
    let due = first.record.verdict;
    let repeats: Vec<Verdict> = others.iter().map(|s| s.record.verdict).collect();
    if repeats.iter().all(|v| *v == due) {
        first.record.repeats = repeats;
        return Some(first);
    }
    let only_after_others = due.is_bad() && repeats.iter().all(|v| !v.is_bad());
    if only_after_others && !before.is_empty() && lane.column.may_search() {
        match search(lane, number, due, before) {
            Found::After(cases) => {
                let named = cases.iter().take(NAMED);
                first.record.after = named.map(|n| lane.case(*n).id.clone()).collect();
                first.record.message = format!(
                    "only after {} in the same process: {}",
                    match cases.len() {
                        1 => "another case".to_owned(),
                        n => format!("{n} other cases"),
                    },
                    first.record.message
                )
                .trim_end_matches([':', ' '])
                .to_owned();
                first.record.repeats = repeats;
                return Some(first);
            }
            Found::Nothing => {}
            Found::Stopped => return None,
        }
    }
    let mut told = vec![due.name()];
    told.extend(repeats.iter().map(|v| v.name()));
    let told = format!("{}, each in a fresh process", told.join(", then "));
    let all = std::iter::once(first).chain(others);
    let mut worst = all.max_by_key(|s| s.record.verdict.severity())?;
    worst.record.verdict = Verdict::Flaky;
    worst.record.repeats = repeats;
    worst.record.message = match worst.record.message.as_str() {
        "" => told,
        message => format!("{told}; {message}"),
    };
    Some(worst)
}

/// Whether a verdict is bad, unknown to the expectations and worth another look.
fn is_news(lane: &Lane<'_, '_>, sight: &Sight) -> bool {
    let mut record = sight.record.clone();
    record.expect(lane.shared.expectations, &lane.column.adapter);
    let started = record
        .process
        .as_ref()
        .is_none_or(|p| p.kind != etalon_record::LossKind::NotStarted);
    let due = record.due_fail && record.verdict == Verdict::Fail;
    record.unexpected()
        && record.verdict.is_bad()
        && started
        && !due
        && lane.column.may_look_again(record.verdict)
}

enum Alone {
    Seen(Box<Sight>),
    /// No worker could be started, or it was lost before the case's turn came.
    Unable,
    Stopped,
}

/// Draws a case in a fresh process, after other cases of which nothing is judged.
fn draw_alone(lane: &Lane<'_, '_>, before: &[usize], number: usize) -> Alone {
    let Ok(worker) = Worker::start(&lane.column.launch) else {
        return Alone::Unable;
    };
    let mut link = worker.link;
    if let Some(memory) = lane.shared.options.memory {
        link.guard(memory);
    }
    for other in before {
        if lane.shared.stopped() {
            return Alone::Stopped;
        }
        if let Drawn::Lost(_) = draw(lane, &mut link, *other).drawn {
            return Alone::Unable;
        }
    }
    let drawing = draw(lane, &mut link, number);
    let obituary: Option<Obituary> = match &drawing.drawn {
        Drawn::Lost(Loss::Stopped) => return Alone::Stopped,
        Drawn::Lost(loss) => Some(link.obituary(loss.clone())),
        _ => None,
    };
    Alone::Seen(Box::new(lane.judge(number, drawing, obituary)))
}

fn draw(lane: &Lane<'_, '_>, link: &mut Link, number: usize) -> Drawing {
    let case = lane.case(number);
    let asked = Instant::now();
    for scene in case.scenes() {
        link.draw(number as u32, scene);
    }
    let patience = lane.patience(case);
    link.drawn(number as u32, case.scene_count(), asked, patience)
}

enum Found {
    /// These cases, drawn before it in this order, bring the verdict about.
    After(Vec<usize>),
    Nothing,
    Stopped,
}

/// Halves the cases that were drawn before for as long as a half suffices.
fn search(lane: &Lane<'_, '_>, number: usize, due: Verdict, before: &[usize]) -> Found {
    let start = Instant::now();
    let mut stopped = false;
    let mut brings = |cases: &[usize]| match draw_alone(lane, cases, number) {
        Alone::Seen(sight) => sight.record.verdict == due,
        Alone::Unable => false,
        Alone::Stopped => {
            stopped = true;
            false
        }
    };
    let mut enough = before.to_vec();
    let mut found = brings(&enough);
    while found && enough.len() > 1 && start.elapsed() < SEARCH {
        let middle = enough.len() / 2;
        // The later half first: what was left behind lately is the likelier cause.
        if brings(&enough[middle..]) {
            enough.drain(..middle);
        } else if brings(&enough[..middle]) {
            enough.truncate(middle);
        } else {
            break;
        }
    }
    // What comes and goes by itself may have come just then: it must come with those cases and stay
    // away without them, again and again.
    found = found && (0..CONFIRMATIONS).all(|_| brings(&enough) && !brings(&[]));
    if stopped || lock(&lane.shared.error).is_some() {
        Found::Stopped
    } else if found {
        Found::After(enough)
    } else {
        Found::Nothing
    }
}
