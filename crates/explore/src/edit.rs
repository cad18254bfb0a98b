//! Edits of a document: values that are replaced, and keys or items that are removed.
//!
//! An edit is data, so that thousands of them cost nothing until they are tried.

use serde_json::Value;

/// A step into a document.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Step {
    Key(String),
    Item(usize),
}

/// The path of a value in a document.
pub(crate) type Place = Vec<Step>;

/// Several changes that are made together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Edit {
    /// New values, by path. The last step can be a new key.
    pub(crate) replace: Vec<(Place, Value)>,
    /// Keys and items that are removed, after all replacements. Paths refer to the document before the edit.
    pub(crate) remove: Vec<Place>,
}

/// Makes a path of keys and numbers: `place!["passes", 0, "draws"]`.
macro_rules! place {
    ($($step:expr),* $(,)?) => {
        vec![$($crate::edit::Step::from($step)),*]
    };
}
pub(crate) use place;

impl From<&str> for Step {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for Step {
    fn from(index: usize) -> Self {
        Self::Item(index)
    }
}

/// Returns a path extended by a step.
pub(crate) fn below(place: &[Step], step: impl Into<Step>) -> Place {
    let mut below = place.to_vec();
    below.push(step.into());
    below
}

/// Returns the value at a path.
pub(crate) fn at<'v>(value: &'v Value, place: &[Step]) -> Option<&'v Value> {
    place.iter().try_fold(value, |value, step| match step {
        Step::Key(key) => value.get(key),
        Step::Item(index) => value.get(index),
    })
}

fn at_mut<'v>(value: &'v mut Value, place: &[Step]) -> Option<&'v mut Value> {
    place.iter().try_fold(value, |value, step| match step {
        Step::Key(key) => value.get_mut(key),
        Step::Item(index) => value.get_mut(index),
    })
}

impl Edit {
    /// Returns an edit that removes the value at a path.
    pub(crate) fn removal(place: Place) -> Self {
        Self {
            replace: Vec::new(),
            remove: vec![place],
        }
    }

    /// Returns an edit that replaces one value.
    pub(crate) fn replacement(place: Place, value: impl Into<Value>) -> Self {
        Self {
            replace: vec![(place, value.into())],
            remove: Vec::new(),
        }
    }

    /// Returns the edited document; `None` if a path does not exist or nothing changes.
    pub(crate) fn apply(&self, document: &Value) -> Option<Value> {
        let mut edited = document.clone();
        for (place, value) in &self.replace {
            let (last, parent) = place.split_last()?;
            let parent = at_mut(&mut edited, parent)?;
            match (last, parent) {
                (Step::Key(key), Value::Object(map)) => {
                    map.insert(key.clone(), value.clone());
                }
                (Step::Item(index), Value::Array(list)) => {
                    *list.get_mut(*index)? = value.clone();
                }
                _ => return None,
            }
        }
        // Later items of a list are removed first, so that the paths of the others stay valid.
        let mut remove = self.remove.clone();
        remove.sort_unstable();
        remove.dedup();
        for place in remove.iter().rev() {
            let (last, parent) = place.split_last()?;
            match (last, at_mut(&mut edited, parent)?) {
                (Step::Key(key), Value::Object(map)) => {
                    map.remove(key)?;
                }
                (Step::Item(index), Value::Array(list)) if *index < list.len() => {
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
    fn items_are_removed_by_their_places_before_the_edit() {
        let document = json!({ "a": [0, 1, 2, 3], "b": { "c": 1 } });
        let edit = Edit {
            replace: vec![(place!["a", 3], json!(9)), (place!["b", "d"], json!(2))],
            remove: vec![place!["a", 0], place!["a", 2], place!["b", "c"]],
        };
        let expected = json!({ "a": [1, 9], "b": { "d": 2 } });
        assert_eq!(edit.apply(&document), Some(expected));
    }

    #[test]
    fn an_edit_that_does_not_fit_or_changes_nothing_is_none() {
        let document = json!({ "a": [0] });
        assert_eq!(Edit::removal(place!["a", 1]).apply(&document), None);
        assert_eq!(Edit::removal(place!["b"]).apply(&document), None);
        assert_eq!(Edit::replacement(place!["a", 0], 0).apply(&document), None);
        assert_eq!(
            Edit::replacement(place!["a", "b"], 0).apply(&document),
            None
        );
    }
}
