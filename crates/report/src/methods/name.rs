//! Names that the page of methods, its links and its texts share.

use crate::numbers::{capital, digits};

/// The name of the page of methods in a run folder.
pub(crate) const PAGE: &str = "methods.html";

/// Returns a parameter's value as text.
pub(super) fn value_text(value: f64) -> String {
    digits(value, 3)
}

/// Returns the id of the element with a scene's charts. It contains only letters, digits and dashes, so no
/// name in a record can break a link.
pub(super) fn anchor(question: usize, scene: usize) -> String {
    format!("s{question}-{scene}")
}

/// Returns the id of a method's row in the table of a question on an adapter.
pub(super) fn row_anchor(question: usize, adapter: usize, method: usize) -> String {
    format!("m{question}-{adapter}-{method}")
}

/// Returns a method's name for a sentence, where `none` alone would read as "nothing".
pub(super) fn in_words(method: &str) -> &str {
    match method {
        "none" => "none (plain drawing)",
        name => name,
    }
}

/// Returns a name from the records as a heading: `cut-outs` becomes `Cut outs`.
pub(super) fn title(name: &str) -> String {
    match name {
        "" => "(no name)".to_owned(),
        name => capital(name).replace('-', " "),
    }
}
