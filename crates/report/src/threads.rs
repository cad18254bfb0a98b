//! Functions that spread work over all processors.

use etalon_frame::threads::each;
use std::thread::available_parallelism;

/// Returns the results of a function for each item, in order, computed on as many threads as there are
/// processors.
pub(crate) fn on_threads<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    each(available_parallelism().map_or(1, usize::from), items, work)
}
