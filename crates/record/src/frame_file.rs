//! Files of frames that are not entirely right, with their legal values.

use etalon_frame::{Aspect, ChannelEncoding};
use serde::{Deserialize, Serialize};

/// A frame, the lowest and highest legal value of each channel, and the description of the case.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameFile {
    /// The case's id.
    pub case: String,
    /// The adapter's name.
    pub adapter: String,
    /// The `about` text of the case file.
    pub about: String,
    /// The sections of the specifications that the case file names.
    pub spec: Vec<String>,
    /// The images, in the order of the scene's `read` list.
    pub images: Vec<FrameImage>,
}

/// One aspect of one attachment. `low`, `high` and `actual` have the index
/// `((y * width + x) * samples + sample) * channels + channel`, row 0 at the top.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameImage {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// The aspect that was read; depth and stencil of one attachment are two images.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// The encodings in which the codes of each channel are bit patterns.
    pub channels: Vec<ChannelEncoding>,
    /// Codes of the lowest legal values; for an open sample, the lowest codes of the encoding.
    pub low: Vec<u32>,
    /// Codes of the highest legal values; for an open sample, the highest codes of the encoding.
    pub high: Vec<u32>,
    /// The codes that came back.
    pub actual: Vec<u32>,
    /// One value per sample, index `(y * width + x) * samples + sample`: [`FrameImage::FINE`],
    /// [`FrameImage::IMPRECISE`] or [`FrameImage::FAIL`].
    pub wrong: Vec<u8>,
}

impl FrameImage {
    /// Inside the yardstick, or open.
    pub const FINE: u8 = 0;
    /// Legal, but outside the yardstick.
    pub const IMPRECISE: u8 = 1;
    /// Outside the legal set.
    pub const FAIL: u8 = 2;

    /// Returns true if the lengths of the lists agree with size, samples and channels.
    pub fn is_whole(&self) -> bool {
        let texels = (self.size[0] as usize).checked_mul(self.size[1] as usize);
        let samples = texels.and_then(|t| t.checked_mul(self.samples as usize));
        let codes = samples.and_then(|s| s.checked_mul(self.channels.len()));
        samples == Some(self.wrong.len())
            && [&self.low, &self.high, &self.actual]
                .iter()
                .all(|list| codes == Some(list.len()))
    }
}
