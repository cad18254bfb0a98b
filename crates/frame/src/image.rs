//! Frames: images and counts that came back from a device.

use crate::encoding::ChannelEncoding;
use crate::format::Aspect;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The way an image reached the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ReadPath {
    /// The API copied the attachment's codes.
    Copy,
    /// A shader read the attachment and stored the values. A normalized depth arrives as a 32-bit float,
    /// whose rounding the legal set includes.
    Shader,
}

/// One aspect of one attachment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Image {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// The aspect that was read; depth and stencil of one attachment are two images.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// The encodings of the channels in `codes`: as stored, or as a shader read delivers them.
    pub channels: Vec<ChannelEncoding>,
    /// The way the codes were read.
    pub read: ReadPath,
    /// Codes, index `((y * width + x) * samples + sample) * channels + channel`, row 0 at the top.
    #[serde(with = "crate::code_bytes")]
    pub codes: Vec<u32>,
}

impl Image {
    /// Returns the number of codes that follows from size, samples and channels.
    pub fn expected_len(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize * self.samples as usize * self.channels.len()
    }

    /// Returns the codes of one sample, one per channel. The position must be inside the image.
    pub fn sample(&self, x: u32, y: u32, sample: u32) -> &[u32] {
        let n = self.channels.len();
        let start = ((y as usize * self.size[0] as usize + x as usize) * self.samples as usize
            + sample as usize)
            * n;
        &self.codes[start..start + n]
    }
}

/// Everything that a scene reads back.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Frame {
    /// The images, in the order of the scene's `read` list, depth before stencil.
    pub images: Vec<Image>,
    /// The counts, in the order of the scene's counters.
    pub counters: Vec<u64>,
}

/// A frame with another shape than requested: a bug of the backend, never of the driver.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FrameError {
    /// The frame and the legal set have different numbers of images.
    #[error("the frame has {actual} images, {expected} were requested")]
    ImageCount {
        /// The number of images that came back.
        actual: usize,
        /// The number of requested images.
        expected: usize,
    },
    /// The number of the frame's counts differs from the number of the legal set's counters.
    #[error("the frame has {actual} counts, {expected} were requested")]
    CounterCount {
        /// The number of counts that came back.
        actual: usize,
        /// The number of requested counts.
        expected: usize,
    },
    /// An image of the frame is not the requested one.
    #[error("image {index} of the frame is {actual}, {expected} was requested")]
    Image {
        /// Position in the frame.
        index: usize,
        /// The image that came back.
        actual: String,
        /// The requested image.
        expected: String,
    },
}
