//! Executing a plan: the folder, the shared state and the threads.

use super::adapter_queue::{AdapterQueue, LeadingRoundTrips, Next, enter_next};
use super::budget::Budget;
use super::idle::IdleProcessors;
use super::plan::{Plan, Rechecks, RunError, RunOptions, RunSummary};
use super::shared::Shared;
use super::worker_loop::WorkerLoop;
use crate::event::RunEvent;
use crate::sync::lock;
use etalon_case::Case;
use etalon_frame::threads::share;
use etalon_judge::{Judge, Truths, denials, pictured};
use etalon_record::{LossKind, Record, RunWriter, beside, count_unexpected, selection_digest};
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, RwLock};
use std::time::Duration;

/// The time that a thread without work waits before it looks again.
const WAITING: Duration = Duration::from_millis(5);

/// What the resumed run has recorded.
#[derive(Default)]
struct Resumed {
    summary: RunSummary,
    /// Adapter and case of each record.
    done: HashSet<(String, String)>,
    /// By adapter: the recorded round trips, with the number of their case.
    round_trips: HashMap<String, Vec<(usize, Record)>>,
    /// By adapter and reason: the cases that the run shows in full.
    examples: HashMap<String, HashMap<String, String>>,
    /// The records that are written beside those of the cases.
    beside: Vec<Record>,
}

impl Resumed {
    /// Adds a record, which is that of a round trip if its case has this number.
    fn add(&mut self, record: Record, round_trip: Option<usize>) {
        self.summary.count(&record);
        let adapter = &record.adapter;
        self.done.insert((adapter.clone(), record.case.clone()));
        if let Some(reason) = record.excuse() {
            let example = record.example.as_ref().unwrap_or(&record.case);
            let of_adapter = self.examples.entry(adapter.clone()).or_default();
            let entry = of_adapter.entry(reason.to_owned());
            entry.or_insert_with(|| example.clone());
        }
        if let Some(number) = round_trip {
            let records = self.round_trips.entry(adapter.clone()).or_default();
            records.push((number, record));
        }
    }
}

/// Runs every case on every adapter. Several threads report events.
///
/// # Errors
/// If the run folder cannot be written to, or holds a run that differs from the one to resume.
pub fn run(plan: Plan<'_>, events: &(dyn Fn(RunEvent) + Sync)) -> Result<RunSummary, RunError> {
    let selected: HashMap<&str, usize> = (0..).zip(plan.cases).map(|(n, c)| (&*c.id, n)).collect();
    let mut cases: Vec<&Case> = plan.cases.iter().collect();
    let mut first = Vec::new();
    for case in plan.round_trips {
        first.push(selected.get(&*case.id).copied().unwrap_or(cases.len()));
        if !selected.contains_key(&*case.id) {
            cases.push(case);
        }
    }
    let mut resumed = Resumed::default();
    let writer = if plan.resume {
        let (writer, run) =
            RunWriter::resume(plan.folder, &plan.header).map_err(RunError::Folder)?;
        resumed.beside = run.beside;
        for record in run.records {
            let number = selected.get(&*record.case).copied();
            resumed.add(record, number.filter(|n| first.contains(n)));
        }
        writer
    } else {
        RunWriter::create(plan.folder, &plan.header).map_err(RunError::Folder)?
    };
    let ids: HashSet<&str> = match plan.selection {
        Some(ids) => ids.iter().map(String::as_str).collect(),
        None => selected.keys().copied().collect(),
    };
    if let Some(ids) = plan.selection {
        let ids = || ids.iter().map(String::as_str);
        debug_assert_eq!(selection_digest(ids()), plan.header.settings.selection);
        writer.write_cases(ids()).map_err(RunError::Folder)?;
    }
    let shared = Shared {
        cases,
        options: plan.options.clone(),
        budget: plan
            .options
            .within
            .map(|limit| Budget::new(limit, plan.adapters.len(), plan.options.jobs)),
        judge: Judge::default(),
        frames: writer.frames(),
        writer: Mutex::new(writer),
        error: Mutex::new(None),
        stop: plan.stop,
        summary: Mutex::new(resumed.summary),
        truths: Truths::default(),
        quiet: RwLock::new(()),
        pictures: pictured(plan.cases),
        picture_adapter: plan
            .adapters
            .first()
            .map_or_else(String::new, |(l, _)| l.adapter.clone()),
        events,
        drawn: plan.drawn,
    };
    let missing = |adapter: &str| -> Vec<usize> {
        let done = |case: &Case| {
            resumed
                .done
                .contains(&(adapter.to_owned(), case.id.clone()))
        };
        (0..plan.cases.len())
            .filter(|n| !done(&plan.cases[*n]))
            .collect()
    };
    let running = plan.adapters.into_iter().map(|(launch, worker)| {
        let name = &worker.hello.info.name;
        let numbers = missing(name);
        let recorded = resumed.round_trips.get(name).map_or(&[][..], Vec::as_slice);
        let first = to_draw_first(&first, &shared.cases, plan.cases.len(), recorded);
        let examples = resumed.examples.remove(name).unwrap_or_default();
        AdapterQueue::new(numbers, first, launch, worker, plan.expectations).with_examples(examples)
    });
    let dead = plan.dead.into_iter();
    let dead = dead.map(|(adapter, error)| {
        AdapterQueue::not_started(
            missing(&adapter.info.name),
            adapter,
            error,
            plan.expectations,
        )
    });
    let queues: Vec<AdapterQueue> = running.chain(dead).collect();
    let RunOptions {
        jobs, most_jobs, ..
    } = plan.options;
    let spare = most_jobs.saturating_sub(jobs);
    let idle = (spare > 0).then(IdleProcessors::measured).flatten();
    let threads = jobs + if idle.is_some() { spare } else { 0 };
    let begun = AtomicUsize::new(0);
    share(threads, || {
        let idle = match &idle {
            Some(idle) if begun.fetch_add(1, Ordering::Relaxed) >= jobs => Some(idle),
            _ => None,
        };
        while !shared.stopped() {
            match enter_next(&queues, |drawing| {
                idle.is_none_or(|idle| idle.take_room(drawing))
            }) {
                Next::Draw(entered) => WorkerLoop::new(&shared, entered.queue).run(),
                Next::Wait => std::thread::sleep(WAITING),
                Next::End => break,
            }
        }
    });
    finish(plan.folder, &shared, &queues, &ids, resumed.beside)
}

