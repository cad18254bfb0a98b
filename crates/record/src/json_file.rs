//! Lists of a run folder that are one JSON file each.

use crate::error::RecordError;
use crate::json::without_position;
use crate::paths::open_below;
use serde::de::DeserializeOwned;
use std::io::Read;
use std::path::Path;

/// The maximum number of bytes of such a file.
const MAX_BYTES: u64 = 16 << 20;

/// Reads a list in a folder; returns none if the folder has no such file.
///
/// # Errors
/// If the file cannot be read or does not parse.
pub(crate) fn read_json<T: DeserializeOwned>(
    folder: &Path,
    name: &str,
) -> Result<Vec<T>, RecordError> {
    let path = folder.join(name);
    let mut text = String::new();
    match open_below(folder, name) {
        Ok(file) => file.take(MAX_BYTES).read_to_string(&mut text),
        Err(e) if e.is_missing() => return Ok(Vec::new()),
        Err(e) => return Err(e),
    }
    .map_err(RecordError::io("read", &path))?;
    serde_json::from_str(&text).map_err(|e| RecordError::Parse {
        line: e.line(),
        message: without_position(&e),
        remedy: "remove the file, or record the run again",
        path,
    })
}
