//! Runs and benches of workers that fail in many ways.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

mod again;
mod bench;
mod cases;
mod faults;
mod worker;
