//! Processes: what the standard library leaves to the system. Both files have the same functions.

#[cfg(unix)]
mod unix;
#[cfg(windows)]
mod windows;

#[cfg(unix)]
use unix as system;
#[cfg(windows)]
use windows as system;

pub use system::{Group, crash, memory, private_output, replace, separate, signal, write_output};
