//! Finds the position in a file's text to which a path leads.
//!
//! A path counts unrolled list items ([`crate::each`]). It leads to the item that unrolls to them, or to the
//! wrong value in its `each`.

use jsonc_parser::ast::{Array, Object, Value};
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};

/// The key of the values with which an item unrolls.
pub(crate) const EACH: &str = "each";

/// A step of a path into a JSON document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum PathStep {
    Key(String),
    Index(usize),
}

/// A position in a file.
pub(crate) struct Place {
    /// The line, from 1; 0 if the text is not JSON.
    pub(crate) line: usize,
    /// The path in the file as written.
    pub(crate) path: Vec<PathStep>,
    /// The path of the `"$name"` that was replaced by a value of an `each`.
    pub(crate) used: Option<Vec<PathStep>>,
}

impl Place {
    /// Returns the position of the value at a path, or of its nearest existing ancestor.
    pub(crate) fn new(text: &str, path: &[PathStep]) -> Self {
        let parsed = parse_to_ast(text, &CollectOptions::default(), &ParseOptions::default());
        let parsed = parsed.ok().and_then(|parsed| parsed.value);
        let Some(mut value) = parsed.as_ref() else {
            return Self {
                line: 0,
                path: path.to_vec(),
                used: None,
            };
        };
        let mut start = value.start();
        let mut found = Vec::new();
        let mut used = None;
        let mut bound: Vec<Bound> = Vec::new();
        let mut steps = path.iter();
        loop {
            if let Some(index) = bound.iter().position(|b| b.is_named_by(value)) {
                // An item's value can refer to names of the items around it.
                bound.truncate(index + 1);
                let Some(named) = bound.pop() else { break };
                bound.truncate(named.around);
                (start, value) = (named.value.start(), named.value);
                used = used.or(Some(found));
                found = named.path;
                continue;
            }
            let Some(step) = steps.next() else { break };
            let next = match (value, step) {
                (Value::Object(object), PathStep::Key(key)) => {
                    property(object, key).map(|(start, value)| (step.clone(), start, value, 0))
                }
                (Value::Array(list), PathStep::Index(index)) => item(list, *index, &bound)
                    .map(|(index, copy)| (PathStep::Index(index), &list.elements[index], copy))
                    .map(|(step, item, copy)| (step, item.start(), item, copy)),
                _ => None,
            };
            let Some((step, next_start, next, copy)) = next else {
                found.push(step.clone());
                break;
            };
            found.push(step);
            (start, value) = (next_start, next);
            bind(value, copy, &found, &mut bound);
        }
        found.extend(steps.cloned());
        Self {
            line: text[..start].matches('\n').count() + 1,
            path: found,
            used,
        }
    }
}

/// A name in an `each`, and its value in one of the items.
struct Bound<'a> {
    name: &'a str,
    value: &'a Value<'a>,
    path: Vec<PathStep>,
    /// The number of names bound by the enclosing items.
    around: usize,
}

impl Bound<'_> {
    fn is_named_by(&self, value: &Value) -> bool {
        matches!(value, Value::StringLit(text) if text.value.strip_prefix('$') == Some(self.name))
    }
}

/// Returns the start of a property, and its value.
fn property<'a>(object: &'a Object<'a>, key: &str) -> Option<(usize, &'a Value<'a>)> {
    let mut properties = object.properties.iter();
    let found = properties.find(|p| p.name.as_str() == key)?;
    Some((found.start(), &found.value))
}

/// Returns the `each` of a list item.
fn each<'a>(item: &'a Value<'a>) -> Option<&'a Object<'a>> {
    let (_, value) = property(item.as_object()?, EACH)?;
    value.as_object()
}

/// Returns the index, in the list as written, of the item that unrolls to a given item, and the number of the
/// given item among those it unrolls to.
fn item(list: &Array, mut index: usize, bound: &[Bound]) -> Option<(usize, usize)> {
    for (place, item) in list.elements.iter().enumerate() {
        let first = each(item).and_then(|each| each.properties.first());
        let values = first.and_then(|first| values(&first.value, bound));
        // An item with an invalid `each` counts as one item.
        let count = values.map_or(1, |(list, _)| list.elements.len().max(1));
        if index < count {
            return Some((place, index));
        }
        index -= count;
    }
    None
}

/// Returns the list of a name's values, and its path if it comes from an enclosing item.
fn values<'a>(
    value: &'a Value<'a>,
    bound: &[Bound<'a>],
) -> Option<(&'a Array<'a>, Option<Vec<PathStep>>)> {
    match bound.iter().find(|b| b.is_named_by(value)) {
        Some(named) => Some((named.value.as_array()?, Some(named.path.clone()))),
        None => Some((value.as_array()?, None)),
    }
}

/// Binds the names of an item's `each`.
fn bind<'a>(item: &'a Value<'a>, copy: usize, path: &[PathStep], bound: &mut Vec<Bound<'a>>) {
    let around = bound.len();
    for property in each(item).iter().flat_map(|each| &each.properties) {
        let name = property.name.as_str();
        let Some((list, from)) = values(&property.value, &bound[..around]) else {
            continue;
        };
        let Some(value) = list.elements.get(copy) else {
            continue;
        };
        let default_path = || {
            let keys = [EACH, name].map(|key| PathStep::Key(key.to_owned()));
            path.iter().cloned().chain(keys).collect()
        };
        let mut path: Vec<PathStep> = from.unwrap_or_else(default_path);
        path.push(PathStep::Index(copy));
        bound.push(Bound {
            name,
            value,
            path,
            around,
        });
    }
}
