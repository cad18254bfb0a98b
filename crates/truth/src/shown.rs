//! Pictures to look at: red, green and blue in 8 bits.

use super::TruthPicture;
use super::distance::{decode, quantized};
use etalon_frame::Image;

impl TruthPicture {
    /// Red, green and blue of each texel, row by row from the top, values 0 to 1 as 0 to 255.
    pub fn shown(&self) -> Vec<u8> {
        self.rgb.iter().flatten().map(|v| quantized(*v)).collect()
    }
}

/// A colour image as [`TruthPicture::shown`]: of each texel the first sample, channels that it has not
/// as 0. An image whose codes are not as many as its size asks for gives what there is.
pub fn shown(image: &Image) -> Vec<u8> {
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
