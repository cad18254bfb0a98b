//! The times of one case on one adapter.

use etalon_record::Time;
use std::collections::BTreeMap;

/// The times of one case on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Benchmark {
    /// The name under which a service follows it.
    pub name: String,
    /// The name of the measurement.
    pub times: BTreeMap<Time, Figure>,
    /// Further facts for people, or empty.
    pub extra: String,
}

/// A median with its interval, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// The median.
    pub median: f64,
    /// The interval in which it lies, where that is known.
    pub interval: Option<[f64; 2]>,
}

/// Seconds in nanoseconds, the unit of both formats.
pub fn nanoseconds(seconds: f64) -> f64 {
    // Thousandths of a nanosecond are no figures of any clock.
    (seconds * 1e12).round() / 1e3
}

/// The bytes of a file.
pub(crate) fn file(value: &impl serde::Serialize) -> serde_json::Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
}
