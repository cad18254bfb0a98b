//! The error of a build without planted faults.

use thiserror::Error;

/// An adapter's name has a planted fault, and this build has no planted faults.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "adapter {name} cannot be used: `{fault}` is a planted fault, and this build has none; build etalon with \
     `--features faults`"
)]
pub struct NoFaults {
    /// The adapter's name.
    pub name: String,
    /// The fault at the name's end.
    pub fault: String,
}
