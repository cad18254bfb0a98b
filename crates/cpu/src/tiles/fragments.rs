//! Fragments of one sample of a tile, in groups of neighbouring texels.
//!
//! Groups are collected, and then go through the tests and the blend step by step, so that a draw's state is
//! matched once for all of them.

use super::depth_stencil::{answers, passing};
use super::lanes::{LaneBits, lanes, select};
use crate::lanes::{LANES, LaneCodes};
use etalon_scene::{DepthState, StencilFace};
use fearless_simd::prelude::*;
use fearless_simd::{mask8x16, mask32x16, u8x16, u32x16};

/// The largest number of collected groups.
pub(crate) const MOST: usize = 32;

/// A mask for each group.
type Masks = [LaneBits; MOST];

/// Groups of fragments: their indices in a sample's plane, and the lanes that are drawn.
#[derive(Debug)]
pub(crate) struct Fragments {
    masks: Masks,
    places: [u16; MOST],
    count: usize,
}

impl Fragments {
    /// Returns an empty collection.
    pub(crate) fn new() -> Self {
        Self {
            masks: [0; MOST],
            places: [0; MOST],
            count: 0,
        }
    }

    /// Adds a group if it has lanes. Returns true if the collection is then full.
    #[inline(always)]
    pub(crate) fn push(&mut self, place: usize, mask: LaneBits) -> bool {
        self.places[self.count] = place as u16;
        self.masks[self.count] = mask;
        // Without a branch, since empty groups are unpredictable.
        self.count += usize::from(mask != 0);
        self.count == MOST
    }

    /// Removes all groups.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// Returns true if there are no groups.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the indices and the masks of the groups.
    #[inline(always)]
    pub(crate) fn parts(&self) -> (&[u16], &[LaneBits]) {
        (&self.places[..self.count], &self.masks[..self.count])
    }

    /// Returns the indices of the groups with their masks.
    #[inline(always)]
    pub(crate) fn groups(&self) -> impl Iterator<Item = (usize, LaneBits)> {
        self.with(&self.masks)
    }

    /// Returns the indices of the groups with other masks.
    #[inline(always)]
    pub(crate) fn with(&self, masks: &Masks) -> impl Iterator<Item = (usize, LaneBits)> {
        let places = self.places[..self.count].iter().map(|p| usize::from(*p));
        places.zip(masks.iter().copied())
    }

    /// Returns the indices of the groups with their masks, which can be changed.
    #[inline(always)]
    pub(crate) fn groups_mut(&mut self) -> impl Iterator<Item = (usize, &mut LaneBits)> {
        let places = self.places[..self.count].iter().map(|p| usize::from(*p));
        places.zip(&mut self.masks)
    }

    /// Returns the masks of all groups.
    #[inline(always)]
    pub(crate) fn masks(&self) -> Masks {
        self.masks
    }

    /// Returns the lanes of earlier masks that are no longer drawn.
    #[inline(always)]
    pub(crate) fn lost(&self, mut masks: Masks) -> Masks {
        for (lost, mask) in masks.iter_mut().zip(&self.masks) {
            *lost &= !mask;
        }
        masks
    }

    /// Keeps the lanes that pass the stencil test of a face, against a sample's plane.
    #[inline(always)]
    pub(crate) fn test_stencil<S: Simd>(&mut self, simd: S, face: &StencilFace, plane: &mut [u8]) {
        let answers = answers(passing(face.compare)).map(|answer| mask8x16::splat(simd, answer));
        let [less, equal, greater] = answers;
        let seen = u8x16::splat(simd, face.read_mask);
        let reference = u8x16::splat(simd, face.reference & face.read_mask);
        for (place, mask) in self.groups_mut() {
            let stored = u8x16::from_slice(simd, lanes(plane, place)) & seen;
            let below = reference.simd_lt(stored) & less;
            let same = reference.simd_eq(stored) & equal;
            *mask &= (greater ^ below ^ same).to_bitmask() as LaneBits;
        }
    }

    /// Keeps the lanes whose codes pass the depth test against a sample's plane, and writes their codes if
    /// the state says so. `codes` gives the codes of a group by its index.
    #[inline(always)]
    pub(crate) fn test_depth<S: Simd>(
        &mut self,
        simd: S,
        state: &DepthState,
        plane: &mut [u32],
        codes: impl Fn(usize) -> LaneCodes,
    ) {
        let answers = answers(passing(state.compare)).map(|answer| mask32x16::splat(simd, answer));
        let [less, equal, greater] = answers;
        for (place, mask) in self.groups_mut() {
            let stored = lanes(plane, place);
            let old = u32x16::from_slice(simd, stored);
            let codes = u32x16::from_slice(simd, &codes(place));
            let below = codes.simd_lt(old) & less;
            let same = codes.simd_eq(old) & equal;
            let covered = mask32x16::from_bitmask(simd, u64::from(*mask));
            let passed = covered & (greater ^ below ^ same);
            *mask = passed.to_bitmask() as LaneBits;
            if state.write {
                passed.select(codes, old).store_slice(stored);
            }
        }
    }

    /// Applies a function to the words of all groups in a plane, and stores the results in the lanes of the
    /// masks.
    #[inline(always)]
    pub(crate) fn replace<S: Simd>(
        &self,
        simd: S,
        plane: &mut [u32],
        function: impl FnOnce(&mut [LaneCodes]),
    ) {
        let mut new = [[0; LANES]; MOST];
        for (new, (place, _)) in new.iter_mut().zip(self.groups()) {
            *new = *lanes(plane, place);
        }
        function(&mut new[..self.count]);
        for (new, (place, mask)) in new.iter().zip(self.groups()) {
            select(simd, lanes(plane, place), mask, new);
        }
    }
}
