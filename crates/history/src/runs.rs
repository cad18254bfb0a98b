//! The runs of a history and their adapters.

use crate::adapter::Adapter;
use crate::ids::{MachineId, RunId};
use crate::kind::Kind;
use crate::time::format_time;
use etalon_record::{Labels, Machine};
use std::rc::Rc;

/// A run of a history.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunInfo {
    /// The run's number in this file.
    pub id: RunId,
    /// The digest of its content, which identifies the run in every file.
    pub digest: [u8; 32],
    /// The run's kind.
    pub kind: Kind,
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, if known.
    pub commit: Option<String>,
    /// The number of its machine.
    pub machine: MachineId,
    /// When the run began, in seconds since 1970.
    pub started: i64,
    /// When the driver was released, in seconds since 1970, if the run is of one release.
    pub released: Option<i64>,
    /// The profile, if known.
    pub profile: Option<String>,
    /// The description of the ruler, if this is a bench. Times of benches with different rulers cannot be
    /// compared.
    pub ruler: Option<String>,
    /// Records or rounds that it lacks.
    pub missing: u64,
    /// The run's labels.
    pub labels: Labels,
    /// The later run with the same header that replaces this one, because it resumed it.
    pub resumed: Option<RunId>,
}

impl RunInfo {
    /// Returns the time of the run in the history, in seconds since 1970: when the driver was released, or
    /// else when the run began.
    pub fn time(&self) -> i64 {
        self.released.unwrap_or(self.started)
    }

    /// Returns the day of [`RunInfo::time`]: `2026-01-31`.
    pub fn day(&self) -> String {
        format_time(self.time()).chars().take(10).collect()
    }

    /// Returns true if it has all these labels.
    pub fn has_labels(&self, labels: &Labels) -> bool {
        labels
            .iter()
            .all(|(key, value)| self.labels.get(key) == Some(value))
    }

    /// Returns the digest in hexadecimal.
    pub fn digest_text(&self) -> String {
        self.digest.iter().map(|b| format!("{b:02x}")).collect()
    }
}

/// One adapter of a run.
#[derive(Clone, Debug)]
pub struct AdapterRun {
    /// The run.
    pub run: RunId,
    /// The name that connects the runs of the adapter.
    pub timeline: Rc<str>,
    /// The run's machine.
    pub machine: MachineId,
    /// The adapter as the run found it.
    pub adapter: Rc<Adapter>,
    /// The number of its records.
    pub records: u32,
    pub(crate) chain: u32,
    pub(crate) state: u32,
    pub(crate) drawn: u32,
}

impl AdapterRun {
    /// Returns true if both have the same outcomes for the same cases.
    pub fn is_same(&self, other: &Self) -> bool {
        self.state == other.state
    }
}

/// The machines of a history, by their numbers.
pub(crate) type Machines = std::collections::BTreeMap<u32, Machine>;
