//! Triage: a log of entries. The last entry about a subject counts.

use crate::ids::{MachineId, RunId};
use etalon_record::Time;
use std::collections::BTreeMap;
use std::fmt;

/// The state that people assign to a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TriageState {
    /// The change has not been examined.
    New,
    /// The driver changed.
    Real,
    /// The change does not matter, for a reason that the entry gives.
    Ignored,
    /// The change has been fixed.
    Fixed,
}

impl TriageState {
    /// Every state.
    pub const ALL: [Self; 4] = [Self::New, Self::Real, Self::Ignored, Self::Fixed];

    /// Returns the name in commands, in the database and in exports.
    pub fn name(self) -> &'static str {
        match self {
            Self::New => "new",
            Self::Real => "real",
            Self::Ignored => "ignored",
            Self::Fixed => "fixed",
        }
    }

    /// Returns the state with this name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|state| state.name() == name)
    }
}

impl fmt::Display for TriageState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The last entry about each subject.
pub type TriageStates = BTreeMap<TriageSubject, TriageEntry>;

/// The subject of an entry: the verdict of a case, or a step of its frame times.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TriageSubject {
    /// The case's id.
    pub case: String,
    /// The timeline of the adapter.
    pub timeline: String,
    /// The step; `None` if the entry is about the verdict.
    pub step: Option<TimeStep>,
}

/// A step of a series of frame times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TimeStep {
    /// The machine of the series.
    pub machine: MachineId,
    /// The kind of time.
    pub time: Time,
    /// The first run after the step.
    pub run: RunId,
}

/// An entry of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TriageEntry {
    /// When it was made, in seconds since 1970.
    pub at: i64,
    /// The name of its author, or empty.
    pub author: String,
    /// The entry's subject.
    pub subject: TriageSubject,
    /// The state.
    pub state: TriageState,
    /// The reason, or empty.
    pub reason: String,
}
