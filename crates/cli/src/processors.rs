//! The processors of this machine.

use std::num::NonZero;
use std::thread::available_parallelism;

/// Returns the number of processors that this process can use; 1 if the system does not report it.
pub(crate) fn processors() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}
