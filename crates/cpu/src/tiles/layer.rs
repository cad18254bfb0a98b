//! One aspect of an attachment, stored tile by tile. A cleared tile is not written until something is drawn to
//! it, so clears that others follow cost nothing per texel.

use super::AREA;

/// An aspect, in rows of tiles. A tile consists of planes, one for each word of each sample, and a plane of its
/// rows.
#[derive(Debug, Default)]
pub(crate) struct Tiles<T> {
    pub(crate) texels: Vec<T>,
    /// The number of planes of a sample; 0 if the attachment lacks the aspect.
    words: usize,
    samples: usize,
    /// For each tile, the value of all texels in each plane of a sample, while it is not in memory.
    clears: Vec<Option<[T; 4]>>,
}

impl<T: Copy + Default> Tiles<T> {
    /// Returns memory for this many tiles, without contents.
    pub(crate) fn new(tiles: usize, samples: usize, words: usize) -> Self {
        Self {
            texels: vec![T::default(); tiles * samples * words * AREA],
            words,
            samples,
            clears: vec![None; tiles],
        }
    }

    /// Clears all tiles.
    pub(crate) fn clear(&mut self, value: [T; 4]) {
        self.clears.fill(Some(value));
    }

    /// Drops the clear values, because all texels are about to be written.
    pub(crate) fn overwrite(&mut self) {
        self.clears.fill(None);
    }

    /// Returns the value of a tile's texels, if it is not in memory.
    #[inline(always)]
    pub(crate) fn cleared(&self, tile: usize) -> Option<[T; 4]> {
        self.clears[tile]
    }

    /// Returns the layers of all tiles; none if the attachment lacks the aspect.
    pub(crate) fn layers(&mut self) -> impl Iterator<Item = Layer<'_, T>> {
        let size = (self.samples * self.words).max(1) * AREA;
        let planes = self.texels.chunks_exact_mut(size);
        planes
            .zip(self.clears.chunks_mut(1))
            .map(|(planes, clear)| Layer {
                planes,
                words: self.words,
                clear,
            })
    }
}

/// One aspect of a tile: the planes of its samples; empty if the pass lacks the aspect.
#[derive(Debug, Default)]
pub(crate) struct Layer<'a, T> {
    pub(crate) planes: &'a mut [T],
    /// The number of planes of a sample.
    words: usize,
    /// The tile's clear value.
    clear: &'a mut [Option<[T; 4]>],
}

impl<T: Copy> Layer<'_, T> {
    /// Returns the value of all texels in each plane of a sample, while it is not in memory.
    #[inline(always)]
    pub(crate) fn cleared(&self) -> Option<[T; 4]> {
        self.clear.first().copied().flatten()
    }

    /// Writes the clear value, only to the first sample if `same` is true.
    #[inline(always)]
    pub(crate) fn touch(&mut self, same: bool) {
        if let Some(value) = self.clear.first_mut().and_then(Option::take) {
            let sample_words = self.words * AREA;
            let end = if same {
                sample_words
            } else {
                self.planes.len()
            };
            let end = end.min(self.planes.len());
            for sample in self.planes[..end].chunks_exact_mut(sample_words) {
                for (plane, value) in sample.chunks_exact_mut(AREA).zip(value) {
                    plane.fill(value);
                }
            }
        }
    }

    /// Copies the first sample to the others.
    #[inline(always)]
    pub(crate) fn expand(&mut self) {
        if self.cleared().is_none() && !self.planes.is_empty() {
            let (first, rest) = self.planes.split_at_mut(self.words * AREA);
            rest.chunks_exact_mut(self.words * AREA)
                .for_each(|sample| sample.copy_from_slice(first));
        }
    }

    /// Returns the planes of a sample.
    #[inline(always)]
    pub(crate) fn sample(&mut self, sample: usize) -> &mut [T] {
        let sample_words = self.words * AREA;
        &mut self.planes[sample * sample_words..(sample + 1) * sample_words]
    }
}
