//! The reason why a file is no scene.

use etalon_methods::ParameterError;

/// A part of a file that cannot be read, or cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct ModelError {
    /// The part: `node 3 (lamp), mesh 1, primitive 0`.
    pub place: String,
    /// What is wrong with it, and the remedy.
    pub message: String,
}

impl ModelError {
    pub(crate) fn new(place: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            message: message.into(),
        }
    }

    /// Puts the enclosing part before the place.
    pub(crate) fn within(self, place: &str) -> Self {
        Self {
            place: format!("{place}, {}", self.place),
            ..self
        }
    }
}

impl From<ParameterError> for ModelError {
    fn from(error: ParameterError) -> Self {
        Self::new(error.key, error.message)
    }
}

/// Returns a part's kind, index and name.
pub(crate) fn part(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {index} ({name})"),
        None => format!("{kind} {index}"),
    }
}
