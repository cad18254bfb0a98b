//! The bands that a result can fall out of.

use serde::{Deserialize, Serialize};

/// The bands that a texel can fall out of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Band {
    /// Legal, but outside the yardstick.
    Imprecise,
    /// Outside what the API's text allows.
    Fail,
}
