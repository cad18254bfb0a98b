//! The values that a frame must have if the bug is absent.

use etalon_frame::{Aspect, ChannelEncoding, CountRange};

/// The values to check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Due {
    /// Samples of texels.
    pub texels: Vec<DueTexel>,
    /// Counters.
    pub counters: Vec<DueCounter>,
}

/// A sample, and its permitted values.
#[derive(Clone, Debug, PartialEq)]
pub struct DueTexel {
    /// The column, counted from the left.
    pub x: u32,
    /// The row, counted from the top.
    pub y: u32,
    /// The sample, counted from 0.
    pub sample: u32,
    /// The channels that are read.
    pub channels: Vec<DueChannel>,
    /// The permitted outcomes. Each has the lowest and the highest order of each channel. The sample is
    /// right if it is within any outcome.
    pub allowed: Vec<Vec<[i64; 2]>>,
}

/// A channel of an attachment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DueChannel {
    /// The attachment's name.
    pub attachment: String,
    /// The aspect.
    pub aspect: Aspect,
    /// The channel's index in its image.
    pub channel: usize,
    /// The encoding.
    pub encoding: ChannelEncoding,
}

/// A counter, and its permitted counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DueCounter {
    /// The name.
    pub name: String,
    /// The index among the scene's counters.
    pub index: usize,
    /// The permitted counts.
    pub range: CountRange,
}

impl DueChannel {
    /// Returns the channel's name, `red of color`; depth and stencil have the aspect's name.
    pub(crate) fn name(&self) -> String {
        format!(
            "{} of {}",
            self.aspect.channel(self.channel),
            self.attachment
        )
    }
}
