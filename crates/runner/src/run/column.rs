//! One adapter's cases, and what its workers have in common.

use super::{adapter_record, lock};
use crate::process::{Launch, Worker};
use etalon_record::{AdapterRecord, Verdict};
use std::collections::{HashMap, VecDeque};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// After so many vain starts in a row an adapter's other cases are not tried.
pub(super) const MAX_VAIN_STARTS: u32 = 3;
/// The most cases that a worker takes at a time: neighbours share states that drivers keep.
const CHUNK: usize = 16;
/// The most cases of an adapter that are looked at again, and of those that timed out.
const LOOKS: u32 = 256;
const LOOKS_AT_TIMEOUTS: u32 = 8;
/// For the most cases of an adapter it is sought what must be drawn before.
const SEARCHES: u32 = 8;

/// An adapter on its way through the cases.
pub(super) struct Column {
    pub(super) launch: Launch,
    pub(super) adapter: AdapterRecord,
    /// Why its driver does not start; then nothing is drawn.
    pub(super) dead: Option<String>,
    /// Numbers of the cases that have no record, in drawing order.
    numbers: Vec<usize>,
    taken: Mutex<usize>,
    /// Lanes that draw from it.
    lanes: AtomicUsize,
    /// The worker that discovery left.
    ready: Mutex<Option<Worker>>,
    state: Mutex<State>,
    written: AtomicU64,
}

/// What the workers of an adapter have in common.
#[derive(Debug, Default)]
pub(super) struct State {
    /// Starts in a row that failed.
    pub(super) vain_starts: u32,
    /// Why the last one did.
    pub(super) last_words: String,
    /// Frame files of imprecise cases, by case file.
    pub(super) imprecise_frames: HashMap<String, u32>,
    looks: u32,
    looks_at_timeouts: u32,
    searches: u32,
    begun: Option<Instant>,
}

impl Column {
    pub(super) fn new(numbers: Vec<usize>, launch: Launch, worker: Worker) -> Self {
        let adapter = adapter_record(&worker);
        Self {
            ready: Mutex::new(Some(worker)),
            ..Self::with(numbers, adapter, launch)
        }
    }

    /// An adapter whose driver does not start.
    pub(super) fn dead(numbers: Vec<usize>, adapter: AdapterRecord, how: String) -> Self {
        let launch = Launch {
            adapter: adapter.name.clone(),
            program: PathBuf::new(),
            arguments: Vec::new(),
            environment: Vec::new(),
        };
        Self {
            dead: Some(how),
            ..Self::with(numbers, adapter, launch)
        }
    }

    fn with(numbers: Vec<usize>, adapter: AdapterRecord, launch: Launch) -> Self {
        Self {
            launch,
            adapter,
            dead: None,
            numbers,
            taken: Mutex::default(),
            lanes: AtomicUsize::new(0),
            ready: Mutex::default(),
            state: Mutex::default(),
            written: AtomicU64::new(0),
        }
    }

    /// The next cases for a worker; none when all are taken. The fewer are left the fewer they are, so
    /// that all workers end at the same time.
    pub(super) fn take(&self) -> VecDeque<usize> {
        let mut taken = lock(&self.taken);
        let left = self.numbers.len() - *taken;
        let share = left / (4 * self.lanes.load(Ordering::Relaxed).max(1));
        let most = share.clamp(1, CHUNK).min(left);
        let numbers = self.numbers[*taken..*taken + most].iter().copied();
        *taken += most;
        numbers.collect()
    }

    /// How many cases it began with.
    pub(super) fn cases(&self) -> u64 {
        self.numbers.len() as u64
    }

    /// The worker that is already up, for whom comes first.
    pub(super) fn ready(&self) -> Option<Worker> {
        lock(&self.ready).take()
    }

    pub(super) fn state(&self) -> std::sync::MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Whether this is the first lane.
    pub(super) fn begin(&self) -> bool {
        let mut state = self.state();
        let first = state.begun.is_none();
        state.begun.get_or_insert_with(Instant::now);
        first
    }

    /// Counts a record; gives the time that all took when it was the last one.
    pub(super) fn written(&self) -> Option<Duration> {
        let written = self.written.fetch_add(1, Ordering::Relaxed) + 1;
        let begun = self.state().begun;
        (written == self.cases()).then(|| begun.map_or(Duration::ZERO, |b| b.elapsed()))
    }

    pub(super) fn is_unfinished(&self) -> bool {
        self.written.load(Ordering::Relaxed) < self.cases()
    }

    pub(super) fn leave(&self) {
        self.lanes.fetch_sub(1, Ordering::Relaxed);
    }

    /// Whether a bad verdict may be looked at again: a broken driver must not double a run.
    pub(super) fn may_look_again(&self, verdict: Verdict) -> bool {
        let mut state = self.state();
        let timeouts = u32::from(verdict == Verdict::Timeout);
        let fits = state.looks < LOOKS && state.looks_at_timeouts + timeouts <= LOOKS_AT_TIMEOUTS;
        if fits {
            state.looks += 1;
            state.looks_at_timeouts += timeouts;
        }
        fits
    }

    /// Whether it may be sought what a case must be drawn after.
    pub(super) fn may_search(&self) -> bool {
        let mut state = self.state();
        state.searches += 1;
        state.searches <= SEARCHES
    }
}

/// The adapter that a lane draws on next: one that has cases left, and the fewest lanes.
pub(super) fn next(columns: &[Column]) -> Option<&Column> {
    // Two that choose at the same time may choose the same; then both draw from it.
    let open = columns.iter().filter(|c| *lock(&c.taken) < c.numbers.len());
    let column = open.min_by_key(|c| c.lanes.load(Ordering::Relaxed))?;
    column.lanes.fetch_add(1, Ordering::Relaxed);
    Some(column)
}
