//! The machine of a run, bench or hunt.

use serde::{Deserialize, Serialize};

/// A machine, without anything that identifies its owner.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// The operating system and its version.
    pub os: String,
    /// The processor as it names itself.
    pub cpu: String,
    /// Logical processors that the process may use.
    pub cores: u32,
}
