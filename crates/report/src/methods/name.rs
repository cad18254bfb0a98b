//! Names that the page of methods, its links and its texts share.

use crate::numbers::digits;

/// The name of the page of methods in a run folder.
pub(crate) const PAGE: &str = "methods.html";

/// A parameter's value.
pub(super) fn value_text(value: f64) -> String {
    digits(value, 3)
}

/// The id of the element that holds a scene's charts: letters, digits and dashes, so that no name of a
/// record can break a link.
pub(super) fn anchor(question: usize, scene: usize) -> String {
    format!("s{question}-{scene}")
}

/// A name of the records as a heading: `cut-outs` is Cut outs.
pub(super) fn title(name: &str) -> String {
    let mut letters = name.chars();
    match letters.next() {
        Some(first) => first
            .to_uppercase()
            .chain(letters)
            .collect::<String>()
            .replace('-', " "),
        None => "(no name)".to_owned(),
    }
}
