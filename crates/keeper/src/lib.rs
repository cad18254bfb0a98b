//! Programs that end with the process that needs them.
//!
//! A worker can need another program: a browser, or the server of a driver. It starts a keeper, a separate process,
//! which starts the program. When the worker ends, for whatever reason, the keeper's input closes, and the keeper
//! ends the program. A guard ends the program with the keeper.

mod guard;
mod kept;
mod server;

pub use guard::guard;
pub use kept::{Kept, KeptProgram, keep, new_folder, token};
pub use server::{NotServed, Served, Server};
