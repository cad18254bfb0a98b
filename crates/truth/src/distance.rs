//! The distance of a picture from the truth.

use crate::flip::mean_flip;
use crate::picture::TruthPicture;
use crate::rgb8::{decode, quantized};
use etalon_frame::{Aspect, ChannelEncoding, Distance, Image};

/// The difference of a channel above which a texel counts as wrong: two codes of 255, plus a margin for
/// rounding.
const WRONG: f64 = 2.0 / 255.0 + 1e-9;

/// Returns the distance of a picture from the truth, over the linear values of red, green and blue. A missing
/// channel counts as 0; alpha is ignored.
///
/// A value that is not finite differs by 1. For FLIP, infinities are clamped to 0 to 1, and a NaN becomes
/// whichever of 0 and 1 is farther from the truth.
///
/// Returns `None` if the picture cannot be measured: the image is not colour, has several samples or integer
/// channels, differs from the truth in size, or is empty.
pub fn distance(truth: &TruthPicture, picture: &Image) -> Option<Distance> {
    let [width, height] = picture.size;
    let texels = truth.rgb.len();
    let comparable = picture.aspect == Aspect::Color
        && picture.samples == 1
        && picture.size == truth.size
        && texels > 0
        && texels == width as usize * height as usize
        && !picture.channels.is_empty()
        && !picture
            .channels
            .iter()
            .any(|c| matches!(c, ChannelEncoding::Uint(_)))
        && picture.codes.len() == picture.expected_len();
    if !comparable {
        return None;
    }
    let mut result = Distance {
        truth_error: truth.error,
        ..Distance::default()
    };
    let (mut squares, mut wrong) = (0.0, 0_usize);
    let (mut should, mut is) = (
        Vec::with_capacity(3 * texels),
        Vec::with_capacity(3 * texels),
    );
    let codes = picture.codes.chunks_exact(picture.channels.len());
    for (expected, codes) in truth.rgb.iter().zip(codes) {
        let mut worst: f64 = 0.0;
        for (c, &expected) in expected.iter().enumerate() {
            let value = match (codes.get(c), picture.channels.get(c)) {
                (Some(&code), Some(&encoding)) => decode(encoding, code),
                _ => 0.0,
            };
            let difference = (value - expected).abs();
            let difference = if difference.is_finite() {
                difference
            } else {
                1.0
            };
            squares += difference * difference;
            worst = worst.max(difference);
            should.push(quantized(expected));
            is.push(if !value.is_nan() {
                quantized(value)
            } else if expected >= 0.5 {
                0
            } else {
                255
            });
        }
        result.max = result.max.max(worst);
        wrong += usize::from(worst > WRONG);
    }
    result.rmse = (squares / (3 * texels) as f64).sqrt();
    result.wrong = wrong as f64 / texels as f64;
    result.flip = mean_flip(picture.size, &should, &is);
    Some(result)
}
