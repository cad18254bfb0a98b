//! The grade of a finding: how strong its evidence is.

use crate::verdict::Verdict;
use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// How strong the evidence of a finding is.
    Grade: array {
        /// The API's specification forbids it.
        Proven = "proven",
        /// The specification is open, but a case of the Khronos CTS's mustpass lists is not.
        RequiredByCts = "required-by-cts",
        /// Only a contested reading of the specification forbids it.
        Disputed = "disputed",
        /// Not yet compared with the specification.
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
