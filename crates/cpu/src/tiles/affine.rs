//! Blends in which all but the destination's own channel is constant, in texels of several words.
//!
//! A term is what the pipeline's plain arithmetic does, with its constants computed once; planes are gone through
//! channel by channel, each with the code of its encoding.

use super::fragments::Fragments;
use super::image::AREA;
use super::planes::with_encoding;
use crate::lanes::Codes;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use fearless_simd::Simd;

/// A function of the codes of each channel.
#[derive(Debug)]
pub(crate) struct Affine {
    pub(crate) terms: [Option<Term>; 4],
}

/// The function of a channel that is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) encoding: ChannelEncoding,
    pub(crate) join: Join,
    /// False if 0 stands for the destination.
    pub(crate) reads: bool,
    /// The destination's factor.
    pub(crate) factor: f32,
    /// The product of the source and its factor.
    pub(crate) source: f32,
}

/// A way to join the source with the destination.
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
        for (channel, term) in self.terms.iter().enumerate() {
            if let Some(term) = term {
                fragments.replace(simd, &mut planes[channel * AREA..], |new| {
                    term.apply(simd, new)
                });
            }
        }
    }

    /// Applies the function to the first texels of a sample's planes, whose number is a multiple of
    /// [`LANES`](crate::lanes::LANES).
    #[inline(always)]
    pub(crate) fn whole<S: Simd>(&self, simd: S, planes: &mut [u32], count: usize) {
        for (channel, term) in self.terms.iter().enumerate() {
            if let Some(term) = term {
                let (lanes, _) = planes[channel * AREA..][..count].as_chunks_mut();
                term.apply(simd, lanes);
            }
        }
    }
}

impl Term {
    /// Applies the function to codes. A function of its own: it is large.
    #[inline(never)]
    fn apply<S: Simd>(&self, simd: S, codes: &mut [Codes]) {
        simd.vectorize(
            #[inline(always)]
            || self.encoded(codes),
        );
    }

    #[inline(always)]
    fn encoded(&self, codes: &mut [Codes]) {
        with_encoding!(self.encoding, |known| self.joined(known, codes));
    }

    #[inline(always)]
    fn joined(&self, encoding: ChannelEncoding, codes: &mut [Codes]) {
        match self.join {
            Join::Sum => self.each(encoding, Join::Sum, codes),
            Join::Least => self.each(encoding, Join::Least, codes),
            Join::Most => self.each(encoding, Join::Most, codes),
        }
    }

    #[inline(always)]
    fn each(&self, encoding: ChannelEncoding, join: Join, codes: &mut [Codes]) {
        let mut plain = Plain::<1>;
        let read = if self.reads { u32::MAX } else { 0 };
        let Self { factor, source, .. } = *self;
        // One by one: loops over groups of lanes become gathers and scatters.
        for code in codes.as_flattened_mut() {
            let value = plain.decode(encoding, [*code]);
            let [value] = plain.blend_operand(encoding, value);
            let stored = f32::from_bits(value.to_bits() & read);
            let value = match join {
                Join::Sum => source + stored * factor,
                Join::Least if source < stored => source,
                Join::Most if source > stored => source,
                Join::Least | Join::Most => stored,
            };
            [*code] = plain.encode(encoding, [value]);
        }
    }
}
