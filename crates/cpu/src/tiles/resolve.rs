//! The resolve of colours, which averages a texel's samples.

use super::AREA;
use super::layout::WordLayout;
use crate::lanes::{LANES, LaneCodes};
use etalon_frame::ChannelEncoding::{self, Srgb8, Unorm};
use etalon_pipeline::{Arithmetic, Plain};
use fearless_simd::Simd;

/// Returns true if equal samples resolve to their own code, for all codes of these channels.
fn averages_are_codes(channels: &[ChannelEncoding], samples: usize) -> bool {
    let share = 1.0 / samples as f32;
    let small = |e: &ChannelEncoding| matches!(e, Unorm(..=10) | Srgb8);
    let same = |e: &ChannelEncoding| {
        (0..=e.mask()).all(|code| {
            let [value] = Plain::<1>.decode(*e, [code]);
            let sum = (1..samples).fold(value, |sum, _| sum + value);
            Plain::<1>.encode(*e, [sum * share]) == [code]
        })
    };
    channels.iter().all(small) && channels.iter().all(same)
}

/// Returns the average of the samples of one channel. `codes` gives the codes of a sample.
#[inline(always)]
fn average(
    encoding: ChannelEncoding,
    samples: usize,
    codes: impl Fn(usize) -> LaneCodes,
) -> LaneCodes {
    // Integers resolve to one sample.
    if let ChannelEncoding::Uint(_) = encoding {
        return codes(0);
    }
    let mut sum = Plain::<LANES>.decode(encoding, codes(0));
    for sample in 1..samples {
        let value = Plain::<LANES>.decode(encoding, codes(sample));
        sum = Plain::<LANES>.add(sum, value);
    }
    let share = 1.0 / samples as f32;
    let average = Plain::<LANES>.mul(sum, [share; LANES]);
    Plain::<LANES>.encode(encoding, average)
}

/// The resolve of a pass's colours.
#[derive(Debug)]
pub(crate) struct ColorResolve {
    channels: &'static [ChannelEncoding],
    layout: WordLayout,
    samples: usize,
    /// True if equal samples resolve to their own code.
    known: bool,
}

impl ColorResolve {
    /// Returns the resolve of this many samples of these channels.
    pub(crate) fn new(channels: &'static [ChannelEncoding], samples: usize) -> Self {
        Self {
            channels,
            layout: WordLayout::new(channels),
            samples,
            known: averages_are_codes(channels, samples),
        }
    }

    /// Resolves the planes of a tile. If `same` is true, only the first sample is in memory, and all are
    /// equal to it.
    #[inline(never)]
    pub(crate) fn tile<S: Simd>(&self, simd: S, planes: &[u32], same: bool, resolved: &mut [u32]) {
        simd.vectorize(
            #[inline(always)]
            || self.tile_of(planes, same, resolved),
        );
    }

    #[inline(always)]
    fn tile_of(&self, planes: &[u32], same: bool, resolved: &mut [u32]) {
        for (word, target) in resolved.chunks_exact_mut(AREA).enumerate() {
            let plane = |sample: usize| {
                let first = if same { 0 } else { sample * self.layout.words };
                &planes[(first + word) * AREA..][..AREA]
            };
            let (targets, _) = target.as_chunks_mut::<LANES>();
            for (chunk, target) in targets.iter_mut().enumerate() {
                let words = |sample: usize| &plane(sample)[chunk * LANES..][..LANES];
                let differ = (1..self.samples).fold(0, |bits, sample| {
                    let pairs = words(0).iter().zip(words(sample));
                    pairs.fold(bits, |bits, (a, b)| bits | (a ^ b))
                });
                if self.known && differ == 0 {
                    target.copy_from_slice(words(0));
                    continue;
                }
                let channels = self.layout.fields().iter().zip(self.channels);
                for (field, encoding) in channels.filter(|(field, _)| field.word == word) {
                    let codes = |sample: usize| {
                        let mut codes = [0; LANES];
                        for (code, word) in codes.iter_mut().zip(words(sample)) {
                            *code = field.code(*word);
                        }
                        codes
                    };
                    let new = average(*encoding, self.samples, codes);
                    for (word, code) in target.iter_mut().zip(new) {
                        *word = field.replaced(*word, code);
                    }
                }
            }
        }
    }
}
