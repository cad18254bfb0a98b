//! The bands that a result can be outside of.

use serde::{Deserialize, Serialize};

/// The band that a result is outside of, from the mildest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Band {
    /// Legal, but outside the yardstick.
    Imprecise,
    /// Allowed by the API's specification, but not by a contested reading of it.
    Disputed,
    /// Open in the API's specification, but forbidden by a case of the Khronos CTS's mustpass lists.
    RequiredByCts,
    /// Outside what the API's specification allows.
    Fail,
}
