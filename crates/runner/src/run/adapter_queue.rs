//! The queue of one adapter's cases, and the state that its workers share.

use super::budget::Budget;
use super::plan::Rechecks;
use crate::launch::{Launch, START_TIMEOUT};
use crate::supervisor::{BadEnds, FailedStarts};
use crate::sync::lock;
use crate::worker::Worker;
use etalon_diagnose::Symptom;
use etalon_judge::RoundTrips;
use etalon_record::{AdapterRecord, Expectations};
use std::collections::{BTreeSet, HashMap, VecDeque};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock};
use std::time::{Duration, Instant};

/// The maximum number of cases that a thread takes at a time. Neighbouring cases share states that drivers
/// cache, so they should go to the same worker.
const CHUNK: usize = 16;
/// The maximum number of cases of an adapter that are checked again.
const MAX_RECHECKS: u32 = 256;
/// The maximum number of cases of an adapter for which the runner searches the cases that must precede them.
const MAX_SEARCHES: u32 = 8;

/// The queue of one adapter's cases.
pub(super) struct AdapterQueue {
    pub(super) launch: Launch,
    pub(super) adapter: AdapterRecord,
    /// The expectations about the adapter.
    pub(super) expectations: Expectations,
    /// The reason why the driver does not start; if set, nothing is drawn.
    pub(super) start_error: Option<String>,
    pub(super) failed_starts: FailedStarts,
    pub(super) bad_ends: BadEnds,
    /// The indices of cases without a record, in drawing order, except those in `first`.
    numbers: Vec<usize>,
    first: First,
    /// The result of the round trips, once all are drawn.
    round_trips: OnceLock<RoundTrips>,
    taken: Mutex<usize>,
    /// The number of threads that take cases from the queue.
    threads: AtomicUsize,
    /// The worker that was started to discover the adapter, and is still running.
    running: Mutex<Option<Worker>>,
    /// The time that this worker took to open the adapter.
    opening: Duration,
    state: Mutex<QueueState>,
    written: AtomicU64,
}

/// The round trips that are drawn before all other cases.
#[derive(Clone, Debug, Default)]
pub(super) struct First {
    /// The cases' indices, in drawing order.
    pub(super) numbers: Vec<usize>,
    /// The indices of round trips without a record of their own: not selected, or already recorded.
    pub(super) silent: BTreeSet<usize>,
    /// The results of round trips that were drawn before the run was resumed.
    pub(super) known: RoundTrips,
}

/// The state that the workers of an adapter share.
#[derive(Debug, Default)]
pub(super) struct QueueState {
    /// The number of frame files of imprecise cases, by case file.
    pub(super) imprecise_frames: HashMap<String, u32>,
    /// The case that is shown in full, by the reason why its failure is expected.
    examples: HashMap<String, String>,
    /// The number of rechecks that gave the same verdict again, by kind.
    confirmed: HashMap<Symptom, u32>,
    /// The numbers of bad verdicts that were checked again and that were not.
    rechecks: Rechecks,
    searches: u32,
    begun: Option<Instant>,
    /// The time after which no further case is drawn.
    end: Option<Instant>,
}

impl AdapterQueue {
    pub(super) fn new(
        mut numbers: Vec<usize>,
        mut first: First,
        launch: Launch,
        worker: Worker,
        expectations: &Expectations,
    ) -> Self {
        if numbers.is_empty() {
            first.numbers.clear();
        }
        numbers.retain(|number| !first.numbers.contains(number));
        let adapter = AdapterRecord::from(&worker);
        Self {
            opening: worker.opening,
            running: Mutex::new(Some(worker)),
            first,
            ..Self::with(numbers, adapter, launch, expectations)
        }
    }

    /// Sets the cases that are already shown in full, by the reason why their failures are expected.
    pub(super) fn with_examples(self, examples: HashMap<String, String>) -> Self {
        self.state().examples = examples;
        self
    }

    /// Returns the queue of an adapter whose driver does not start.
    pub(super) fn not_started(
        numbers: Vec<usize>,
        adapter: AdapterRecord,
        error: String,
        expectations: &Expectations,
    ) -> Self {
        let launch = Launch {
            adapter: adapter.info.name.clone(),
            program: PathBuf::new(),
            arguments: Vec::new(),
            environment: Vec::new(),
            launcher: None,
            release: None,
            patience: START_TIMEOUT,
            alone: false,
        };
        Self {
            start_error: Some(error),
            ..Self::with(numbers, adapter, launch, expectations)
        }
    }

