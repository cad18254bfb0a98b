//! Errors in case files, with file, line and key.

use crate::place::{PathStep, Place};
use etalon_frame::shortened;
use std::fmt;
use thiserror::Error;

/// An error in a case file, with its position.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub struct CaseError {
    /// The path of the case file below its folder.
    pub file: String,
    /// The line, from 1; 0 if the error has no line.
    pub line: usize,
    /// The key: `scene.passes[0].draws[1].depth.compare`.
    pub key: String,
    /// The error and, if it helps, the remedy.
    pub message: String,
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        f.write_str(": ")?;
        if !self.key.is_empty() {
            write!(f, "{}: ", shortened(&self.key))?;
        }
        f.write_str(&shortened(&self.message))
    }
}

/// A path into a JSON document, and what is wrong there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct At {
    pub(crate) path: Vec<PathStep>,
    pub(crate) message: String,
}

impl At {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            path: Vec::new(),
            message: message.into(),
        }
    }

    /// Prepends a step to the path.
    pub(crate) fn below(mut self, step: PathStep) -> Self {
        self.path.insert(0, step);
        self
    }

    pub(crate) fn key(self, key: &str) -> Self {
        self.below(PathStep::Key(key.to_owned()))
    }

    pub(crate) fn index(self, index: usize) -> Self {
        self.below(PathStep::Index(index))
    }

    /// Converts an error of typed parsing.
    pub(crate) fn from_typed(error: serde_path_to_error::Error<serde_json::Error>) -> Self {
        use serde_path_to_error::Segment;
        let path = error
            .path()
            .iter()
            .filter_map(|segment| match segment {
                Segment::Seq { index } => Some(PathStep::Index(*index)),
                Segment::Map { key } => Some(PathStep::Key(key.clone())),
                Segment::Enum { .. } | Segment::Unknown => None,
            })
            .collect();
        let message = error.into_inner().to_string();
        // serde_json appends a position that is correct only for whole files.
        let message = match message.rfind(" at line ") {
            Some(end) => message[..end].to_owned(),
            None => message,
        };
        Self { path, message }
    }

    /// Adds file and line.
    pub(crate) fn locate(self, file: &str, text: &str) -> CaseError {
        let place = Place::new(text, &self.path);
        CaseError {
            file: file.to_owned(),
            line: place.line,
            key: key_of(&place.path),
            message: match place.used {
                Some(used) => format!("{} (used at {})", self.message, key_of(&used)),
                None => self.message,
            },
        }
    }
}

/// Returns a path as text: `scene.passes[0].draws`.
fn key_of(path: &[PathStep]) -> String {
    let mut key = String::new();
    for step in path {
        match step {
            PathStep::Key(name) if key.is_empty() => key.push_str(name),
            PathStep::Key(name) => {
                key.push('.');
                key.push_str(name);
            }
            PathStep::Index(i) => key.push_str(&format!("[{i}]")),
        }
    }
    key
}
