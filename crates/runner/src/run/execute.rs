//! Execution of a plan: the folder, the shared state and the threads.

use super::adapter_queue::{self, AdapterQueue};
use super::pictures::pictured;
use super::plan::{Plan, RunError, RunSummary};
use super::shared::Shared;
use super::worker_loop::WorkerLoop;
use crate::event::Event;
use crate::judge::Judge;
use crate::measure::Truths;
use crate::sync::lock;
use etalon_case::Case;
use etalon_record::{RunWriter, selection_digest};
use std::collections::HashSet;
use std::sync::{Mutex, RwLock};
use std::thread;

/// Runs every case on every adapter. Events come from several threads.
///
/// # Errors
/// When the run folder cannot be written to, or holds another run than the one to resume.
pub fn run(plan: Plan<'_>, events: &(dyn Fn(Event) + Sync)) -> Result<RunSummary, RunError> {
    let mut summary = RunSummary::default();
    let mut done: HashSet<(String, String)> = HashSet::new();
    let writer = if plan.resume {
        let (writer, run) =
            RunWriter::resume(plan.folder, &plan.header).map_err(RunError::Folder)?;
        for record in run.records {
            summary.count(&record);
            done.insert((record.adapter, record.case));
        }
        writer
    } else {
        RunWriter::replace(plan.folder, &plan.header, plan.reports).map_err(RunError::Folder)?
    };
    if let Some(ids) = plan.selection {
        let ids = || ids.iter().map(String::as_str);
        debug_assert_eq!(selection_digest(ids()), plan.header.settings.selection);
        writer.write_cases(ids()).map_err(RunError::Folder)?;
    }
    let shared = Shared {
        cases: plan.cases,
        options: plan.options,
        expectations: plan.expectations,
        judge: Judge::default(),
        writer: Mutex::new(writer),
        error: Mutex::new(None),
        stop: plan.stop,
        summary: Mutex::new(summary),
        truths: Truths::default(),
        quiet: RwLock::new(()),
        pictures: pictured(plan.cases),
        picture_adapter: plan
            .adapters
            .first()
            .map_or_else(String::new, |(l, _)| l.adapter.clone()),
        events,
    };
    let missing = |adapter: &str| -> Vec<usize> {
        let done = |case: &Case| done.contains(&(adapter.to_owned(), case.id.clone()));
        (0..plan.cases.len())
            .filter(|n| !done(&plan.cases[*n]))
            .collect()
    };
    let running = plan.adapters.into_iter().map(|(launch, worker)| {
        let numbers = missing(&worker.hello.info.name);
        AdapterQueue::new(numbers, launch, worker)
    });
    let dead = plan.dead.into_iter();
    let dead = dead
        .map(|(adapter, error)| AdapterQueue::not_started(missing(&adapter.name), adapter, error));
    let queues: Vec<AdapterQueue> = running.chain(dead).collect();
    thread::scope(|scope| {
        for _ in 0..plan.options.jobs.max(1) {
            scope.spawn(|| {
                while !shared.stopped()
                    && let Some(queue) = adapter_queue::next(&queues)
                {
                    WorkerLoop::new(&shared, queue).run();
                    queue.leave();
                }
            });
        }
    });
    if let Some(error) = lock(&shared.error).take() {
        return Err(RunError::Write(error));
    }
    if let Err(error) = lock(&shared.writer).sync() {
        return Err(RunError::Write(error));
    }
    let mut summary = *lock(&shared.summary);
    summary.interrupted = shared.stopped() && queues.iter().any(AdapterQueue::is_unfinished);
    Ok(summary)
}
