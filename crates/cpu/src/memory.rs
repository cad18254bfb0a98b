//! The data that a submission has stored so far.

use crate::lists::TexelLists;
use crate::steps::Stored;
use crate::surface::CpuSurface;
use etalon_frame::CounterKind;

/// A counter and its count.
pub(crate) type CountedKind = (CounterKind, u64);

/// The attachments and the counters, in the scene's order, and the pool.
pub(crate) struct Memory<'m> {
    pub(crate) surfaces: &'m mut [CpuSurface],
    pub(crate) counters: &'m mut [CountedKind],
    pub(crate) lists: &'m mut TexelLists,
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
