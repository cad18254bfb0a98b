//! Frame times in the formats of services that keep their own history.
//!
//! [`bencher()`] writes Bencher's format, and [`action()`] github-action-benchmark's. Both write the same
//! [benchmarks](Benchmark): of one bench, or the latest of a history.

#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod action;
mod bencher;
mod benchmark;

pub use action::{ACTION_FILE, action};
pub use bencher::{BENCHER_FILE, bencher};
pub use benchmark::{Benchmark, Figure, nanoseconds};
