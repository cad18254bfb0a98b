//! The recorded calls that a program needs.

use crate::error::BundleError;
use etalon_backend::{Argument, Call, Recording, Tree};
use std::collections::{HashMap, HashSet};

/// Returns the values of a descriptor, or the error that a call cannot be printed.
pub(super) fn field<'a>(value: &'a Tree, name: &str) -> Result<&'a Tree, BundleError> {
    value
        .field(name)
        .ok_or_else(|| BundleError::Call(format!("{name} of {}", value.name())))
}

/// Returns a part of a value.
pub(super) fn part(value: &Tree, place: usize) -> Result<&Tree, BundleError> {
    value
        .part(place)
        .ok_or_else(|| BundleError::Call(format!("part {place} of {}", value.name())))
}

/// Returns the digits of a number, which no program reads as anything else.
pub(super) fn digits(value: &Tree) -> Result<&str, BundleError> {
    match value {
        Tree::Number(number)
            if number.starts_with(|c: char| c.is_ascii_digit() || c == '-')
                && number.parse::<f64>().is_ok_and(f64::is_finite) =>
        {
            Ok(number)
        }
        _ => Err(BundleError::Call("a number that is none".to_owned())),
    }
}

/// Returns a name of letters, digits and hyphens: of a variant, or of a text.
pub(super) fn word(value: &Tree) -> Result<&str, BundleError> {
    let word = match value {
        Tree::Text(text) => text,
        value => value.name(),
    };
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !word.is_empty() && word.chars().all(plain) {
        Ok(word)
    } else {
        Err(BundleError::Call(word.to_owned()))
    }
}

/// Returns the names of flags.
pub(super) fn flags(value: &Tree) -> Result<Vec<&str>, BundleError> {
    let Tree::Text(text) = value else {
        return Err(BundleError::Call("flags that are none".to_owned()));
    };
    let names = text
        .split('|')
        .map(str::trim)
        .filter(|name| !name.is_empty());
    let plain = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    names
        .map(|name| {
            if name.chars().all(plain) {
                Ok(name)
            } else {
                Err(BundleError::Call(name.to_owned()))
            }
        })
        .collect()
}

/// Returns the number of an object.
pub(super) fn object(value: &Tree) -> Option<u64> {
    match value {
        Tree::Tuple(name, parts) if name == "PointerId" => match parts.first() {
            Some(Tree::Number(number)) => number.parse().ok(),
            _ => None,
        },
        _ => None,
    }
}

/// The variables of objects.
#[derive(Default)]
pub(super) struct Objects {
    names: HashMap<(&'static str, u64), String>,
    counts: HashMap<&'static str, u32>,
}

impl Objects {
    /// Returns a new variable for an object.
    pub(super) fn define(&mut self, kind: &'static str, id: &Tree) -> Result<String, BundleError> {
        let number = object(id).ok_or_else(|| BundleError::Call(kind.to_owned()))?;
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        let name = format!("{kind}_{count}");
        self.names.insert((kind, number), name.clone());
        Ok(name)
    }

    /// Returns the variable of an object.
    pub(super) fn name(&self, kind: &'static str, id: &Tree) -> Result<&str, BundleError> {
        let number = object(id).ok_or_else(|| BundleError::Call(kind.to_owned()))?;
        let name = self.names.get(&(kind, number));
        name.map(String::as_str)
            .ok_or_else(|| BundleError::Unknown {
                function: kind.to_owned(),
                kind: kind.to_owned(),
                number,
            })
    }
}

/// Returns the object that a call makes.
fn made(action: &Tree) -> Option<u64> {
    let made = action.name().starts_with("Create");
    let id = action.field("id").or_else(|| action.part(0));
    id.filter(|_| made).and_then(object)
}

fn collect(value: &Tree, into: &mut HashSet<u64>) {
    into.extend(object(value));
    match value {
        Tree::Tuple(_, parts) | Tree::List(parts) => {
            parts.iter().for_each(|part| collect(part, into));
        }
        Tree::Structure(_, fields) => fields.iter().for_each(|(_, value)| collect(value, into)),
        _ => {}
    }
}

/// Returns the calls that a program makes: those that make what no other call uses, and that end objects, are left out.
pub(super) fn needed(recording: &Recording) -> Vec<&Tree> {
    let mut used = HashSet::new();
    let mut calls = Vec::new();
    for call in recording.calls.iter().rev() {
        let [Argument::Tree(action)] = call.arguments.as_slice() else {
            continue;
        };
        if action.name().starts_with("Drop") {
            continue;
        }
        if made(action).is_some_and(|made| !used.remove(&made)) {
            continue;
        }
        collect(action, &mut used);
        calls.push(action);
    }
    calls.reverse();
    calls
}

/// A memory that is filled from the mapped buffer.
pub(super) struct Memory {
    /// True if the bytes are bits: four to a texel in two images.
    pub(super) bits: bool,
    /// The parts: offset, distance between rows, bytes of a row, rows.
    pub(super) parts: Vec<[u64; 4]>,
}

impl Memory {
    /// Returns an expression for the bytes of the memory. `bytes` is an expression for the mapped ones.
    pub(super) fn expression(&self, bytes: &str) -> String {
        let part = |[offset, pitch, row, rows]: &[u64; 4]| {
            format!("rows({bytes}, {offset}, {pitch}, {row}, {rows})")
        };
        let parts: Vec<String> = self.parts.iter().map(part).collect();
        let parts = parts.join(", ");
        if self.bits {
            format!("bits({parts})")
        } else {
            parts
        }
    }
}

/// Returns the memories in their order.
pub(super) fn memories(recording: &Recording) -> Vec<Memory> {
    let number = |argument: &Argument| match argument {
        Argument::Offset(number) => *number,
        Argument::Unsigned(number) => u64::from(*number),
        _ => 0,
    };
    let is_read = |call: &&Call| call.function.starts_with("read_");
    let memory = |call: &Call| Memory {
        bits: call.function == "read_bits",
        parts: call
            .arguments
            .chunks_exact(4)
            .map(|p| [number(&p[0]), number(&p[1]), number(&p[2]), number(&p[3])])
            .collect(),
    };
    recording.calls.iter().filter(is_read).map(memory).collect()
}
