//! Attachments in memory: one plane of codes per channel, rows padded to whole spans.

use crate::depth_encoding;
use crate::span::LANES;
use crate::steps::Steps;
use etalon_case::scene::{Attachment, Contents};
use etalon_frame::Aspect;

/// One attachment.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Texels from one row to the next: the width rounded up to whole spans.
    pub(crate) stride: usize,
    /// Colour channels, or the depth alone.
    pub(crate) planes: Vec<Vec<u32>>,
    /// Stencil; empty where the format has none.
    pub(crate) stencil: Vec<u8>,
}

impl Surface {
    /// The attachment as it is before the first pass.
    pub(crate) fn new(attachment: &Attachment, steps: &impl Steps) -> Self {
        let [width, height] = attachment.size.map(|s| s as usize);
        let stride = width.next_multiple_of(LANES);
        let format = attachment.format;
        let texels = stride * height;
        let mut surface = Self {
            width,
            height,
            stride,
            planes: Vec::new(),
            stencil: Vec::new(),
        };
        match &attachment.contents {
            Contents::Color(color) => {
                for (encoding, value) in format.color_channels().iter().zip(color) {
                    let code = steps.clear_code(*encoding, *value);
                    surface.planes.push(vec![code; texels]);
                }
            }
            Contents::DepthStencil { depth, stencil } => {
                if let Some(encoding) = depth_encoding(format) {
                    let code = steps.clear_code(encoding, *depth);
                    surface.planes.push(vec![code; texels]);
                }
                if format.has_stencil() {
                    surface.stencil = vec![*stencil; texels];
                }
            }
            Contents::Texels(codes) => {
                let channels = format.color_channels().len();
                for c in 0..channels {
                    let mut plane = vec![0; texels];
                    for (i, texel) in codes.chunks_exact(channels).enumerate() {
                        plane[i / width * stride + i % width] = texel[c];
                    }
                    surface.planes.push(plane);
                }
            }
        }
        surface
    }

    /// The codes of one aspect, as an [`etalon_frame::Image`] holds them.
    pub(crate) fn codes(&self, aspect: Aspect) -> Vec<u32> {
        let channels = if aspect == Aspect::Stencil {
            1
        } else {
            self.planes.len()
        };
        let mut codes = Vec::with_capacity(self.width * self.height * channels);
        for y in 0..self.height {
            for x in 0..self.width {
                let at = y * self.stride + x;
                if aspect == Aspect::Stencil {
                    codes.push(u32::from(self.stencil[at]));
                } else {
                    codes.extend(self.planes.iter().map(|plane| plane[at]));
                }
            }
        }
        codes
    }
}
