//! The origin of what a command recorded.

use crate::machine::Machine;
use serde::{Deserialize, Serialize};

/// The suite, machine, time and command that made a file. In files, its keys stand among those of the header.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// The suite's version.
    pub etalon: String,
    /// The commit that the suite was built from, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The machine on which the command ran.
    pub machine: Machine,
    /// When the command began, RFC 3339 in UTC.
    pub started: String,
    /// The command line, program first.
    pub command: Vec<String>,
}
