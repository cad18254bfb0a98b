//! A whole run: every selected case on every adapter, one record each.

mod again;
mod column;
mod lane;

use crate::event::Event;
use crate::measure::Truths;
use crate::process::{Launch, Worker};
use crate::verdict::Judge;
use column::Column;
use etalon_case::Case;
use etalon_record::{
    AdapterRecord, Expectations, Header, Record, RecordError, RunWriter, selection_digest,
};
use lane::Lane;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, RwLock};
use std::thread;
use std::time::Duration;
use thiserror::Error;

/// What to run.
pub struct Plan<'a> {
    /// The cases, each once, in the order in which they are drawn.
    pub cases: &'a [Case],
    /// All ids that were selected before sharding, where they are to be written down.
    pub selection: Option<&'a [String]>,
    /// How to start each adapter again, and the worker that is already up.
    pub adapters: Vec<(Launch, Worker)>,
    /// Adapters whose driver does not start, and how it ended: each of their cases is a Crash.
    pub dead: Vec<(AdapterRecord, String)>,
    /// How cases are drawn.
    pub options: Options,
    /// What is known to go wrong.
    pub expectations: &'a Expectations,
    /// Where the run is written.
    pub folder: &'a Path,
    /// Its first line.
    pub header: Header,
    /// Whether to go on with the run that the folder holds, instead of a new one in its place.
    pub resume: bool,
    /// Set from outside when the run is to end early.
    pub stop: &'a AtomicBool,
}

/// How cases are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// How many workers draw at the same time; at least one.
    pub jobs: usize,
    /// How long a case may take; methods and frame times four times that.
    pub timeout: Duration,
    /// MiB of memory that one worker may hold.
    pub memory: Option<u64>,
    /// How often each case is drawn, each time but the first in a fresh process; at least once.
    pub repeat: u32,
    /// Whether a bad verdict that nobody expected is looked at again in a fresh process.
    pub look_again: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            jobs: 1,
            timeout: crate::process::DRAW_TIMEOUT,
            memory: None,
            repeat: 1,
            look_again: true,
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// Records in the run, those from before it was resumed among them.
    pub records: u64,
    /// Records that speak against the run.
    pub unexpected: u64,
    /// Verdicts better than the expectations.
    pub improvements: u64,
    /// Whether it was stopped from outside before it was complete.
    pub interrupted: bool,
}

impl Outcome {
    fn count(&mut self, record: &Record) {
        self.records += 1;
        self.unexpected += u64::from(record.unexpected());
        self.improvements += u64::from(record.improvement());
    }
}

/// Why a run could not be completed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The run folder cannot be begun; nothing was run.
    #[error(transparent)]
    Folder(RecordError),
    /// The run folder can no longer be written to; what was written is readable.
    #[error("the run is incomplete: {0}")]
    Write(RecordError),
}

/// What all lanes share.
struct Shared<'a> {
    cases: &'a [Case],
    options: Options,
    expectations: &'a Expectations,
    judge: Judge,
    writer: Mutex<RunWriter>,
    error: Mutex<Option<RecordError>>,
    /// Set from outside.
    stop: &'a AtomicBool,
    outcome: Mutex<Outcome>,
    truths: Truths,
    /// Held for writing by who times frames, for reading by who draws and judges.
    quiet: RwLock<()>,
    /// Numbers of the method cases whose pictures are kept, and the adapter that they are taken from.
    pictures: HashSet<usize>,
    painter: String,
    events: &'a (dyn Fn(Event) + Sync),
}

impl Shared<'_> {
    /// Whether no more is to be drawn.
    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || lock(&self.error).is_some()
    }

    /// The run cannot go on.
    fn give_up(&self, error: RecordError) {
        lock(&self.error).get_or_insert(error);
    }
}

/// Runs every case on every adapter. Events come from several threads.
///
/// # Errors
/// When the run folder cannot be written to, or holds another run than the one to go on with.
pub fn run(plan: Plan<'_>, events: &(dyn Fn(Event) + Sync)) -> Result<Outcome, RunError> {
    let mut outcome = Outcome::default();
    let mut done: HashSet<(String, String)> = HashSet::new();
    let writer = if plan.resume {
        let (writer, run) =
            RunWriter::resume(plan.folder, &plan.header).map_err(RunError::Folder)?;
        for record in run.records {
            outcome.count(&record);
            done.insert((record.adapter, record.case));
        }
        writer
    } else {
        RunWriter::create(plan.folder, &plan.header).map_err(RunError::Folder)?
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
        outcome: Mutex::new(outcome),
        truths: Truths::default(),
        quiet: RwLock::new(()),
        pictures: in_the_middle(plan.cases),
        painter: plan
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
    let up = plan.adapters.into_iter().map(|(launch, worker)| {
        let numbers = missing(&worker.hello.info.name);
        Column::new(numbers, launch, worker)
    });
    let dead = plan.dead.into_iter();
    let dead = dead.map(|(adapter, how)| Column::dead(missing(&adapter.name), adapter, how));
    let columns: Vec<Column> = up.chain(dead).collect();
    thread::scope(|scope| {
        for _ in 0..plan.options.jobs.max(1) {
            scope.spawn(|| {
                while !shared.stopped()
                    && let Some(column) = column::next(&columns)
                {
                    Lane::new(&shared, column).run();
                    column.leave();
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
    let mut outcome = *lock(&shared.outcome);
    outcome.interrupted = shared.stopped() && columns.iter().any(Column::is_unfinished);
    Ok(outcome)
}

/// Of each method's cases in a scene the one in the middle of its parameter's range: the one whose
/// picture is kept.
fn in_the_middle(cases: &[Case]) -> HashSet<usize> {
    type Family<'a> = (&'a str, &'a str, &'a str);
    let mut families: BTreeMap<Family<'_>, Vec<(f64, &str, usize)>> = BTreeMap::new();
    for (number, case) in cases.iter().enumerate() {
        if let Some(method) = &case.method {
            let family = (&*method.question, &*method.scene, &*method.name);
            let value = method.parameter.as_ref().map_or(0.0, |p| p.value);
            families
                .entry(family)
                .or_default()
                .push((value, &case.id, number));
        }
    }
    // The id decides between equal values, whatever order the cases are drawn in.
    let middle = |mut all: Vec<(f64, &str, usize)>| {
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(b.1)));
        all.get(all.len() / 2).map(|(_, _, number)| *number)
    };
    families.into_values().filter_map(middle).collect()
}

/// The record form of an adapter.
pub(crate) fn adapter_record(worker: &Worker) -> AdapterRecord {
    let info = &worker.hello.info;
    AdapterRecord {
        name: info.name.clone(),
        backend: info.backend.clone(),
        device: info.device.clone(),
        driver: info.driver.clone(),
        driver_version: info.driver_version.clone(),
        driver_id: info.driver_id.clone(),
        api_version: info.api_version.clone(),
        software: info.software,
        limits: worker.hello.limits.clone(),
    }
}

impl From<&Worker> for AdapterRecord {
    fn from(worker: &Worker) -> Self {
        adapter_record(worker)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
