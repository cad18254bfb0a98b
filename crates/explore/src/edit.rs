//! Edits of a document: values that are replaced, and keys or items that are removed.
//!
//! An edit is data, so that thousands of them cost nothing until they are tried.

use serde_json::Value;

/// A step into a document.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum EditStep {
    Key(String),
    Item(usize),
}

/// The steps from a document to one of its values.
pub(crate) type Pointer = Vec<EditStep>;

/// Several changes that are made together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Edit {
    /// New values, by pointer. The last step can be a new key.
    pub(crate) replace: Vec<(Pointer, Value)>,
    /// Keys and items that are removed, after all replacements. Pointers refer to the document before the edit.
    pub(crate) remove: Vec<Pointer>,
}

/// Makes a pointer from keys and numbers: `pointer!["passes", 0, "draws"]`.
macro_rules! pointer {
    ($($step:expr),* $(,)?) => {
        vec![$($crate::edit::EditStep::from($step)),*]
    };
}
pub(crate) use pointer;

impl From<&str> for EditStep {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for EditStep {
    fn from(index: usize) -> Self {
        Self::Item(index)
    }
}

/// Returns a pointer extended by a step.
pub(crate) fn below(pointer: &[EditStep], step: impl Into<EditStep>) -> Pointer {
    let mut below = pointer.to_vec();
    below.push(step.into());
    below
}

/// Returns the value at a pointer.
pub(crate) fn value_at<'v>(value: &'v Value, pointer: &[EditStep]) -> Option<&'v Value> {
    pointer.iter().try_fold(value, |value, step| match step {
        EditStep::Key(key) => value.get(key),
        EditStep::Item(index) => value.get(index),
    })
}

fn value_at_mut<'v>(value: &'v mut Value, pointer: &[EditStep]) -> Option<&'v mut Value> {
    pointer.iter().try_fold(value, |value, step| match step {
        EditStep::Key(key) => value.get_mut(key),
        EditStep::Item(index) => value.get_mut(index),
    })
}

impl Edit {
    /// Returns an edit that removes the value at a pointer.
    pub(crate) fn removal(pointer: Pointer) -> Self {
        Self {
            replace: Vec::new(),
            remove: vec![pointer],
        }
    }

    /// Returns an edit that replaces one value.
    pub(crate) fn replacement(pointer: Pointer, value: impl Into<Value>) -> Self {
        Self {
            replace: vec![(pointer, value.into())],
            remove: Vec::new(),
        }
    }

    /// Returns the edited document; `None` if a pointer leads nowhere or nothing changes.
    pub(crate) fn apply(&self, document: &Value) -> Option<Value> {
        let mut edited = document.clone();
        for (pointer, value) in &self.replace {
            let (last, parent) = pointer.split_last()?;
            let parent = value_at_mut(&mut edited, parent)?;
            match (last, parent) {
                (EditStep::Key(key), Value::Object(map)) => {
                    map.insert(key.clone(), value.clone());
                }
                (EditStep::Item(index), Value::Array(list)) => {
                    *list.get_mut(*index)? = value.clone();
                }
                _ => return None,
            }
        }
        // Later items of a list are removed first, so that the paths of the others stay valid.
        let mut remove = self.remove.clone();
        remove.sort_unstable();
        remove.dedup();
        for pointer in remove.iter().rev() {
            let (last, parent) = pointer.split_last()?;
            match (last, value_at_mut(&mut edited, parent)?) {
                (EditStep::Key(key), Value::Object(map)) => {
                    map.remove(key)?;
                }
                (EditStep::Item(index), Value::Array(list)) if *index < list.len() => {
                    list.remove(*index);
                }
                _ => return None,
            }
        }
        (edited != *document).then_some(edited)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn items_are_removed_by_their_pointers_before_the_edit() {
        let document = json!({ "a": [0, 1, 2, 3], "b": { "c": 1 } });
        let edit = Edit {
            replace: vec![(pointer!["a", 3], json!(9)), (pointer!["b", "d"], json!(2))],
            remove: vec![pointer!["a", 0], pointer!["a", 2], pointer!["b", "c"]],
        };
        let expected = json!({ "a": [1, 9], "b": { "d": 2 } });
        assert_eq!(edit.apply(&document), Some(expected));
    }

    #[test]
    fn an_edit_that_does_not_fit_or_changes_nothing_gives_nothing() {
        let document = json!({ "a": [0] });
        assert_eq!(Edit::removal(pointer!["a", 1]).apply(&document), None);
        assert_eq!(Edit::removal(pointer!["b"]).apply(&document), None);
        assert_eq!(
            Edit::replacement(pointer!["a", 0], 0).apply(&document),
            None
        );
        assert_eq!(
            Edit::replacement(pointer!["a", "b"], 0).apply(&document),
            None
        );
    }
}
