//! The finding that a failure was matched with.

use crate::signature::Signature;

/// A finding that explains a failure, or seems to.
#[derive(Clone, Debug)]
pub struct Match {
    /// The finding's name.
    pub finding: String,
    /// The bug in one sentence.
    pub title: String,
    /// The case of the finding.
    pub case: String,
    /// The states that are left of the case.
    pub states: Signature,
    /// The difference; `None` if the failure is the same.
    pub beyond: Option<Beyond>,
}

/// The difference between two failures that are alike.
#[derive(Clone, Debug)]
pub struct Beyond {
    /// The states that are not left of the case.
    pub states: Signature,
    /// The violation of the case, where it is another one.
    pub violation: Option<String>,
}

impl Match {
    /// True if case and failure leave the same states, words and violation.
    pub fn is_exact(&self) -> bool {
        self.beyond.is_none()
    }
}
