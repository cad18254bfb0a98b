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
    /// The states of the reduced case.
    pub states: Signature,
    /// The difference; `None` if the failure is the same.
    pub difference: Option<Difference>,
}

/// The difference between two similar failures.
#[derive(Clone, Debug)]
pub struct Difference {
    /// The states of the failure that the reduced case lacks.
    pub states: Signature,
    /// The violation of the case, if it differs.
    pub violation: Option<String>,
}

impl Match {
    /// Returns true if the reduced case and failure have the same states, words and violation.
    pub fn is_exact(&self) -> bool {
        self.difference.is_none()
    }
}
