//! Bugs of stored data: attachments and counters that change between draws.
//!
//! A driver stores more for an attachment than its texels: caches, cleared tiles, coarse depths. A bug there
//! shows only after other operations, so such a bug has state.

use etalon_cpu::CpuSurface;
use etalon_cpu::steps::{Moment, Steps, Stored};
use etalon_scene::Scene;
use std::cell::RefCell;
use std::ops::Range;

/// A bug in the data that one prepared scene stores.
pub(super) struct StoredDataBug(RefCell<Box<StoredBug>>);

type StoredBug = dyn FnMut(Moment, &Scene, Stored<'_>);

impl StoredDataBug {
    /// Creates a bug that is called at every moment.
    pub(super) fn new(bug: impl FnMut(Moment, &Scene, Stored<'_>) + 'static) -> Self {
        Self(RefCell::new(Box::new(bug)))
    }
}

impl Steps for StoredDataBug {
    fn reached(&self, moment: Moment, scene: &Scene, stored: Stored<'_>) {
        (self.0.borrow_mut())(moment, scene, stored);
    }
}

/// Left, top, right and bottom in texels; right and bottom are exclusive.
pub(super) type Area = [usize; 4];

/// Returns the index ranges of an area's texels in a plane, one per row, cut at the surface's edges.
pub(super) fn texel_rows(
    surface: &CpuSurface,
    area: Area,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let [left, top, right, bottom] = area;
    let (stride, right) = (surface.stride, right.min(surface.width).max(left));
    (top..bottom.min(surface.height)).map(move |y| y * stride + left..y * stride + right)
}

/// Copies the texels of an area, with all aspects and samples.
pub(super) fn copy(from: &CpuSurface, to: &mut CpuSurface, area: Area) {
    for texels in texel_rows(from, area) {
        for (to, from) in to.planes.iter_mut().zip(&from.planes) {
            to[texels.clone()].copy_from_slice(&from[texels.clone()]);
        }
        for (to, from) in to.stencil.iter_mut().zip(&from.stencil) {
            to[texels.clone()].copy_from_slice(&from[texels.clone()]);
        }
    }
}
