//! How far a picture that came back lies from the truth.

use super::TruthPicture;
use etalon_frame::{Aspect, ChannelEncoding, Distance, Image};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, flip};

/// A texel is wrong from this difference of a channel on. The small part is for rounding: two whole
/// codes of 255 are not more than two.
const WRONG: f64 = 2.0 / 255.0 + 1e-9;

/// Measures how far a picture lies from the truth: its red, green and blue values as its codes stand
/// for them (linear ones, of sRGB codes), a channel that it has not as 0, alpha not at all.
///
/// A value that is not finite differs by 1, and for FLIP it is an infinity's end of 0 to 1, of a NaN
/// the end that is farther from the truth.
///
/// `None` where there is nothing to measure: the image is not colour, has several samples or integer
/// channels, is not of the truth's size, or is empty.
pub fn distance(truth: &TruthPicture, picture: &Image) -> Option<Distance> {
    let [width, height] = picture.size;
    let texels = truth.rgb.len();
    let comparable = picture.aspect == Aspect::Color
        && picture.samples == 1
        && picture.size == truth.size
        && texels > 0
        && texels == width as usize * height as usize
        && !picture.channels.is_empty()
        && !picture.channels.iter().any(|c| matches!(c, ChannelEncoding::Uint(_)))
        && picture.codes.len() == picture.expected_len()
        // Sizes go to FLIP as signed 32-bit integers.
        && texels < i32::MAX as usize / 3;
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
            is.push(match value.is_nan() {
                true if expected >= 0.5 => 0,
                true => 255,
                false => quantized(value),
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

pub(super) fn decode(encoding: ChannelEncoding, code: u32) -> f64 {
    if encoding.is_nan(code) {
        return f64::NAN;
    }
    encoding.value_of_order(encoding.order_of_code(code))
}

/// The nearest of 256 steps from 0 to 1.
pub(super) fn quantized(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn mean_flip([width, height]: [u32; 2], should: &[u8], is: &[u8]) -> f64 {
    let [should, is] = [should, is].map(|rgb| FlipImageRgb8::with_data(width, height, rgb));
    let differences = flip(should, is, DEFAULT_PIXELS_PER_DEGREE).to_vec();
    let sum: f64 = differences.iter().map(|&d| f64::from(d)).sum();
    sum / differences.len() as f64
}
