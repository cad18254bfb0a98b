//! Functions of the bits of texels: write masks, replacement by a value, and logic operations.

use super::AREA;
use super::fragments::Fragments;
use super::lanes::{lanes, select};
use super::layout::{TexelWords, WordLayout};
use crate::lanes::LANES;
use fearless_simd::Simd;

/// A function that keeps some bits of a texel's words and replaces the others, and then inverts some of the
/// kept bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bits {
    and: TexelWords,
    xor: TexelWords,
    words: usize,
}

impl Bits {
    /// Returns the function that turns a texel of zeros into `of_zeros` and a texel of ones into `of_ones`.
    /// Each bit must depend only on itself.
    pub(crate) fn new(layout: &WordLayout, of_zeros: TexelWords, of_ones: TexelWords) -> Self {
        let used = layout.texel(|_| u32::MAX);
        let mut and = [0; 4];
        for (word, and) in and.iter_mut().enumerate() {
            *and = of_zeros[word] ^ of_ones[word];
            // Bits that belong to no channel can be kept.
            if *and == used[word] {
                *and = u32::MAX;
            }
        }
        Self {
            and,
            xor: of_zeros,
            words: layout.words,
        }
    }

    /// Returns the word that replaces every texel, if the texel is one word and is always replaced.
    pub(crate) fn stored(&self) -> Option<u32> {
        (self.words == 1 && self.and[0] == 0).then_some(self.xor[0])
    }

    /// Returns true if each channel is either replaced or kept.
    pub(crate) fn is_mask(&self, layout: &WordLayout) -> bool {
        layout.fields().iter().all(|field| {
            let (and, xor) = (
                field.code(self.and[field.word]),
                field.code(self.xor[field.word]),
            );
            and == 0 || and == field.code(u32::MAX) && xor == 0
        })
    }

    /// Returns true if every texel is replaced.
    pub(crate) fn replaces(&self) -> bool {
        self.and[..self.words].iter().all(|and| *and == 0)
    }

    /// Returns the masks of the words that change, each with its index.
    fn changed(&self) -> impl Iterator<Item = (usize, [u32; 2])> {
        let words = self.and.into_iter().zip(self.xor).take(self.words);
        let functions = words.map(|(and, xor)| [and, xor]).enumerate();
        functions.filter(|(_, function)| *function != [u32::MAX, 0])
    }

    /// Applies the function to the first texels of a sample's planes.
    #[inline(always)]
    pub(crate) fn whole(&self, planes: &mut [u32], count: usize) {
        for (word, [and, xor]) in self.changed() {
            let words = &mut planes[word * AREA..][..count];
            match and {
                0 => words.fill(xor),
                _ => apply(words, and, xor),
            }
        }
    }

    /// Applies the function to fragments of a sample's planes.
    #[inline(always)]
    pub(crate) fn masked<S: Simd>(&self, simd: S, planes: &mut [u32], fragments: &Fragments) {
        for (word, [and, xor]) in self.changed() {
            let plane = &mut planes[word * AREA..];
            match and {
                0 => {
                    for (start, mask) in fragments.groups() {
                        select(simd, lanes(plane, start), mask, &[xor; LANES]);
                    }
                }
                _ => fragments.replace(simd, plane, |new| apply(new.as_flattened_mut(), and, xor)),
            }
        }
    }
}

/// Keeps some bits of words, and then inverts some.
#[inline(always)]
fn apply(words: &mut [u32], and: u32, xor: u32) {
    for word in words {
        *word = *word & and ^ xor;
    }
}
