//! The state that all threads of a run share.

use super::budget::Budget;
use super::plan::{Drawn, RunOptions, RunSummary};
use crate::event::RunEvent;
use crate::sync::lock;
use etalon_case::Case;
use etalon_judge::{Judge, Truths};
use etalon_record::{FrameWriter, RecordError, RunWriter};
use std::collections::HashSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, RwLock};

/// The state that all threads of a run share.
pub(super) struct Shared<'a> {
    /// The cases of the run, followed by the round trips that are not among them.
    pub(super) cases: Vec<&'a Case>,
    pub(super) options: RunOptions,
    /// The time left, if the run has a time limit.
    pub(super) budget: Option<Budget>,
    pub(super) judge: Judge,
    pub(super) writer: Mutex<RunWriter>,
    pub(super) frames: FrameWriter,
    /// The error that ended the run.
    pub(super) error: Mutex<Option<RecordError>>,
    /// Set by the caller to stop the run.
    pub(super) stop: &'a AtomicBool,
    pub(super) summary: Mutex<RunSummary>,
    pub(super) truths: Truths,
    /// Locked for reading while a thread draws or judges, and for writing while a thread times frames, so
    /// that no other load disturbs the timing.
    pub(super) quiet: RwLock<()>,
    /// The indices of the method cases whose pictures are kept.
    pub(super) pictures: HashSet<usize>,
    /// The adapter whose pictures are kept.
    pub(super) picture_adapter: String,
    pub(super) events: &'a (dyn Fn(RunEvent) + Sync),
    pub(super) drawn: &'a Drawn<'a>,
}

impl Shared<'_> {
    /// Returns true if no more cases must be drawn.
    pub(super) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || lock(&self.error).is_some()
    }

    /// Ends the run with an error. Only the first error is kept.
    pub(super) fn fail(&self, error: RecordError) {
        lock(&self.error).get_or_insert(error);
    }
}
