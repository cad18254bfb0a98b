//! Workers that fail after their last case: in the destruction of a device, or in what a driver does at exit.

use crate::error::RecordError;
use crate::folder::BAD_ENDS_FILE;
use crate::output_folder::OutputFolder;
use crate::paths::open_below;
use crate::record::ProcessEnd;
use serde::{Deserialize, Serialize};
use std::io::Read;
use std::path::Path;

/// The maximum number of bytes of such a list.
const MAX_BYTES: u64 = 16 << 20;

/// Workers of one adapter that failed in the same way after their last case, when all their records were written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BadEnd {
    /// The adapter.
    pub adapter: String,
    /// A message for people: the cause, and the end of standard error.
    pub message: String,
    /// How the first of them ended.
    pub end: ProcessEnd,
    /// The number of workers.
    pub workers: u64,
}

impl BadEnd {
    /// Adds ends to a list. Ends of one adapter with the same signal and status are one.
    pub fn add(list: &mut Vec<Self>, more: impl IntoIterator<Item = Self>) {
        for end in more {
            let same = |other: &&mut Self| {
                other.adapter == end.adapter
                    && other.end.signal == end.end.signal
                    && other.end.exit == end.end.exit
            };
            match list.iter_mut().find(same) {
                Some(other) => other.workers += end.workers,
                None => list.push(end),
            }
        }
    }

    /// Writes a list into a run folder; does nothing if it is empty.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(folder: &Path, list: &[Self]) -> Result<(), RecordError> {
        if list.is_empty() {
            return Ok(());
        }
        let mut text = serde_json::to_string_pretty(list)
            .map_err(RecordError::serialize("how workers ended"))?;
        text.push('\n');
        let out = OutputFolder::open(folder)?;
        out.write(BAD_ENDS_FILE, text.as_bytes()).map(drop)
    }

    /// Reads the list in a run folder; returns none if there is no list.
    ///
    /// # Errors
    /// If the list cannot be read or does not parse.
    pub fn read(folder: &Path) -> Result<Vec<Self>, RecordError> {
        let path = folder.join(BAD_ENDS_FILE);
        let mut text = String::new();
        match open_below(folder, BAD_ENDS_FILE) {
            Ok(file) => file.take(MAX_BYTES).read_to_string(&mut text),
            Err(e) if e.is_missing() => return Ok(Vec::new()),
            Err(e) => return Err(e),
        }
        .map_err(RecordError::io("read", &path))?;
        serde_json::from_str(&text).map_err(|e| RecordError::Parse {
            line: e.line(),
            message: crate::json::without_position(&e),
            remedy: "remove the file, or record the run again",
            path,
        })
    }
}
