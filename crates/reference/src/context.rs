//! The pass for which primitives are set up, as setup and bias need it.

use crate::rules::Rules;
use crate::snap::{SubTexels, units_per_texel};
use crate::texels::Lattice;
use etalon_frame::{ChannelEncoding, Limits};

/// The inputs of primitive setup that all draws of a pass share.
pub(crate) struct PassContext<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) limits: &'a Limits,
    /// The size of the pass's attachments.
    pub(crate) size: [u32; 2],
    /// The samples per texel of the attachments.
    pub(crate) samples: u32,
    /// True if triangles that miss all judged samples are kept too, for stories.
    pub(crate) keeps_misses: bool,
    /// The judged texels of the attachments.
    pub(crate) lattice: Lattice,
    /// The encoding of the pass's depth, if it has one.
    pub(crate) depth: Option<ChannelEncoding>,
}

impl PassContext<'_> {
    pub(crate) fn sub_texels(&self) -> SubTexels<'_> {
        SubTexels {
            units: units_per_texel(self.limits),
            bits: &self.rules.sub_pixel_bits,
        }
    }

    /// Returns the step of the adapter's grid in sub-texel units.
    pub(crate) fn step(&self) -> i64 {
        self.sub_texels().step()
    }
}
