//! The state of a driver's shader cache.

use serde::{Deserialize, Serialize};

/// The contents of a driver's shader cache on disk when a run or bench began.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShaderCache {
    /// Nothing: it was put into an empty folder, or switched off.
    Cold,
    /// The shaders of earlier runs.
    Warm,
}

impl ShaderCache {
    /// The word in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cold => "cold",
            Self::Warm => "warm",
        }
    }
}
