//! Names that the page of methods, its links and its texts share.

use crate::numbers::{capital, digits};

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
    match name {
        "" => "(no name)".to_owned(),
        name => capital(name).replace('-', " "),
    }
}
