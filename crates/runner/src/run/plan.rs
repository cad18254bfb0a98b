//! The input and the result of a run.

use crate::drawing::DRAW_TIMEOUT;
use crate::launch::Launch;
use crate::worker::Worker;
use etalon_case::Case;
use etalon_frame::Frame;
use etalon_record::{AdapterRecord, Expectations, Header, Record, RecordError};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use thiserror::Error;

/// The cases and adapters of a run, and the folder that it is written to.
pub struct Plan<'a> {
    /// The cases, each once, in drawing order.
    pub cases: &'a [Case],
    /// The round trips that are drawn first on every adapter, and recorded if they are among the cases:
    /// [`round_trips`](etalon_judge::round_trips) of the selection before sharding.
    pub round_trips: &'a [Case],
    /// All ids selected before sharding, if they must be written to the folder.
    pub selection: Option<&'a [String]>,
    /// Each adapter's launch command, and its running worker.
    pub adapters: Vec<(Launch, Worker)>,
    /// Adapters whose driver does not start, with the error. Each of their cases becomes a `Crash`.
    pub dead: Vec<(AdapterRecord, String)>,
    /// The limits and repetitions of drawing.
    pub options: RunOptions,
    /// The bad verdicts that do not count against the run.
    pub expectations: &'a Expectations,
    /// The run folder, which the run creates or, with `resume`, continues.
    pub folder: &'a Path,
    /// The first line of the run; a run can only be resumed with the same selection and settings.
    pub header: Header,
    /// True to resume the run that the folder holds, false to replace it.
    pub resume: bool,
    /// Set by the caller to stop the run early.
    pub stop: &'a AtomicBool,
    /// Gets the first frame of each drawn case, once, from several threads.
    pub drawn: &'a Drawn<'a>,
}

/// Gets an adapter, a case and its frame.
pub type Drawn<'a> = dyn Fn(&AdapterRecord, &Case, &Frame) + Sync + 'a;

/// The default of [`RunOptions::recheck`].
const DEFAULT_RECHECK: u32 = 4;

/// The numbers of unexpected bad verdicts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rechecks {
    /// Verdicts that were checked again in a fresh process.
    pub done: u64,
    /// Verdicts that were not, because enough of their kind had been confirmed.
    pub left: u64,
}

/// The failures whose complete frames a run folder keeps. The record of a known failure without a frame refers
/// to an example; with `All`, every record has its story and its wrong texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KeptFrames {
    /// Every failure.
    #[default]
    All,
    /// Failures that are not expected, and one example of each known failure on each adapter.
    Examples,
    /// Failures that are not expected.
    New,
    /// No failure.
    None,
}

/// The limits and repetitions of drawing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// The number of workers that draw at the same time; at least one.
    pub jobs: usize,
    /// The number of workers up to which more are started while processors are idle, as they are where drivers wait
    /// for a device.
    pub most_jobs: usize,
    /// The time that a case may take; methods and frame times may take four times as long.
    pub timeout: Duration,
    /// Memory that one worker may use, in MiB.
    pub memory: Option<u64>,
    /// The number of times that each case is drawn, each time after the first in a fresh process; at least
    /// one.
    pub repeat: u32,
    /// The number of unexpected bad verdicts per kind and adapter that are checked again in a fresh process
    /// and confirmed; 0 checks none.
    pub recheck: u32,
    /// The failures whose frames the run folder keeps.
    pub frames: KeptFrames,
    /// The time after which no further case is drawn. Adapters share it equally, and adapters that begin later
    /// also get what others left. The cases left out become `Skipped`.
    pub within: Option<Duration>,
    /// The sizes of frames at which methods are timed besides that of their pictures, by the kind of adapter.
    pub sizes: FrameSizes,
}

/// Sizes of frames, in texels, from small to large.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameSizes {
    /// The sizes on adapters that draw with the processor.
    pub software: Vec<[u32; 2]>,
    /// The sizes on other adapters.
    pub hardware: Vec<[u32; 2]>,
}

impl FrameSizes {
    /// Returns the sizes on an adapter.
    pub fn on(&self, is_software: bool) -> &[[u32; 2]] {
        if is_software {
            &self.software
        } else {
            &self.hardware
        }
    }
}

impl Default for RunOptions {
    fn default() -> Self {
        Self {
            jobs: 1,
            most_jobs: 1,
            timeout: DRAW_TIMEOUT,
            memory: None,
            repeat: 1,
            recheck: DEFAULT_RECHECK,
            frames: KeptFrames::All,
            within: None,
            sizes: FrameSizes::default(),
        }
    }
}

/// The counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunSummary {
    /// Records in the run, including those from before it was resumed.
    pub records: u64,
    /// Records that count against the run.
    pub unexpected: u64,
    /// Verdicts better than the expectations.
    pub improvements: u64,
    /// The numbers of unexpected bad verdicts that were checked again and that were not.
    pub rechecks: Rechecks,
    /// True if the run was stopped before it was complete.
    pub interrupted: bool,
}

impl RunSummary {
    pub(super) fn count(&mut self, record: &Record) {
        self.records += 1;
        self.unexpected += u64::from(record.unexpected());
        self.improvements += u64::from(record.improvement());
    }
}

/// The reason why a run could not be completed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The run folder could not be started; nothing was drawn.
    #[error(transparent)]
    Folder(RecordError),
    /// The run folder can no longer be written to; the records written before are readable.
    #[error("the run is incomplete: {0}")]
    Write(RecordError),
}
