//! Processes: what the standard library leaves to the system. Both files have the same functions.

#[cfg(unix)]
mod unix;
#[cfg(windows)]
mod windows;

#[cfg(unix)]
use unix as system;
#[cfg(windows)]
use windows as system;

pub use system::{
    Parent, ProcessGroup, crash, end_group, end_like, end_with_thread, memory, private_output,
    replace, report_large_files, separate, signal, wait_for_end_of_input, write_output,
};
