//! Descriptors of an API as values.

use serde::{Deserialize, Serialize};

/// A value of a descriptor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tree {
    /// A name alone: a variant, `true` or `None`.
    Name(String),
    /// A number, as it was written.
    Number(String),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// Values of one kind.
    List(Vec<Tree>),
    /// Parts without names, behind a name that may be empty.
    Tuple(String, Vec<Tree>),
    /// Parts with names, behind a name that may be empty.
    Structure(String, Vec<(String, Tree)>),
}

impl Tree {
    /// Returns the part of this name.
    pub fn field(&self, name: &str) -> Option<&Tree> {
        match self {
            Self::Structure(_, fields) => {
                let field = fields.iter().find(|(label, _)| label == name);
                field.map(|(_, value)| value)
            }
            _ => None,
        }
    }

    /// Returns the part at this place.
    pub fn part(&self, place: usize) -> Option<&Tree> {
        match self {
            Self::Tuple(_, parts) | Self::List(parts) => parts.get(place),
            _ => None,
        }
    }

    /// Returns the name, the one that stands before parts included.
    pub fn name(&self) -> &str {
        match self {
            Self::Name(name) | Self::Tuple(name, _) | Self::Structure(name, _) => name,
            _ => "",
        }
    }

    /// Returns the value of an option; `None` where it holds none.
    pub fn some(&self) -> Option<&Tree> {
        match self {
            Self::Name(name) if name == "None" => None,
            Self::Tuple(name, parts) if name == "Some" => parts.first(),
            other => Some(other),
        }
    }

    /// Returns the values of a list.
    pub fn list(&self) -> &[Tree] {
        match self {
            Self::List(values) => values,
            _ => &[],
        }
    }
}
