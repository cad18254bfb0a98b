//! The grade of a finding: how strong its evidence is.

use crate::verdict::Verdict;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The strength of a finding's evidence.
    Grade: array {
        /// The API's specification forbids the behaviour.
        Proven = "proven",
        /// The specification permits the behaviour, but a case on the Khronos CTS's mustpass lists does not.
        RequiredByCts = "required-by-cts",
        /// Only a contested reading of the specification forbids the behaviour.
        Disputed = "disputed",
        /// The behaviour has not been compared with the specification yet.
        Unread = "unread",
    }
}

impl Grade {
    /// Returns the verdict of a finding that names none.
    pub fn verdict(self) -> Verdict {
        match self {
            Self::Proven | Self::Unread => Verdict::Fail,
            Self::RequiredByCts => Verdict::RequiredByCts,
            Self::Disputed => Verdict::Disputed,
        }
    }
}
