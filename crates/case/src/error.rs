//! Errors in case files, with file, line and key.

use etalon_frame::shortened;
use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use std::fmt;
use thiserror::Error;

/// An error in a case file, with its place.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub struct CaseError {
    /// The file.
    pub file: String,
    /// The line, from 1; 0 where no line can be named.
    pub line: usize,
    /// The key: `scene.passes[0].draws[1].depth.compare`.
    pub key: String,
    /// The error and, where it helps, the remedy.
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

/// A step of a path into a JSON document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    Key(String),
    Index(usize),
}

/// A path into a JSON document, and what is wrong there.
#[derive(Clone, Debug)]
pub(crate) struct At {
    pub(crate) path: Vec<Step>,
    pub(crate) message: String,
}

impl At {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            path: Vec::new(),
            message: message.into(),
        }
    }

    /// Puts a step before the path.
    pub(crate) fn below(mut self, step: Step) -> Self {
        self.path.insert(0, step);
        self
    }

    pub(crate) fn key(self, key: &str) -> Self {
        self.below(Step::Key(key.to_owned()))
    }

    pub(crate) fn index(self, index: usize) -> Self {
        self.below(Step::Index(index))
    }

    /// From an error of typed parsing.
    pub(crate) fn from_typed(error: serde_path_to_error::Error<serde_json::Error>) -> Self {
        use serde_path_to_error::Segment;
        let path = error
            .path()
            .iter()
            .filter_map(|segment| match segment {
                Segment::Seq { index } => Some(Step::Index(*index)),
                Segment::Map { key } => Some(Step::Key(key.clone())),
                Segment::Enum { .. } | Segment::Unknown => None,
            })
            .collect();
        let message = error.into_inner().to_string();
        // serde_json appends a position that is only right for whole files.
        let message = match message.rfind(" at line ") {
            Some(end) => message[..end].to_owned(),
            None => message,
        };
        Self { path, message }
    }

    /// The path as text: `scene.passes[0].draws`.
    pub(crate) fn place(&self) -> String {
        let mut key = String::new();
        for step in &self.path {
            match step {
                Step::Key(name) if key.is_empty() => key.push_str(name),
                Step::Key(name) => {
                    key.push('.');
                    key.push_str(name);
                }
                Step::Index(i) => key.push_str(&format!("[{i}]")),
            }
        }
        key
    }

    /// With file and line.
    pub(crate) fn locate(self, file: &str, text: &str) -> CaseError {
        CaseError {
            file: file.to_owned(),
            line: line_of(text, &self.path),
            key: self.place(),
            message: self.message,
        }
    }
}

/// The line on which the value at a path starts, or as near above it as the path leads.
fn line_of(text: &str, path: &[Step]) -> usize {
    let Ok(parsed) = jsonc_parser::parse_to_ast(
        text,
        &jsonc_parser::CollectOptions::default(),
        &jsonc_parser::ParseOptions::default(),
    ) else {
        return 0;
    };
    let Some(mut value) = parsed.value.as_ref() else {
        return 0;
    };
    let mut start = value.range().start;
    for step in path {
        value = match (value, step) {
            (ast::Value::Object(object), Step::Key(key)) => {
                let found = object
                    .properties
                    .iter()
                    .find(|p| p.name.as_str() == key.as_str());
                let Some(property) = found else { break };
                start = property.range.start;
                &property.value
            }
            (ast::Value::Array(array), Step::Index(i)) => {
                let Some(element) = array.elements.get(*i) else {
                    break;
                };
                start = element.range().start;
                element
            }
            _ => break,
        };
    }
    text[..start].matches('\n').count() + 1
}
