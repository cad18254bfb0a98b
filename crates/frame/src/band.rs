//! The bands that a result can fall out of.

use serde::{Deserialize, Serialize};

/// The bands that a texel can fall out of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Band {
    /// Legal, but outside the yardstick.
    Imprecise,
    /// Allowed by the API's text, but not by a contested reading of it.
    Disputed,
    /// Open in the API's text, but forbidden by a case of the Khronos CTS's mustpass lists.
    RequiredByCts,
    /// Outside what the API's text allows.
    Fail,
}
