//! The data of a comparison of two runs, which `etalon diff --format json` prints in its serialised form.
//! Arrays of two are always before and after.

use etalon_frame::Aspect;
use etalon_record::{Record, Verdict};
use serde::Serialize;
use serde_json::Value;

/// The comparison of two runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RunDiff {
    /// `runs`, which distinguishes it from a comparison of benches.
    pub kind: &'static str,
    /// Reasons why the comparison can mislead: incomplete runs, other selections, other machines.
    pub warnings: Vec<String>,
    /// The undecided rest of the comparison: missing records, unknown selections, unreadable frames.
    pub untold: Vec<String>,
    /// For each run that is empty or incomplete, the reason.
    pub incomplete: Vec<String>,
    /// The headers side by side.
    pub facts: Vec<Fact>,
    /// Adapters without a counterpart.
    pub unpaired: Vec<Unpaired>,
    /// Each adapter of the first run that has a counterpart in the second.
    pub pairs: Vec<AdapterPair>,
    /// Cases that changed, in the order worse, better, other, and within each group the most serious first.
    pub changes: Vec<CaseChange>,
    /// Cases of paired adapters that only one run has.
    pub only: Vec<Only>,
    /// Seconds of drawing by adapter and area, as a rough indication only.
    pub times: Vec<AreaTime>,
    /// Frame times of methods that both runs have.
    pub methods: Vec<MethodTime>,
}

impl RunDiff {
    /// Returns true if anything is worse.
    pub fn worse(&self) -> bool {
        self.count(ChangeDirection::Worse) > 0
            || self.lost() > 0
            || self.vanished().next().is_some()
    }

    /// Returns the adapters of the first run that the second lacks.
    pub fn vanished(&self) -> impl Iterator<Item = &Unpaired> {
        self.unpaired.iter().filter(|u| u.worse)
    }

    /// Returns true if something is better and nothing worse.
    pub fn only_better(&self) -> bool {
        !self.worse() && self.count(ChangeDirection::Better) > 0
    }

    /// Returns the number of changes in this direction.
    pub fn count(&self, direction: ChangeDirection) -> u64 {
        let these = self.changes.iter().filter(|c| c.direction == direction);
        these.count() as u64
    }

    /// Returns the number of cases that the second run should have drawn but that have no record there.
    pub fn lost(&self) -> u64 {
        self.only.iter().filter(|o| o.worse).count() as u64
    }

    /// Returns the number of compared pairs of records.
    pub fn compared(&self) -> u64 {
        self.pairs.iter().map(|p| p.compared).sum()
    }
}

/// The direction of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ChangeDirection {
    /// Worse.
    Worse,
    /// Better.
    Better,
    /// Neither worse nor better.
    Other,
}

impl ChangeDirection {
    /// All directions, in the order of reports.
    pub const ALL: [Self; 3] = [Self::Worse, Self::Better, Self::Other];

    /// Returns the direction's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Worse => "worse",
            Self::Better => "better",
            Self::Other => "other",
        }
    }
}

impl From<etalon_record::Change> for ChangeDirection {
    fn from(change: etalon_record::Change) -> Self {
        match change {
            etalon_record::Change::Worse => Self::Worse,
            etalon_record::Change::Better => Self::Better,
            etalon_record::Change::Other | etalon_record::Change::Same => Self::Other,
        }
    }
}

/// One of the two runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunSide {
    /// The first run.
    Before,
    /// The second run.
    After,
}

/// A fact that both runs state.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fact {
    /// The name: `driver`, `commit`.
    pub name: &'static str,
    /// The value in the first run.
    pub before: String,
    /// The value in the second run.
    pub after: String,
}

impl Fact {
    /// Returns true if the runs differ in this fact.
    pub fn differs(&self) -> bool {
        self.before != self.after
    }
}

/// An adapter without a partner.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unpaired {
    /// The run that has the adapter.
    pub side: RunSide,
    /// The adapter's name.
    pub adapter: String,
    /// The number of the adapter's records.
    pub records: u64,
    /// True if the adapter has records in the first run and is missing from the second.
    pub worse: bool,
}

/// Two adapters that are compared.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AdapterPair {
    /// The adapter of the first run, and its counterpart in the second.
    pub adapter: [String; 2],
    /// The facts of both adapters, side by side.
    pub facts: Vec<Fact>,
    /// Record pairs that were compared.
    pub compared: u64,
    /// The number of compared pairs that are equal except for times.
    pub same: u64,
    /// The number of worse records.
    pub worse: u64,
    /// The number of better records.
    pub better: u64,
    /// The number of records that differ and are neither worse nor better.
    pub other: u64,
    /// For each of the two adapters, the number of cases with a record on this adapter only.
    pub only: [u64; 2],
    /// Changes of verdicts, the most frequent first.
    pub transitions: Vec<Transition>,
    /// The fraction of channels with an assertion, over the records of each run; 0 to 1.
    pub asserted: [f64; 2],
    #[serde(skip)]
    channels: [[u64; 2]; 2],
}

impl AdapterPair {
    pub(super) fn new(adapter: [&str; 2], facts: Vec<Fact>) -> Self {
        Self {
            adapter: adapter.map(str::to_owned),
            facts,
            ..Self::default()
        }
    }

