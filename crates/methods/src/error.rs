//! Errors in the parameters of a method.

use std::ops::RangeInclusive;
use thiserror::Error;

/// A parameter with which a method cannot draw.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{key}: {message}")]
pub struct ParameterError {
    /// The parameter, as case files name it.
    pub key: String,
    /// The error, and the possible values.
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

/// Refuses a parameter outside its range.
pub(crate) fn within(
    key: &str,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<f64, ParameterError> {
    if range.contains(&value) {
        return Ok(value);
    }
    let message = format!("{} to {} is possible", range.start(), range.end());
    Err(ParameterError::new(key, message))
}
