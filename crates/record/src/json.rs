//! Writing JSON, and reporting its errors.

use crate::error::RecordError;
use etalon_frame::shortened;
use serde::Serialize;

/// Returns a value as one line of JSON.
pub(crate) fn json_line(
    what: &'static str,
    value: &impl Serialize,
) -> Result<Vec<u8>, RecordError> {
    let mut line = serde_json::to_vec(value).map_err(RecordError::serialize(what))?;
    line.push(b'\n');
    Ok(line)
}

/// Returns the message of an error without the position at its end, which the caller states itself.
pub(crate) fn without_position(error: &serde_json::Error) -> String {
    let text = error.to_string();
    shortened(match text.rfind(" at line ") {
        Some(end) => &text[..end],
        None => &text,
    })
}
