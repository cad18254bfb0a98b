//! Comma-separated values (RFC 4180).

use crate::words::plain;

/// Returns a line of fields.
pub(crate) fn line<S: AsRef<str>>(fields: &[S]) -> String {
    let fields: Vec<&str> = fields.iter().map(S::as_ref).collect();
    fields.join(",") + "\r\n"
}

/// Returns all digits of a number, so that it reads back exactly, or an empty text for `None`.
pub(crate) fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |v| v.to_string())
}

/// Returns a field on one line, in quotes if it needs them.
pub(crate) fn field(text: &str) -> String {
    let text = plain(text, 1000);
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text
    }
}
