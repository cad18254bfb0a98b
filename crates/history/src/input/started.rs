//! The time at which a run began.

use crate::error::HistoryError;
use crate::time::parse_time;
use etalon_frame::shortened;
use std::path::Path;

/// Returns the time in a header at which the run began.
pub(super) fn started(path: &Path, text: &str) -> Result<i64, HistoryError> {
    parse_time(text).ok_or_else(|| HistoryError::Header {
        path: path.to_owned(),
        message: format!("{:?} is not a time", shortened(text)),
    })
}
