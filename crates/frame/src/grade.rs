//! Grades of the evidence that a value is forbidden.

use crate::band::Band;
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The evidence that a specification forbids a value, from the weakest.
    Grade: array {
        /// A contested reading: the specification contradicts itself, or its versions contradict each other.
        Disputed = "disputed",
        /// The specification leaves the value open, but a case on the Khronos CTS's mustpass lists does not.
        RequiredByCts = "required-by-cts",
        /// A "must" in the specification.
        Proven = "proven",
    }
}

impl Grade {
    /// Returns the band of a value that only evidence of this grade or a weaker one forbids.
    pub fn band(self) -> Band {
        match self {
            Self::Disputed => Band::Disputed,
            Self::RequiredByCts => Band::RequiredByCts,
            Self::Proven => Band::Fail,
        }
    }
}
