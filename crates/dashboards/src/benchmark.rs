//! The times of one case on one adapter.

use etalon_record::Time;
use std::collections::BTreeMap;

/// The times of one case on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Benchmark {
    /// The name by which a service tracks the benchmark.
    pub name: String,
    /// The times that were measured.
    pub times: BTreeMap<Time, Figure>,
    /// Further facts for people; can be empty.
    pub extra: String,
}

/// A median and its interval, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// The median.
    pub median: f64,
    /// The interval that contains the median, if it is known.
    pub interval: Option<[f64; 2]>,
}

/// Returns seconds in nanoseconds, the unit of both formats.
pub fn nanoseconds(seconds: f64) -> f64 {
    // No clock resolves thousandths of a nanosecond.
    (seconds * 1e12).round() / 1e3
}

/// Returns the bytes of a file.
pub(crate) fn file(value: &impl serde::Serialize) -> serde_json::Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
}