    fn with(
        numbers: Vec<usize>,
        adapter: AdapterRecord,
        launch: Launch,
        expectations: &Expectations,
    ) -> Self {
        Self {
            launch,
            expectations: expectations.about(&adapter),
            adapter,
            start_error: None,
            failed_starts: FailedStarts::default(),
            bad_ends: BadEnds::default(),
            numbers,
            first: First::default(),
            round_trips: OnceLock::new(),
            taken: Mutex::default(),
            threads: AtomicUsize::new(0),
            running: Mutex::default(),
            opening: Duration::ZERO,
            state: Mutex::default(),
            written: AtomicU64::new(0),
        }
    }

    /// Takes the next cases; empty if all are taken. The number taken shrinks with the number of cases left,
    /// so that all workers end at about the same time.
    pub(super) fn take(&self) -> VecDeque<usize> {
        let mut taken = lock(&self.taken);
        let left = self.numbers.len() - *taken;
        let share = left / (4 * self.threads.load(Ordering::Relaxed).max(1));
        let most = share.clamp(1, CHUNK).min(left);
        let numbers = self.numbers[*taken..*taken + most].iter().copied();
        *taken += most;
        numbers.collect()
    }

    /// Returns the number of cases that get a record, counted at the start of the run.
    pub(super) fn cases(&self) -> u64 {
        let first = self.first.numbers.iter();
        (self.numbers.len() + first.filter(|n| self.records(**n)).count()) as u64
    }

    /// Returns true if a case gets a record.
    pub(super) fn records(&self, number: usize) -> bool {
        !self.first.silent.contains(&number)
    }

    /// Returns the round trips to draw, and the known results of others.
    pub(super) fn first(&self) -> &First {
        &self.first
    }

    /// Returns the result of the round trips. The first thread draws them, and all others wait for it.
    pub(super) fn round_trips_or(&self, draw: impl FnOnce() -> RoundTrips) -> &RoundTrips {
        self.round_trips.get_or_init(draw)
    }

    /// Returns the result of the round trips, once all are drawn.
    pub(super) fn round_trips(&self) -> Option<&RoundTrips> {
        self.round_trips.get()
    }

    /// Returns the number of cases that no thread has taken.
    fn left(&self) -> usize {
        let before = match self.round_trips.get() {
            Some(_) => 0,
            None => self.first.numbers.len(),
        };
        before + self.numbers.len() - *lock(&self.taken)
    }

    /// Returns true if one more thread saves more time than its worker takes to open the adapter. `threads`
    /// already take from the queue.
    fn pays_another(&self, threads: usize) -> bool {
        let Some(begun) = self.state().begun else {
            return false;
        };
        let done = self.written.load(Ordering::Relaxed);
        let left = time_left(begun.elapsed(), done, self.left());
        left > self.opening.as_secs_f64() * (threads + 1) as f64
    }

    /// Takes the worker that was started to discover the adapter.
    pub(super) fn take_running(&self) -> Option<Worker> {
        lock(&self.running).take()
    }

