//! Blends in which everything except the destination's channel is constant, for channels that are not bytes.
//!
//! A term performs the pipeline's plain arithmetic, with its constants computed once. It processes planes
//! channel by channel, with code specialized for the encoding.

use super::AREA;
use super::fragments::Fragments;
use super::layout::ChannelField;
use super::planes::with_encoding;
use crate::lanes::LaneCodes;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use fearless_simd::Simd;

/// A function of the code of each channel.
#[derive(Debug)]
pub(crate) struct Affine {
    pub(crate) terms: [Option<Term>; 4],
}

/// The function of one channel that is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) field: ChannelField,
    pub(crate) encoding: ChannelEncoding,
    pub(crate) join: Join,
    /// False if the destination counts as 0.
    pub(crate) reads: bool,
    /// The destination's factor.
    pub(crate) factor: f32,
    /// The product of the source and its factor.
    pub(crate) source: f32,
}

/// The combination of source and destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Join {
    Sum,
    Least,
    Most,
}

impl Affine {
    /// Applies the function to fragments of a sample's planes.
    #[inline(always)]
    pub(crate) fn masked<S: Simd>(&self, simd: S, planes: &mut [u32], fragments: &Fragments) {
        for term in self.terms.iter().flatten() {
            let plane = &mut planes[term.field.word * AREA..];
            fragments.replace(simd, plane, |new| term.apply(simd, new));
        }
    }

    /// Applies the function to the first texels of a sample's planes. Their number must be a multiple of
    /// [`LANES`](crate::lanes::LANES).
    #[inline(always)]
    pub(crate) fn whole<S: Simd>(&self, simd: S, planes: &mut [u32], count: usize) {
        for term in self.terms.iter().flatten() {
            let (lanes, _) = planes[term.field.word * AREA..][..count].as_chunks_mut();
            term.apply(simd, lanes);
        }
    }
}

impl Term {
    /// Applies the function to words. It is large, so it is not inlined.
    #[inline(never)]
    fn apply<S: Simd>(&self, simd: S, words: &mut [LaneCodes]) {
        simd.vectorize(
            #[inline(always)]
            || self.encoded(words),
        );
    }

    #[inline(always)]
    fn encoded(&self, words: &mut [LaneCodes]) {
        with_encoding!(self.encoding, |known| self.joined(known, words));
    }

    #[inline(always)]
    fn joined(&self, encoding: ChannelEncoding, words: &mut [LaneCodes]) {
        match self.join {
            Join::Sum => self.each(encoding, Join::Sum, words),
            Join::Least => self.each(encoding, Join::Least, words),
            Join::Most => self.each(encoding, Join::Most, words),
        }
    }

    #[inline(always)]
    fn each(&self, encoding: ChannelEncoding, join: Join, words: &mut [LaneCodes]) {
        let mut plain = Plain::<1>;
        let read = if self.reads { u32::MAX } else { 0 };
        let Self {
            field,
            factor,
            source,
            ..
        } = *self;
        // Word by word, because loops over groups of lanes become gathers and scatters.
        for word in words.as_flattened_mut() {
            let value = plain.decode(encoding, [field.code(*word)]);
            let [value] = plain.blend_operand(encoding, value);
            let stored = f32::from_bits(value.to_bits() & read);
            let value = match join {
                Join::Sum => source + stored * factor,
                Join::Least if source < stored => source,
                Join::Most if source > stored => source,
                Join::Least | Join::Most => stored,
            };
            let [code] = plain.encode(encoding, [value]);
            *word = field.replaced(*word, code);
        }
    }
}
