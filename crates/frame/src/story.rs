//! The story of one texel: the reference's operations on it, step by step.

use serde::{Deserialize, Serialize};
use std::fmt;

/// One operation on one sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoryLine {
    /// The place in the scene: `pass 0, draw 2, primitive 1`.
    pub at: String,
    /// The operation: `depth test`, `blend`, `store`.
    pub operation: String,
    /// Inputs and outcome in words and numbers.
    pub detail: String,
    /// The section of the specification that permits this outcome, where one was applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
}

/// The operations on one sample, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Story {
    /// The operations.
    pub lines: Vec<StoryLine>,
}

impl fmt::Display for Story {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut place = "";
        for line in &self.lines {
            if line.at != place {
                place = &line.at;
                writeln!(f, "{place}")?;
            }
            writeln!(f, "  {}: {}", line.operation, line.detail)?;
            if let Some(citation) = &line.citation {
                writeln!(f, "      [{citation}]")?;
            }
        }
        Ok(())
    }
}
