//! Workers that fail after their last case: in the destruction of a device, or in what a driver does at exit.

use crate::error::RecordError;
use crate::folder::BAD_ENDS_FILE;
use crate::json_file::{read_json, write_json};
use crate::output_folder::OutputFolder;
use crate::record::ProcessEnd;
use serde::{Deserialize, Serialize};
use std::path::Path;

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
        write_json(
            &OutputFolder::open(folder)?,
            BAD_ENDS_FILE,
            "how workers ended",
            list,
        )
    }

    /// Reads the list in a run folder; returns none if there is no list.
    ///
    /// # Errors
    /// If the list cannot be read or does not parse.
    pub fn read(folder: &Path) -> Result<Vec<Self>, RecordError> {
        read_json(folder, BAD_ENDS_FILE)
    }
}
