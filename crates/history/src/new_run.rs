//! A run to add.

use crate::adapter::Adapter;
use crate::frame_times::FrameTimes;
use crate::kind::Kind;
use crate::outcome::Outcome;
use etalon_record::{Labels, Machine};
use std::collections::BTreeMap;

/// A run to add, with everything that the history keeps of it.
#[derive(Clone, Debug, PartialEq)]
pub struct NewRun {
    /// A digest of its content. A run is not added if the history already has its digest.
    pub digest: [u8; 32],
    /// A digest of its header. Runs with the same header are one run that was resumed, and the last one
    /// added counts.
    pub header: [u8; 32],
    /// The run's kind.
    pub kind: Kind,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, if known.
    pub commit: Option<String>,
    /// The machine.
    pub machine: Machine,
    /// When it began, in seconds since 1970.
    pub started: i64,
    /// When the driver was released, in seconds since 1970, if the run is of one release.
    pub released: Option<i64>,
    /// The profile, if known.
    pub profile: Option<String>,
    /// The description of the ruler, if this is a bench.
    pub ruler: Option<String>,
    /// Records or rounds that it lacks.
    pub missing: u64,
    /// The run's labels.
    pub labels: Labels,
    /// The run's adapters.
    pub adapters: Vec<NewAdapter>,
}

/// One adapter of a run to add.
#[derive(Clone, Debug, PartialEq)]
pub struct NewAdapter {
    /// The name that connects its runs. Unlike the name in [`Adapter::info`], it is the same for all releases of one
    /// line.
    pub timeline: String,
    /// The adapter as the run found it.
    pub adapter: Adapter,
    /// The outcomes by case.
    pub outcomes: BTreeMap<String, Outcome>,
    /// The frame times by case.
    pub times: BTreeMap<String, FrameTimes>,
}

impl NewAdapter {
    /// Returns an adapter without records, whose timeline has the adapter's name.
    pub fn new(adapter: Adapter) -> Self {
        Self {
            timeline: adapter.info.name.clone(),
            adapter,
            outcomes: BTreeMap::new(),
            times: BTreeMap::new(),
        }
    }

    /// Adds the outcome of a case. If the case already has an outcome, the worse of the two is kept.
    pub fn take(&mut self, case: String, outcome: Outcome) {
        let rank = |o: &Outcome| (o.unexpected(), o.verdict.severity());
        match self.outcomes.get_mut(&case) {
            Some(before) if rank(before) >= rank(&outcome) => {}
            Some(before) => *before = outcome,
            None => {
                self.outcomes.insert(case, outcome);
            }
        }
    }
}
