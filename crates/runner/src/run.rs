//! A run: every selected case on every adapter, one record each.
//!
//! Each adapter has a queue of cases; `--jobs` threads take them from it, each with a worker of its own.
//! Workers draw ahead while the threads judge. The first thread of an adapter draws the round trips that the
//! cases lean on, and the others wait for what they show.

mod adapter_queue;
mod adapter_run;
mod execute;

mod pictures;
mod plan;
mod round_trips;
mod second_look;
mod shared;
mod worker_loop;

pub use execute::run;
pub use plan::{KeptFrames, Options, Plan, Rechecks, RunError, RunSummary};
pub use round_trips::round_trips;
