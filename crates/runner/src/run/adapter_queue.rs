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
    /// The indices of cases without a record, in drawing order, except those in `leading`.
    cases: Vec<usize>,
    leading: LeadingRoundTrips,
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
pub(super) struct LeadingRoundTrips {
    /// The cases' indices, in drawing order.
    pub(super) cases: Vec<usize>,
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
        mut cases: Vec<usize>,
        mut leading: LeadingRoundTrips,
        launch: Launch,
        worker: Worker,
        expectations: &Expectations,
    ) -> Self {
        // Without other cases, no one asks for the round trips.
        if cases.is_empty() {
            leading.cases.clear();
        }
        cases.retain(|case| !leading.cases.contains(case));
        let adapter = AdapterRecord::from(&worker);
        Self {
            opening: worker.opening,
            running: Mutex::new(Some(worker)),
            leading,
            ..Self::base(cases, adapter, launch, expectations)
        }
    }

    /// Sets the cases that are already shown in full, by the reason why their failures are expected.
    pub(super) fn with_examples(self, examples: HashMap<String, String>) -> Self {
        self.state().examples = examples;
        self
    }

    /// Returns the queue of an adapter whose driver does not start.
    pub(super) fn not_started(
        cases: Vec<usize>,
        adapter: AdapterRecord,
        error: String,
        expectations: &Expectations,
    ) -> Self {
        // It is never used.
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
            ..Self::base(cases, adapter, launch, expectations)
        }
    }

    fn base(
        cases: Vec<usize>,
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
            cases,
            leading: LeadingRoundTrips::default(),
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
        let untaken = self.cases.len() - *taken;
        let share = untaken / (4 * self.threads.load(Ordering::Relaxed).max(1));
        let chunk = share.clamp(1, CHUNK).min(untaken);
        let cases = self.cases[*taken..*taken + chunk].iter().copied();
        *taken += chunk;
        cases.collect()
    }

    /// Returns the number of cases that get a record, counted at the start of the run.
    pub(super) fn record_count(&self) -> u64 {
        let leading = self.leading.cases.iter();
        (self.cases.len() + leading.filter(|case| self.has_record(**case)).count()) as u64
    }

    /// Returns true if a case gets a record.
    pub(super) fn has_record(&self, case: usize) -> bool {
        !self.leading.silent.contains(&case)
    }

    /// Returns the round trips that are drawn before all other cases.
    pub(super) fn leading(&self) -> &LeadingRoundTrips {
        &self.leading
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
    fn untaken(&self) -> usize {
        let leading = match self.round_trips.get() {
            Some(_) => 0,
            None => self.leading.cases.len(),
        };
        leading + self.cases.len() - *lock(&self.taken)
    }

    /// Returns true if one more thread saves more time than its worker takes to open the adapter. `threads`
    /// already take from the queue.
    fn another_thread_pays(&self, threads: usize) -> bool {
        let Some(begun) = self.state().begun else {
            return false;
        };
        let done = self.written.load(Ordering::Relaxed);
        let seconds_left = time_left(begun.elapsed(), done, self.untaken());
        seconds_left > self.opening.as_secs_f64() * (threads + 1) as f64
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
        let is_first_thread = state.begun.is_none();
        if is_first_thread {
            state.begun = Some(Instant::now());
            state.end = budget.map(Budget::next_end);
        }
        is_first_thread
    }

    /// Returns true if the adapter's time is over.
    pub(super) fn is_late(&self) -> bool {
        self.state().end.is_some_and(|end| Instant::now() >= end)
    }

    /// Counts a written record. After the last record, returns the time that all of them took.
    pub(super) fn record_written(&self) -> Option<Duration> {
        let written = self.written.fetch_add(1, Ordering::Relaxed) + 1;
        let begun = self.state().begun;
        (written == self.record_count()).then(|| begun.map_or(Duration::ZERO, |b| b.elapsed()))
    }

    pub(super) fn is_unfinished(&self) -> bool {
        self.written.load(Ordering::Relaxed) < self.record_count()
    }

    /// Claims a recheck of a bad verdict. At most `limit` of each kind are granted, so that a broken driver does
    /// not double the time of a run. The limits are counts, which do not depend on the machine's speed.
    pub(super) fn claim_recheck(&self, kind: &Symptom, limit: u32) -> bool {
        let mut state = self.state();
        let confirmed = state.confirmed.get(kind).copied().unwrap_or(0);
        let fits = confirmed < limit && state.rechecks.done < u64::from(MAX_RECHECKS);
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

    /// Returns the case whose record shows an expected failure in full; `None` if this case does. The first
    /// case of each reason becomes its example.
    pub(super) fn example_or_insert(&self, reason: &str, case: &str) -> Option<String> {
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

    /// Claims a search for the cases that must precede a case, and counts it even if it is refused.
    pub(super) fn claim_search(&self) -> bool {
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

/// A thread's place at a queue, which it leaves when this is dropped.
pub(super) struct EnteredQueue<'q> {
    pub(super) queue: &'q AdapterQueue,
}

impl Drop for EnteredQueue<'_> {
    fn drop(&mut self) {
        self.queue.threads.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What a free thread does.
pub(super) enum Next<'q> {
    Draw(EnteredQueue<'q>),
    /// It waits, since the threads of the queues will be done before another worker could help them.
    Wait,
    End,
}

/// Chooses what a free thread does, and counts it as a thread of the chosen queue: of the queues with untaken
/// cases, the one with the fewest threads. While cases are left but the thread `may` not draw them beside
/// the number of threads that do, it waits.
pub(super) fn enter_next(queues: &[AdapterQueue], may: impl FnOnce(usize) -> bool) -> Next<'_> {
    let candidates = queues.iter().filter(|queue| queue.untaken() > 0);
    let candidates = candidates.map(|queue| (queue, queue.threads.load(Ordering::Relaxed)));
    let mut candidates = candidates
        .filter(|(queue, threads)| !queue.launch.alone || *threads == 0)
        .peekable();
    if candidates.peek().is_none() {
        return Next::End;
    }
    let useful =
        candidates.filter(|(queue, threads)| *threads == 0 || queue.another_thread_pays(*threads));
    let Some((queue, threads)) = useful.min_by_key(|(_, threads)| *threads) else {
        return Next::Wait;
    };
    let drawing = queues
        .iter()
        .map(|queue| queue.threads.load(Ordering::Relaxed));
    if !may(drawing.sum()) {
        return Next::Wait;
    }
    let entered =
        queue
            .threads
            .compare_exchange(threads, threads + 1, Ordering::Relaxed, Ordering::Relaxed);
    match entered {
        Ok(_) => Next::Draw(EnteredQueue { queue }),
        // Another thread was faster, and may be enough.
        Err(_) => Next::Wait,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn queue(name: &str, cases: usize) -> AdapterQueue {
        let adapter = json!({
            "name": name, "backend": "cpu", "device": "d", "driver": "d", "driver_version": "1",
            "api_version": "1", "software": true,
            "limits": { "api": "vulkan", "sub_pixel_bits": 8, "max_size": 1024,
                "max_color_attachments": 8, "formats": {}, "features": [], "sample_positions": {} },
        });
        let adapter = serde_json::from_value(adapter).expect("the adapter is read");
        let error = String::new();
        let cases = (0..cases).collect();
        AdapterQueue::not_started(cases, adapter, error, &Expectations::default())
    }

    fn entered(next: Next<'_>) -> EnteredQueue<'_> {
        match next {
            Next::Draw(entered) => entered,
            Next::Wait => panic!("the thread waits"),
            Next::End => panic!("the thread ends"),
        }
    }

    #[test]
    fn all_cases_are_taken_once_in_shrinking_chunks() {
        let queue = queue("a", 200);
        let mut chunks = Vec::new();
        loop {
            let chunk = queue.take();
            if chunk.is_empty() {
                break;
            }
            chunks.push(chunk);
        }
        let lengths: Vec<usize> = chunks.iter().map(VecDeque::len).collect();
        assert_eq!((lengths[0], lengths[lengths.len() - 1]), (CHUNK, 1));
        assert!(lengths.is_sorted_by(|a, b| a >= b), "{lengths:?}");
        let cases: Vec<usize> = chunks.into_iter().flatten().collect();
        assert_eq!(cases, (0..200).collect::<Vec<_>>());
    }

    #[test]
    fn a_thread_enters_the_queue_with_the_fewest_threads() {
        let queues = [queue("a", 9), queue("b", 9), queue("empty", 0)];
        let first = entered(enter_next(&queues, |_| true));
        let second = entered(enter_next(&queues, |_| true));
        let names = [&first, &second].map(|entered| entered.queue.launch.adapter.as_str());
        assert_eq!(names, ["a", "b"]);
        assert!(matches!(enter_next(&queues, |_| false), Next::Wait));
        // No queue has begun, so another worker might not pay.
        assert!(matches!(enter_next(&queues, |_| true), Next::Wait));
        drop(second);
        let third = entered(enter_next(&queues, |_| true));
        assert_eq!(third.queue.launch.adapter, "b");
        while !queues.iter().all(|queue| queue.take().is_empty()) {}
        assert!(matches!(enter_next(&queues, |_| false), Next::End));
    }

    #[test]
    fn an_adapter_that_runs_alone_has_one_thread() {
        let mut alone = queue("alone", 9);
        alone.launch.alone = true;
        let queues = [alone];
        let first = entered(enter_next(&queues, |_| true));
        assert!(matches!(enter_next(&queues, |_| true), Next::End));
        drop(first);
        assert!(matches!(enter_next(&queues, |_| true), Next::Draw(_)));
    }

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
