//! The parameters of discovery.

use std::path::Path;
use std::time::Duration;

/// The adapters to find, and how their workers start.
#[derive(Clone, Copy, Debug, Default)]
pub struct Query<'a> {
    /// The names to find; all if empty.
    pub names: &'a [String],
    /// The user's file with additional descriptions.
    pub file: Option<&'a Path>,
    /// True if validation layers and debug output are enabled.
    pub validate: bool,
    /// True if the calls of the first scene are recorded.
    pub record: bool,
    /// True if no browser is started.
    pub without_browsers: bool,
    /// True if the drivers' shader caches on disk are disabled.
    pub cold: bool,
    /// The time that a driver may take to start; [`START_TIMEOUT`](etalon_runner::START_TIMEOUT) if `None`.
    pub start_timeout: Option<Duration>,
}