/// Writes what is known only at the end of a run, and sums it up.
fn finish(
    folder: &Path,
    shared: &Shared<'_>,
    queues: &[AdapterQueue],
    ids: &HashSet<&str>,
    mut beside: Vec<Record>,
) -> Result<RunSummary, RunError> {
    if let Some(error) = lock(&shared.error).take() {
        return Err(RunError::Write(error));
    }
    if let Err(error) = lock(&shared.writer).sync() {
        return Err(RunError::Write(error));
    }
    let mut summary = *lock(&shared.summary);
    for queue in queues {
        let (adapter, expectations) = (&queue.adapter, &queue.expectations);
        beside::add(&mut beside, queue.bad_ends.take(adapter, expectations));
        let denials = denials(adapter, expectations).into_iter();
        // The record of a selected case says it already, in this run or in another shard.
        let unselected = denials.filter(|r| !ids.contains(r.case.as_str()));
        beside::add(&mut beside, unselected);
    }
    beside::write(folder, &beside).map_err(RunError::Write)?;
    summary.unexpected += count_unexpected(&beside);
    for queue in queues {
        let Rechecks { done, left } = queue.rechecks();
        summary.rechecks.done += done;
        summary.rechecks.left += left;
    }
    summary.interrupted = shared.stopped() && queues.iter().any(AdapterQueue::is_unfinished);
    Ok(summary)
}

/// Returns the round trips that an adapter draws first. If one has a record, the record's result is used,
/// so that a resumed run has the same records as an uninterrupted one. The record of a driver that did not
/// start is ignored.
fn to_draw_first(
    first: &[usize],
    cases: &[&Case],
    selected: usize,
    recorded: &[(usize, Record)],
) -> LeadingRoundTrips {
    let mut result = LeadingRoundTrips::default();
    for number in first {
        let record = recorded.iter().find(|(n, _)| n == number);
        let record = record.map(|(_, record)| record);
        let started = |r: &&Record| {
            let end = r.process.as_ref().map(|end| end.kind);
            end != Some(LossKind::NotStarted)
        };
        if let Some(record) = record.filter(started) {
            result.known.take(cases[*number], record);
            continue;
        }
        result.cases.push(*number);
        if *number >= selected || record.is_some() {
            result.silent.insert(*number);
        }
    }
    result
}
