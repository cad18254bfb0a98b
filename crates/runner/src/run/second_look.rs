//! Checking a bad verdict again: a fresh process confirms it, or shows what it depends on.

use super::adapter_run::{Observation, RunningAdapter};
use crate::drawing::Drawing;
use crate::failure_report::FailureReport;
use crate::loss::{Loss, RequestError};
use crate::process::WorkerProcess;
use crate::supervisor::start;
use crate::sync::lock;
use etalon_diagnose::Symptom;
use etalon_judge::{is_unexpectedly_bad, mark_flaky};
use etalon_record::{Fresh, LossKind, Reason, Verdict};
use std::time::{Duration, Instant};

/// The time after which a search for the preceding cases is not narrowed further.
const SEARCH_TIME: Duration = Duration::from_secs(120);
/// The number of times that a cause must be confirmed.
const CONFIRMATIONS: u32 = 5;
/// The maximum number of cases that a record names.
const MAX_NAMED: usize = 8;

/// Draws a case again in fresh processes, if `--repeat` asks for it, or if its verdict is bad and
/// unexpected. If verdicts differ, the result is `Flaky`, unless the case fails reproducibly after certain
/// other cases, which the record then names. Calls `make_room` before the first process starts. Returns
/// `None` if the run is stopped.
pub(super) fn confirm(
    run: &RunningAdapter<'_, '_>,
    number: usize,
    mut first: Observation,
    before: &[usize],
    make_room: &mut dyn FnMut(),
) -> Option<Observation> {
    let options = &run.shared.options;
    let more = match options.repeat.max(1) - 1 {
        0 if needs_confirmation(run, &first, options.recheck) => 1,
        more if first.record.verdict != Verdict::NotSupported => more,
        _ => 0,
    };
    if more > 0 {
        make_room();
    }
    let mut others = Vec::new();
    for _ in 0..more {
        match draw_alone(run, &[], number) {
            Redrawn::Observed(observed) => others.push(*observed),
            Redrawn::Unable => break,
            Redrawn::Stopped => return None,
        }
    }
    let verdict = first.record.verdict;
    let repeats: Vec<Verdict> = others.iter().map(|s| s.record.verdict).collect();
    if repeats.iter().any(|v| *v != verdict) {
        run.queue.refuted(&Symptom::of(&first.record).broad());
    }
    if repeats.iter().all(|v| *v == verdict) {
        // Which verdicts of a kind are checked depends on the drawing order. Records mention a check only
        // if it changed something, so that they are the same in every run.
        if options.repeat > 1 {
            first.record.repeats = repeats;
        }
        return Some(first);
    }
    let only_after_others = verdict.is_bad() && repeats.iter().all(|v| !v.is_bad());
    if only_after_others && !before.is_empty() && run.queue.claim_search() {
        match search(run, number, verdict, before) {
            OrderCause::Cases(cases) => {
                let named = cases.iter().take(MAX_NAMED);
                first.record.after = named.map(|n| run.case(*n).id.clone()).collect();
                let story = first.record.story.as_mut();
                if let Some(ruling) = story.and_then(|story| story.ruling.as_mut()) {
                    ruling.after.clone_from(&first.record.after);
                }
                let others = Reason::AfterOthers(cases.len());
                first.record.reasons.insert(0, others);
                first.record.repeats = repeats;
                return Some(first);
            }
            OrderCause::Unknown => {}
            OrderCause::Stopped => return None,
        }
    }
    let drawings = std::iter::once(first).chain(others);
    let mut worst = drawings.max_by_key(|s| s.record.verdict.severity())?;
    mark_flaky(&mut worst.record, verdict, repeats, Fresh::Process);
    Some(worst)
}

/// Returns true if a verdict is bad and unexpected, and a fresh process could change it.
fn needs_confirmation(run: &RunningAdapter<'_, '_>, observed: &Observation, most: u32) -> bool {
    let record = &observed.record;
    let started = record
        .process
        .as_ref()
        .is_none_or(|p| p.kind != LossKind::NotStarted);
    started
        && is_unexpectedly_bad(record, &run.queue.expectations, &run.queue.adapter)
        && run.queue.claim_recheck(&Symptom::of(record).broad(), most)
}

/// The result of drawing a case in a fresh process.
enum Redrawn {
    Observed(Box<Observation>),
    /// No worker could be started, or it was lost before it reached the case.
    Unable,
    Stopped,
}

/// Draws a case in a fresh process, after other cases that are not judged.
fn draw_alone(run: &RunningAdapter<'_, '_>, before: &[usize], number: usize) -> Redrawn {
    let Ok(mut worker) = start(&run.queue.launch, run.shared.options.memory) else {
        return Redrawn::Unable;
    };
    for other in before {
        if run.shared.stopped() {
            return Redrawn::Stopped;
        }
        if let Err(RequestError::Lost(_)) = draw(run, &mut worker, *other).frames {
            return Redrawn::Unable;
        }
    }
    let drawing = draw(run, &mut worker, number);
    if matches!(drawing.frames, Err(RequestError::Lost(Loss::Cancelled))) {
        return Redrawn::Stopped;
    }
    let is_drawn = drawing.frames.is_ok();
    let report = |failure| FailureReport::new(failure, Some(&mut worker));
    let observation = run.observe(number, drawing, report);
    if is_drawn {
        run.queue.bad_ends.end(worker);
    }
    Redrawn::Observed(Box::new(observation))
}

fn draw(run: &RunningAdapter<'_, '_>, worker: &mut WorkerProcess, number: usize) -> Drawing {
    let case = run.case(number);
    worker.draw_case(number as u32, case, run.wait(case))
}

/// The reason why a case has a verdict that it does not have alone.
enum OrderCause {
    /// These cases, drawn before it in this order.
    Cases(Vec<usize>),
    Unknown,
    Stopped,
}

/// Searches for the cases that must precede a case for its verdict, by halving the cases drawn before it.
fn search(
    run: &RunningAdapter<'_, '_>,
    number: usize,
    verdict: Verdict,
    before: &[usize],
) -> OrderCause {
    let start = Instant::now();
    let mut stopped = false;
    let mut reproduces = |cases: &[usize]| match draw_alone(run, cases, number) {
        Redrawn::Observed(observed) => observed.record.verdict == verdict,
        Redrawn::Unable => false,
        Redrawn::Stopped => {
            stopped = true;
            false
        }
    };
    let mut cause = before.to_vec();
    let mut found = reproduces(&cause);
    while found && cause.len() > 1 && start.elapsed() < SEARCH_TIME {
        let middle = cause.len() / 2;
        // Tries the later half first, because state left by a recent case is the likelier cause.
        if reproduces(&cause[middle..]) {
            cause.drain(..middle);
        } else if reproduces(&cause[..middle]) {
            cause.truncate(middle);
        } else {
            break;
        }
    }
    // A flaky case may have failed by chance: it must fail after these cases and pass without them,
    // repeatedly.
    found = found && (0..CONFIRMATIONS).all(|_| reproduces(&cause) && !reproduces(&[]));
    if stopped || lock(&run.shared.error).is_some() {
        OrderCause::Stopped
    } else if found {
        OrderCause::Cases(cause)
    } else {
        OrderCause::Unknown
    }
}
