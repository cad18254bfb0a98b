//! The list of the files that etalon wrote into a folder.

use crate::error::RecordError;
use crate::folder::{LIST, LIST_MARK};
use crate::paths::below;
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

/// The maximum number of bytes of the list that are read.
const MAX_LIST: u64 = 256 << 20;

/// Returns the listed paths; `None` if the folder has no list of etalon.
///
/// # Errors
/// If the list cannot be read.
pub(crate) fn read_list(folder: &Path) -> Result<Option<HashSet<String>>, RecordError> {
    let path = folder.join(LIST);
    // Reading a pipe would block, and a link can lead anywhere.
    if !fs::symlink_metadata(&path).is_ok_and(|found| found.is_file()) {
        return Ok(None);
    }
    let file = File::open(&path).map_err(RecordError::io("read", &path))?;
    let mut lines = BufReader::new(file.take(MAX_LIST)).lines();
    let text = |line: Option<std::io::Result<String>>| match line {
        None => Ok(None),
        Some(Ok(line)) => Ok(Some(line)),
        // No path of etalon.
        Some(Err(e)) if e.kind() == ErrorKind::InvalidData => Ok(Some(String::new())),
        Some(Err(e)) => Err(RecordError::io("read", &path)(e)),
    };
    if text(lines.next())?.as_deref() != Some(LIST_MARK) {
        return Ok(None);
    }
    let mut listed = HashSet::new();
    while let Some(name) = text(lines.next())? {
        if below(&name).is_ok() {
            listed.insert(name);
        }
    }
    Ok(Some(listed))
}
