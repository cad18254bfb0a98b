//! A case that shows a planted bug, or accuses an innocent.

use crate::verdict::Verdict;
use etalon_frame::WrongTexel;
use serde::{Deserialize, Serialize};

/// The first case that failed, or the first imprecise one if none failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sighting {
    /// The case's id.
    pub case: String,
    /// `Fail` or `Imprecise`; `InternalError` if the case could not be drawn.
    pub verdict: Verdict,
    /// The first texel outside the legal set or the yardstick.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texel: Option<WrongTexel>,
    /// The error if the case could not be drawn; empty otherwise.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub message: String,
}
