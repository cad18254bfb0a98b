//! Isolation, drawing and judging of cases, reported as one stream of events.
//!
//! Workers only draw: [`serve()`] answers requests in its own process. The parent judges: [`run()`] drives
//! workers of every adapter, compares every frame with its legal set and writes one record per case and
//! adapter; [`bench()`] times frames. Both start and replace workers through the same supervisor.
//! [`Batches`] draws and judges cases without keeping records. [`hunt()`] draws cases with planted bugs in
//! this process, and reports which bugs are caught.

mod adapter_record;
mod batch;
mod bench;
mod drawing;
mod event;
mod failure_report;
mod greeting;
mod hunt;
mod innocents;
mod launch;
mod loss;
mod measure;
mod memory;
mod outcome;
mod process;
mod process_end;
mod protocol;
mod reduction;
mod remote;
mod run;
mod serve;
mod sized;
mod stderr_tail;
mod supervisor;
mod sync;
mod trial;
mod version_search;
mod worker;

pub use batch::Batches;
pub use bench::{
    BenchError, BenchEvent, BenchPlan, BenchSummary, bench, instruction_counter, ruler,
};
pub use drawing::draw_frames;
pub use event::RunEvent;
pub use hunt::{Catches, HuntPlan, Hunted, hunt};
pub use innocents::{InnocentPlan, PlannedInnocent, try_innocents};
pub use launch::{Launch, Launcher, START_TIMEOUT, Setup, StartError};
pub use protocol::Hello;
pub use reduction::{
    Flakiness, Looked, Lost, Reducer, ReductionError, Smallest, Unconfirmed, confirm, smallest,
};
pub use remote::RemoteBackend;
pub use run::{
    Drawn, FrameSizes, KeptFrames, Plan, Rechecks, RunError, RunOptions, RunSummary, run,
};
pub use serve::serve;
pub use trial::Trials;
pub use version_search::releases_to_draw;
pub use worker::{DrawError, Recorded, Worker};
