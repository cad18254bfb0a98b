//! The evidence behind a permission: how it is known that a value is forbidden.

use crate::band::Band;
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The evidence that a text forbids a value, from the weakest.
    Grade: array {
        /// A contested reading: the text contradicts itself, or versions of it do.
        Disputed = "disputed",
        /// The text is open, and a case of the Khronos CTS's mustpass lists is not.
        RequiredByCts = "required-by-cts",
        /// A must of the text.
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
