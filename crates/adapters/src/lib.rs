//! Adapters: their descriptions, discovery and worker processes.
//!
//! A worker is this program again, started as `worker --open`, `worker --enumerate` or `worker --guard`, so the program
//! that uses this crate has these arguments. The crate opens no driver itself, because drivers can crash or hang.
#![cfg_attr(
    test,
    expect(clippy::unwrap_used, reason = "a test that panics has failed")
)]

mod backend_name;
pub mod cache;
mod candidate;
mod description;
mod devices;
mod discovery;
mod error;
mod guard;
mod listen;
mod names;
mod open;
mod origin;
mod query;
mod runtime_folder;
mod unstarted;

pub use backend_name::BackendName;
pub use description::{described_names, releases_of};
pub use devices::{HardwareDevice, hardware_names};
pub use discovery::{Adapters, discover};
pub use error::AdapterError;
pub use guard::guard;
pub use listen::Listen;
pub use open::{DrawingProgram, FROM_INPUT, OpenRequest};
pub use origin::Origin;
pub use query::Query;
pub use unstarted::take_unstarted;
