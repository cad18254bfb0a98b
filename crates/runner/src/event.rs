//! The events of a run.

use etalon_record::Record;
use std::time::Duration;

/// An event of a run, reported as it happens.
#[derive(Clone, Debug)]
pub enum RunEvent {
    /// The first case of an adapter is about to be drawn.
    AdapterStarted {
        /// The adapter.
        adapter: String,
        /// The number of cases that it will draw.
        cases: u64,
    },
    /// A record was written.
    Recorded(Box<Record>),
    /// All records of an adapter are written.
    AdapterFinished {
        /// The adapter.
        adapter: String,
        /// Wall time since it started.
        wall: Duration,
    },
}
