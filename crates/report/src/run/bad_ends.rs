//! Workers that failed after their last case.

use crate::numbers::count;
use crate::words::plain;
use etalon_record::BadEnd;

/// Returns the workers that failed after their last case for a terminal, one line each. The text does not end in a
/// newline.
pub fn bad_end_lines(ends: &[BadEnd]) -> String {
    let lines = ends.iter().map(|end| {
        let workers = count(end.workers, "worker");
        let adapter = plain(&end.adapter, 60);
        let message = plain(&end.message, 600);
        format!("after its last case: {adapter}: {workers}: {message}")
    });
    lines.collect::<Vec<_>>().join("\n")
}
