//! A history as files for other programs.
//!
//! [`export`] writes a history to a folder: Parquet for engines that query tables, OpenMetrics for
//! Prometheus, or the frame times of the latest benches for Bencher and github-action-benchmark.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod error;
mod folder;
mod format;
mod latest;
mod openmetrics;
mod selection;
mod table;
mod tables;
mod written;

pub use error::ExportError;
pub use format::{ExportFormat, export};
pub use selection::RunChoice;
pub use written::ExportSize;
