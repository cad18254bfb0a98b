//! Programs that end with the process that needs them.
//!
//! A worker may need another program: a browser, or the server of a driver. It starts a keeper, a process of its own,
//! which starts the program, and ends it when the worker ends, however that ends: the worker's end closes the keeper's
//! input.

mod kept;
mod server;

pub use kept::{Kept, Program, keep, new_folder, token};
pub use server::{NotServed, Served, Server};
