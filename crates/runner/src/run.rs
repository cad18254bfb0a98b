//! A run: every selected case on every adapter, one record each.
//!
//! Each adapter has a queue of cases. `--jobs` threads take cases from the queues, each with its own
//! worker. Workers draw ahead while the threads judge. The first thread of an adapter draws the round trips
//! that the cases depend on, and the others wait for the results.

mod adapter_queue;
mod adapter_run;
mod budget;
mod execute;
mod idle;
mod plan;
mod second_look;
mod shared;
mod worker_loop;

pub use execute::run;
pub use plan::{Drawn, FrameSizes, KeptFrames, Plan, Rechecks, RunError, RunOptions, RunSummary};
