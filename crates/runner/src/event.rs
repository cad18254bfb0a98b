//! What happens during a run, as it happens.

use etalon_record::Record;
use std::time::Duration;

/// One thing that happened.
#[derive(Clone, Debug)]
pub enum Event {
    /// An adapter's first case is about to be drawn.
    AdapterStarted {
        /// The adapter.
        adapter: String,
        /// How many cases it will draw.
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
