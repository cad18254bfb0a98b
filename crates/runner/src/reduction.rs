//! Reductions on a driver, with the judge as oracle.
//!
//! A case that crashes or hangs its worker is reduced like one that is drawn wrong: a candidate must end its
//! worker in the same way. Each such candidate costs a process, and each hanging one the time limit.

mod oracle;
mod reducer;
mod smallest;
mod steady;

pub use oracle::{Lost, Unconfirmed, confirm};
pub use reducer::{Looked, Reducer};
pub use smallest::{Smallest, smallest};

use crate::launch::StartError;
use etalon_diagnose::Symptom;
use etalon_record::Record;
use thiserror::Error;

/// An error from reducing a case.
#[derive(Debug, Error)]
pub enum ReductionError {
    /// A worker did not start.
    #[error("{0}")]
    Start(#[from] StartError),
    /// A worker that a case ended did not start again.
    #[error("{0}")]
    Lost(#[from] Lost),
    /// The adapter lacks what the case needs.
    #[error("{adapter} does not support the case")]
    NotSupported {
        /// The name of the adapter.
        adapter: String,
        /// The record, which says what is missing.
        record: Box<Record>,
    },
    /// The case does not fail.
    #[error("{case} does not fail on {adapter}, drawn alone; there is nothing to reduce")]
    Passes {
        /// The id of the case.
        case: String,
        /// The name of the adapter.
        adapter: String,
        /// The record.
        record: Box<Record>,
    },
    /// The case does not fail every time it is drawn, or fails in several ways.
    #[error("{case} is flaky on {adapter}: {flakiness}; only a steady failure can be reduced")]
    Flaky {
        /// The id of the case.
        case: String,
        /// The name of the adapter.
        adapter: String,
        /// The difference between the drawings of the case.
        flakiness: Flakiness,
    },
    /// The reduced case does not fail in a new process as it did before.
    #[error("the reduced case of {case} {why}")]
    Unconfirmed {
        /// The id of the case that was reduced.
        case: String,
        /// The behaviour of the reduced case.
        why: Unconfirmed,
    },
}

/// The difference between repeated drawings of one case.
#[derive(Debug, Error)]
pub enum Flakiness {
    /// The case fails only some of the times.
    #[error("it fails in {failing} of {drawings} drawings, in {processes} processes")]
    Sometimes {
        /// The number of drawings that failed.
        failing: usize,
        /// The number of drawings.
        drawings: usize,
        /// The number of processes.
        processes: usize,
    },
    /// The case fails in two ways.
    #[error("it fails by {0} and by {1}")]
    TwoWays(Box<Symptom>, Box<Symptom>),
}
