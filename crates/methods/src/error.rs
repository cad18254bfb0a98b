//! Errors in the parameters of a method.

use thiserror::Error;

/// A parameter that a method cannot draw with.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{key}: {message}")]
pub struct ParameterError {
    /// The parameter, as case files name it.
    pub key: String,
    /// What is wrong with it, and what would be right.
    pub message: String,
}

impl ParameterError {
    pub(crate) fn new(key: &str, message: impl Into<String>) -> Self {
        Self {
            key: key.to_owned(),
            message: message.into(),
        }
    }
}
