//! The times of a round.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The times of a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Time {
    /// A frame until the device was done.
    Wall,
    /// A frame until the last call that submits work returned.
    Cpu,
    /// A frame between GPU timestamps.
    Gpu,
    /// Reading a frame back.
    ReadBack,
    /// Preparing the scene.
    Prepare,
    /// The first frame after preparing.
    First,
}

impl Time {
    /// Every time.
    pub const ALL: [Self; 6] = [
        Self::Wall,
        Self::Cpu,
        Self::Gpu,
        Self::ReadBack,
        Self::Prepare,
        Self::First,
    ];

    /// The word in records and reports: `read-back`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
            Self::ReadBack => "read-back",
            Self::Prepare => "prepare",
            Self::First => "first",
        }
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
