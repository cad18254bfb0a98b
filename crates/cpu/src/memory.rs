//! The data that a submission has stored so far.

use crate::lists::Lists;
use crate::steps::Stored;
use crate::surface::Surface;
use etalon_frame::CounterKind;

/// A counter and its count.
pub(crate) type Counted = (CounterKind, u64);

/// The attachments and the counters, in the scene's order, and the pool.
pub(crate) struct Memory<'m> {
    pub(crate) surfaces: &'m mut [Surface],
    pub(crate) counters: &'m mut [Counted],
    pub(crate) lists: &'m mut Lists,
}

impl Memory<'_> {
    /// Returns the contents that a planted bug can change.
    pub(crate) fn stored(&mut self) -> Stored<'_> {
        Stored {
            surfaces: self.surfaces,
            counters: self.counters,
        }
    }
}
