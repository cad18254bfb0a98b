//! The runs of a history and their adapters.

use crate::adapter::Adapter;
use crate::ids::{MachineId, RunId};
use crate::kind::Kind;
use crate::labels::Labels;
use crate::time::format_time;
use etalon_record::Machine;
use std::rc::Rc;

/// A run of a history.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunInfo {
    /// Its number in this file.
    pub id: RunId,
    /// The digest of its content, by which a run is the same in every file.
    pub digest: [u8; 32],
    /// Its kind.
    pub kind: Kind,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, where it is known.
    pub commit: Option<String>,
    /// The number of its machine.
    pub machine: MachineId,
    /// When it began, in seconds since 1970.
    pub started: i64,
    /// When the driver was released, in seconds since 1970, where the run is of one release.
    pub released: Option<i64>,
    /// The profile, where it is known.
    pub profile: Option<String>,
    /// The description of the ruler, in a bench. Times of rulers with different ones do not compare.
    pub ruler: Option<String>,
    /// Records or rounds that it lacks.
    pub missing: u64,
    /// Its labels.
    pub labels: Labels,
    /// The run that stands for this one, which was added before it was resumed.
    pub resumed: Option<RunId>,
}

impl RunInfo {
    /// The time at which it stands in the history, in seconds since 1970: the release of the driver, else when it began.
    pub fn time(&self) -> i64 {
        self.released.unwrap_or(self.started)
    }

    /// The day on which it began, or its driver was released: `2026-01-31`.
    pub fn day(&self) -> String {
        format_time(self.time()).chars().take(10).collect()
    }

    /// True if it has all of these labels.
    pub fn has_labels(&self, labels: &Labels) -> bool {
        labels
            .iter()
            .all(|(key, value)| self.labels.get(key) == Some(value))
    }

    /// The digest as text.
    pub fn digest_text(&self) -> String {
        self.digest.iter().map(|b| format!("{b:02x}")).collect()
    }
}

/// One adapter of a run.
#[derive(Clone, Debug)]
pub struct AdapterRun {
    /// The run.
    pub run: RunId,
    /// The name under which runs of the adapter follow each other.
    pub timeline: Rc<str>,
    /// The run's machine.
    pub machine: MachineId,
    /// The adapter as the run found it.
    pub adapter: Rc<Adapter>,
    /// Its records.
    pub records: u32,
    pub(crate) chain: u32,
    pub(crate) state: u32,
    pub(crate) drawn: u32,
}

impl AdapterRun {
    /// True if the two have the same outcomes of the same cases.
    pub fn is_same(&self, other: &Self) -> bool {
        self.state == other.state
    }
}

/// The machines of a history, by their numbers.
pub(crate) type Machines = std::collections::BTreeMap<u32, Machine>;
