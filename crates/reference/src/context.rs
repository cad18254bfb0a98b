//! The pass that primitives are set up for.

use crate::rules::Rules;
use crate::texels::Lattice;
use etalon_frame::{ChannelEncoding, Limits};

/// What [`draw`] needs to know besides the draw.
pub(crate) struct PassContext<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) limits: &'a Limits,
    /// The size of the pass's attachments.
    pub(crate) size: [u32; 2],
    /// Which of their texels are looked at.
    pub(crate) lattice: Lattice,
    /// The encoding of the pass's depth, where it has one.
    pub(crate) depth: Option<ChannelEncoding>,
}
