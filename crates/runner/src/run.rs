//! A run: every selected case on every adapter, one record each.
//!
//! Each adapter has a queue of cases; `--jobs` threads take them from it, each with a worker of its own.
//! Workers draw ahead while the threads judge.

mod adapter_queue;
mod adapter_run;
mod execute;

mod pictures;
mod plan;
mod second_look;
mod shared;
mod worker_loop;

pub use execute::run;
pub use plan::{Options, Plan, RunError, RunSummary};
