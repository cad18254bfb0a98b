//! A run as it is added.

use crate::adapter::Adapter;
use crate::frame_times::FrameTimes;
use crate::kind::Kind;
use crate::labels::Labels;
use crate::outcome::Outcome;
use etalon_record::Machine;
use std::collections::BTreeMap;

/// A run as it is added: all that the history keeps of it.
#[derive(Clone, Debug, PartialEq)]
pub struct NewRun {
    /// A digest of its content. A run whose digest the history has is not added again.
    pub digest: [u8; 32],
    /// A digest of its header. Of runs with the same one, the last added stands for all: it is the same run, resumed.
    pub header: [u8; 32],
    /// Its kind.
    pub kind: Kind,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, where it is known.
    pub commit: Option<String>,
    /// The machine.
    pub machine: Machine,
    /// When it began, in seconds since 1970.
    pub started: i64,
    /// When the driver was released, in seconds since 1970, where the run is of one release.
    pub released: Option<i64>,
    /// The profile, where it is known.
    pub profile: Option<String>,
    /// The description of the ruler, in a bench.
    pub ruler: Option<String>,
    /// Records or rounds that it lacks.
    pub missing: u64,
    /// Its labels.
    pub labels: Labels,
    /// Its adapters.
    pub adapters: Vec<NewAdapter>,
}

/// One adapter of a run as it is added.
#[derive(Clone, Debug, PartialEq)]
pub struct NewAdapter {
    /// The name under which its runs follow each other. Unlike [`Adapter::name`], releases of one line have the same.
    pub timeline: String,
    /// The adapter as the run found it.
    pub adapter: Adapter,
    /// The outcomes by case.
    pub outcomes: BTreeMap<String, Outcome>,
    /// The frame times by case.
    pub times: BTreeMap<String, FrameTimes>,
}

impl NewAdapter {
    /// An adapter without records, whose timeline has its name.
    pub fn new(adapter: Adapter) -> Self {
        Self {
            timeline: adapter.name.clone(),
            adapter,
            outcomes: BTreeMap::new(),
            times: BTreeMap::new(),
        }
    }

    /// Takes the outcome of a case. A run has one record per case and adapter; should it have two, the worse one counts.
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
