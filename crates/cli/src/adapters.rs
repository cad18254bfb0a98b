//! Adapters: their descriptions, discovery and worker processes.

mod backend_name;
pub(crate) mod cache;
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

pub(crate) use backend_name::BackendName;
pub(crate) use description::{described_names, releases_of};
pub(crate) use devices::{HardwareDevice, hardware_names};
pub(crate) use discovery::{Adapters, discover};
pub(crate) use guard::guard;
pub(crate) use open::{FROM_INPUT, Open};
pub(crate) use origin::Origin;
pub(crate) use query::Query;
pub(crate) use unstarted::take_unstarted;