    pub(super) fn state(&self) -> MutexGuard<'_, QueueState> {
        lock(&self.state)
    }

    /// Marks the adapter as begun, and returns true for the first thread.
    pub(super) fn begin(&self, budget: Option<&Budget>) -> bool {
        let mut state = self.state();
        let first = state.begun.is_none();
        if first {
            state.begun = Some(Instant::now());
            state.end = budget.map(Budget::next_end);
        }
        first
    }

    /// Returns true if the adapter's time is over.
    pub(super) fn is_late(&self) -> bool {
        self.state().end.is_some_and(|end| Instant::now() >= end)
    }

    /// Counts a written record. After the last record, returns the time that all of them took.
    pub(super) fn written(&self) -> Option<Duration> {
        let written = self.written.fetch_add(1, Ordering::Relaxed) + 1;
        let begun = self.state().begun;
        (written == self.cases()).then(|| begun.map_or(Duration::ZERO, |b| b.elapsed()))
    }

    pub(super) fn is_unfinished(&self) -> bool {
        self.written.load(Ordering::Relaxed) < self.cases()
    }

    pub(super) fn leave(&self) {
        self.threads.fetch_sub(1, Ordering::Relaxed);
    }

    /// Returns true if a bad verdict must be checked again. Only `most` of each kind are, so that a broken
    /// driver does not double the time of a run. The limits are counts, which do not depend on
    /// the machine's speed.
    pub(super) fn may_recheck(&self, kind: &Symptom, most: u32) -> bool {
        let mut state = self.state();
        let confirmed = state.confirmed.get(kind).copied().unwrap_or(0);
        let fits = confirmed < most && state.rechecks.done < u64::from(MAX_RECHECKS);
        if fits {
            // Counted as confirmed until it is refuted, so that no other worker exceeds the limit in the
            // meantime.
            *state.confirmed.entry(kind.clone()).or_default() += 1;
            state.rechecks.done += 1;
        } else {
            state.rechecks.left += 1;
        }
        fits
    }

    /// Returns the case whose record shows an expected failure in full; `None` if this case does:
    /// the first case of each reason.
    pub(super) fn example(&self, reason: &str, case: &str) -> Option<String> {
        let mut state = self.state();
        if let Some(example) = state.examples.get(reason) {
            return Some(example.clone()).filter(|example| example != case);
        }
        state.examples.insert(reason.to_owned(), case.to_owned());
        None
    }

    /// Records that a recheck gave another verdict, so that further verdicts of its kind are checked.
    pub(super) fn refuted(&self, kind: &Symptom) {
        let mut state = self.state();
        if let Some(confirmed) = state.confirmed.get_mut(kind) {
            *confirmed = confirmed.saturating_sub(1);
        }
    }

    /// Returns the numbers of bad verdicts that were checked again and that were not.
    pub(super) fn rechecks(&self) -> Rechecks {
        self.state().rechecks
    }

    /// Returns true if the cases that must precede a case may be searched.
    pub(super) fn may_search(&self) -> bool {
        let mut state = self.state();
        state.searches += 1;
        state.searches <= MAX_SEARCHES
    }
}

/// Returns the seconds until the cases left are done, if nothing changes. Until the first case is done, the time so
/// far is a part of its time.
fn time_left(elapsed: Duration, done: u64, left: usize) -> f64 {
    elapsed.as_secs_f64() * left as f64 / (done + 1) as f64
}

/// The next action of a free thread.
pub(super) enum Next<'q> {
    Draw(&'q AdapterQueue),
    /// It waits, since the threads of the queues will be done before another worker could help them.
    Wait,
    End,
}

/// Returns what a free thread does: of the queues with cases left, it takes from the one with the fewest
/// threads.
pub(super) fn next(queues: &[AdapterQueue]) -> Next<'_> {
    let open = queues.iter().filter(|queue| queue.left() > 0);
    let open = open.map(|queue| (queue, queue.threads.load(Ordering::Relaxed)));
    let mut open = open
        .filter(|(queue, threads)| !queue.launch.alone || *threads == 0)
        .peekable();
    if open.peek().is_none() {
        return Next::End;
    }
    let useful = open.filter(|(queue, threads)| *threads == 0 || queue.pays_another(*threads));
    let Some((queue, threads)) = useful.min_by_key(|(_, threads)| *threads) else {
        return Next::Wait;
    };
    let entered =
        queue
            .threads
            .compare_exchange(threads, threads + 1, Ordering::Relaxed, Ordering::Relaxed);
    match entered {
        Ok(_) => Next::Draw(queue),
        // Another thread was faster, and may be enough.
        Err(_) => Next::Wait,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimated_time_grows_with_the_first_case_and_shrinks_with_the_last() {
        let after = |ms, done, left| time_left(Duration::from_millis(ms), done, left);
        // Five slow cases: the first one alone shows that the others will take long.
        assert_eq!(after(0, 0, 4), 0.0);
        assert_eq!(after(500, 0, 4), 2.0);
        // A thousand fast cases: many are left, then few.
        assert_eq!(after(100, 99, 900), 0.9);
        assert_eq!(after(990, 989, 10), 0.01);
    }
}
