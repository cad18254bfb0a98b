//! Selects, isolates, runs and judges; emits one event stream.
//!
//! Workers only draw: [`serve`] answers requests in a process of its own. The parent judges: [`run`]
//! drives one worker per adapter, holds every frame against its legal set, writes one record per
//! case and adapter, and tells [`Event`]s as they happen. [`hunt`] draws cases with bugs planted, and
//! tells which of them are seen.

mod bench;
mod event;
mod hunt;
mod link;
mod loss;
mod measure;
mod process;
mod protocol;
mod relation;
mod run;
mod select;
mod verdict;
mod worker;

pub use bench::{BenchError, BenchEvent, BenchOutcome, BenchPlan, bench, ruler};
pub use event::Event;
pub use hunt::{HuntPlan, hunt};
pub use process::{DrawError, Launch, StartError, Worker};
pub use protocol::Hello;
pub use run::{Options, Outcome, Plan, RunError, run};
pub use select::{Globs, SelectError, Selection, select};
pub use verdict::{Judge, Judged};
pub use worker::serve;
