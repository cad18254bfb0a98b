//! The errors of adapters' names that end in a fault.

use thiserror::Error;

/// The end of an adapter's name plants no fault.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FaultNameError {
    /// This build has no planted faults.
    #[error(
        "adapter {name} cannot be used: `{fault}` is a planted fault, and this build has none; build etalon with \
         `--features faults`"
    )]
    Absent {
        /// The adapter's name.
        name: String,
        /// The fault at the name's end.
        fault: String,
    },
    /// No fault has this name.
    #[error("adapter {name} cannot be used: no fault can be planted by `{fault}`: {why}")]
    Unknown {
        /// The adapter's name.
        name: String,
        /// The end of the name.
        fault: String,
        /// What is wrong, with the names that are known.
        why: String,
    },
}
