//! The bands that a result can fall out of.

use serde::{Deserialize, Serialize};

/// Which of the two bands a texel fell out of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Band {
    /// Legal, but outside the yardstick.
    Imprecise,
    /// Outside what the API's text allows.
    Fail,
}
