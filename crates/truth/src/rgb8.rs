//! Pictures in 8-bit red, green and blue, for reports.

use super::picture::TruthPicture;
use etalon_frame::{ChannelEncoding, Image};

impl TruthPicture {
    /// Returns red, green and blue of each texel, row by row from the top, with 0 to 1 as 0 to 255.
    pub fn rgb8(&self) -> Vec<u8> {
        self.rgb.iter().flatten().map(|v| quantized(*v)).collect()
    }
}

/// Returns a colour image in the layout of [`TruthPicture::rgb8`]: the first sample of each texel, with 0 for
/// a missing channel. An image with fewer codes than its size requires gives fewer texels.
pub fn rgb8(image: &Image) -> Vec<u8> {
    let channels = image.channels.len().max(1);
    let texels = image
        .codes
        .chunks_exact(channels * image.samples.max(1) as usize);
    let mut rgb = Vec::with_capacity(3 * texels.len());
    for codes in texels {
        for c in 0..3 {
            rgb.push(match (codes.get(c), image.channels.get(c)) {
                (Some(code), Some(encoding)) => quantized(decode(*encoding, *code)),
                _ => 0,
            });
        }
    }
    rgb
}

/// Returns the linear value of a code; NaN for an invalid code.
pub(super) fn decode(encoding: ChannelEncoding, code: u32) -> f64 {
    if encoding.is_nan(code) {
        return f64::NAN;
    }
    encoding.value_of_order(encoding.order_of_code(code))
}

/// Returns the nearest of 256 steps from 0 to 1.
pub(super) fn quantized(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}
