//! The grade of a finding: how its accusation is known.

use crate::verdict::Verdict;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// How the accusation of a finding is known.
    Grade: array {
        /// A must of the API's text.
        Proven = "proven",
        /// The text is open; a case of the Khronos CTS's mustpass lists is not.
        RequiredByCts = "required-by-cts",
        /// A contested reading of the text.
        Disputed = "disputed",
        /// Nobody has read the text for it yet.
        Unread = "unread",
    }
}

impl Grade {
    /// The verdict of a finding that names none.
    pub fn verdict(self) -> Verdict {
        match self {
            Self::Proven | Self::Unread => Verdict::Fail,
            Self::RequiredByCts => Verdict::RequiredByCts,
            Self::Disputed => Verdict::Disputed,
        }
    }
}
