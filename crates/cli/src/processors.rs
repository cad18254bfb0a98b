//! The processors of this machine.

use std::num::NonZero;
use std::thread::available_parallelism;

/// Returns the number of processors that this process may use; 1 where the system does not say.
pub(crate) fn processors() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}