    /// Adds two records of a case to the sums.
    pub(super) fn add(&mut self, both: &[&Record; 2]) {
        self.compared += 1;
        for (side, record) in both.iter().enumerate() {
            let [asserted, channels] = &mut self.channels[side];
            for a in &record.assertions {
                *asserted = asserted.saturating_add(a.asserted);
                *channels = channels.saturating_add(a.channels);
            }
            if *channels > 0 {
                self.asserted[side] = *asserted as f64 / *channels as f64;
            }
        }
        let verdict = both.map(|r| r.verdict);
        if verdict[0] == verdict[1] {
            return;
        }
        match self.transitions.iter_mut().find(|t| t.verdict == verdict) {
            Some(transition) => transition.records += 1,
            None => self.transitions.push(Transition {
                verdict,
                records: 1,
            }),
        }
        self.transitions
            .sort_by_key(|t| (std::cmp::Reverse(t.records), t.verdict));
    }

    pub(super) fn count(&mut self, direction: ChangeDirection) {
        match direction {
            ChangeDirection::Worse => self.worse += 1,
            ChangeDirection::Better => self.better += 1,
            ChangeDirection::Other => self.other += 1,
        }
    }

    /// Returns the name if both adapters have the same, else both names.
    pub fn name(&self) -> String {
        both_names(&self.adapter)
    }
}

pub(super) fn both_names([before, after]: &[String; 2]) -> String {
    if before == after {
        before.clone()
    } else {
        format!("{before} → {after}")
    }
}

/// Records with the same change of verdict.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Transition {
    /// The verdict in the first run, and in the second.
    pub verdict: [Verdict; 2],
    /// The number of record pairs of two adapters with this change.
    pub records: u64,
}

/// A case whose records differ in more than their times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseChange {
    /// The case's id.
    pub case: String,
    /// The case's id without axis values.
    pub case_file: String,
    /// The adapter's name in the first run, and in the second.
    pub adapter: [String; 2],
    /// Worse, better or other: what the change of verdict and expectation means.
    pub direction: ChangeDirection,
    /// The parts that differ: `verdict`, `expectation`, `frame`, and the kinds of [`Detail::what`].
    pub what: Vec<&'static str>,
    /// The verdict in the first run, and in the second.
    pub verdict: [Verdict; 2],
    /// True for each record that is unexpected.
    pub unexpected: [bool; 2],
    /// The most informative line of each record.
    pub headline: [String; 2],
    /// Figures that differ, by kind and name.
    pub details: Vec<Detail>,
    /// The frames, if both runs keep one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<FrameChange>,
    /// The reason why the frames could not be compared, if both records name one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_error: Option<String>,
}

/// A figure of a record that differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Detail {
    /// The kind: `texels` (how many are wrong, imprecise, open), `wrong` (which), `accuracy` (distance from
    /// the yardstick's middle in codes), `counters`, `distance` (from the truth), `cost` (passes, draws,
    /// fragments, bytes), `process`, `repeats`, `order`, `validation`.
    pub what: &'static str,
    /// The figure within the kind: `wrong`, `color mean`.
    pub name: String,
    /// The value before; null if the record has none.
    pub before: Value,
    /// The value after; null if the record has none.
    pub after: Value,
}

/// Two frames of a case.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FrameChange {
    /// The frame files below their run folders.
    pub files: [String; 2],
    /// Images that both frames have.
    pub images: Vec<ImageChange>,
    /// Images that only one frame has, or that differ in size or format.
    pub unlike: Vec<String>,
}

impl FrameChange {
    /// True if all codes are equal.
    pub fn equal(&self) -> bool {
        self.unlike.is_empty() && self.images.iter().all(|i| i.differ == 0)
    }
}

/// One image of two frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ImageChange {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// The aspect that was read; depth and stencil of one attachment are two images.
    pub aspect: Aspect,
    /// The number of samples that the image has in each frame.
    pub samples: u64,
    /// The number of samples with a code that differs in any channel.
    pub differ: u64,
    /// The largest distance in any channel, in codes (for floats, in units in the last place).
    pub largest: u64,
}

/// A case that only one run has a record of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Only {
    /// The case's id.
    pub case: String,
    /// The case's id without axis values.
    pub case_file: String,
    /// The adapter that has the record.
    pub adapter: String,
    /// The run that has the record.
    pub side: RunSide,
    /// The record's verdict.
    pub verdict: Verdict,
    /// True if the second run should have the record and lacks it.
    pub worse: bool,
}

/// Seconds that an area's cases take to prepare, draw and read back. Each case is timed once, while other
/// work is in progress.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AreaTime {
    /// The adapter in each run.
    pub adapter: [String; 2],
    /// The first part of the cases' ids: `depth`.
    pub area: String,
    /// The number of cases that were drawn in both runs.
    pub cases: u64,
    /// The sum of the cases' seconds, per run.
    pub sum: [f64; 2],
    /// The median of the cases' seconds, per run.
    pub median: [f64; 2],
}

/// Frame times of a method: medians in seconds, measured while nothing else was drawn or judged.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodTime {
    /// The case's id.
    pub case: String,
    /// The adapter in each run.
    pub adapter: [String; 2],
    /// The time until the device was done.
    pub wall: [f64; 2],
    /// The time between GPU timestamps, if both runs have them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gpu: Option<[f64; 2]>,
    /// The number of timed frames.
    pub samples: [u32; 2],
}
