//! Labels: what people or jobs say about a run, such as its branch.

use std::collections::BTreeMap;
use thiserror::Error;

/// The maximum number of bytes of a key.
const MAX_KEY: usize = 200;
/// The maximum number of bytes of a value.
const MAX_VALUE: usize = 4096;

/// The labels of a run: keys with their values.
pub type Labels = BTreeMap<String, String>;

/// An error from parsing a label.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LabelError {
    /// There is no `=`.
    #[error("the label {0:?} has no `=`: write key=value")]
    NoValue(String),
    /// The key is empty.
    #[error("the label {0:?} has no key: write key=value")]
    NoKey(String),
    /// The key or the value is too long.
    #[error(
        "the label {key:?} is too long: a key can have {MAX_KEY} bytes and a value {MAX_VALUE}"
    )]
    TooLong {
        /// The beginning of the key.
        key: String,
    },
    /// The key is given twice.
    #[error("the label {0:?} is given twice with different values")]
    Twice(String),
}

/// Parses labels that are written `key=value`. The first `=` ends the key; a value can contain anything and
/// can be empty.
///
/// # Errors
/// If a label has no key or no `=`, is too long, or contradicts another one.
pub fn parse_labels<S: AsRef<str>>(texts: &[S]) -> Result<Labels, LabelError> {
    let mut labels = Labels::new();
    for text in texts {
        let text = text.as_ref();
        let cut = || text.chars().take(60).collect::<String>();
        let (key, value) = text
            .split_once('=')
            .ok_or_else(|| LabelError::NoValue(cut()))?;
        if key.is_empty() {
            return Err(LabelError::NoKey(cut()));
        }
        if key.len() > MAX_KEY || value.len() > MAX_VALUE {
            return Err(LabelError::TooLong { key: cut() });
        }
        let before = labels.insert(key.to_owned(), value.to_owned());
        if before.is_some_and(|before| before != value) {
            return Err(LabelError::Twice(cut()));
        }
    }
    Ok(labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_value_can_hold_any_text() {
        let texts = ["branch=main", "note=a=b\n\"'\u{1b}[31m\0", "empty="];
        let labels = parse_labels(&texts).unwrap();
        assert_eq!(labels["branch"], "main");
        assert_eq!(labels["note"], "a=b\n\"'\u{1b}[31m\0");
        assert_eq!(labels["empty"], "");
        assert_eq!(parse_labels(&["a=1", "a=1"]).unwrap().len(), 1);
    }

    #[test]
    fn invalid_labels_have_a_short_error() {
        let long = format!("k={}", "v".repeat(MAX_VALUE + 1));
        for texts in [
            vec!["branch"],
            vec!["=main"],
            vec![""],
            vec!["a=1", "a=2"],
            vec![long.as_str()],
        ] {
            let error = parse_labels(&texts).unwrap_err().to_string();
            assert!(error.len() < 200 && !error.contains('\n'), "{error}");
        }
    }
}
