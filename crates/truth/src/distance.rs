//! The distance of a picture from the truth.

use crate::flip::mean_flip;
use crate::picture::{LatticeTruth, TruthPicture};
use crate::rgb8::{decode, quantized};
use etalon_frame::{Aspect, ChannelEncoding, Distance, Image, SizedDistance};

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
    let fits = picture.size == truth.size
        && texels > 0
        && texels == width as usize * height as usize
        && is_comparable(picture);
    if !fits {
        return None;
    }
    let mut sum = Differences::default();
    let (mut should, mut is) = (
        Vec::with_capacity(3 * texels),
        Vec::with_capacity(3 * texels),
    );
    let codes = picture.codes.chunks_exact(picture.channels.len());
    for (expected, codes) in truth.rgb.iter().zip(codes) {
        let color = decoded(picture, codes);
        sum.add(expected, &color);
        for (value, &expected) in color.into_iter().zip(expected) {
            should.push(quantized(expected));
            is.push(if !value.is_nan() {
                quantized(value)
            } else if expected >= 0.5 {
                0
            } else {
                255
            });
        }
    }
    Some(Distance {
        rmse: sum.rmse(),
        max: sum.max,
        wrong: sum.wrong as f64 / texels as f64,
        flip: mean_flip(picture.size, &should, &is),
        truth_error: truth.error,
    })
}

/// Returns the distance of a frame from the truth over the texels of its lattice that are compared. Channels, values and
/// refusals are those of [`distance`].
pub fn lattice_distance(truth: &LatticeTruth, frame: &Image) -> Option<SizedDistance> {
    let lattice = truth.lattice;
    if frame.size != lattice.size || !is_comparable(frame) {
        return None;
    }
    let mut sum = Differences::default();
    let channels = frame.channels.len();
    let [columns, rows] = lattice.count();
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
    let expected = truth.picture.rgb.iter().zip(&truth.compared);
    for ([column, row], (expected, _)) in places.zip(expected).filter(|(_, (_, sure))| **sure) {
        let [x, y] = [column, row].map(|index| lattice.place(index) as usize);
        let texel = (y * lattice.size[0] as usize + x) * channels;
        sum.add(
            expected,
            &decoded(frame, &frame.codes[texel..texel + channels]),
        );
    }
    (sum.texels > 0).then(|| SizedDistance {
        texels: sum.texels,
        rmse: sum.rmse(),
        max: sum.max,
    })
}

/// Returns true if a picture has one sample of colour per texel, not integers, and all of its codes.
fn is_comparable(picture: &Image) -> bool {
    picture.aspect == Aspect::Color
        && picture.samples == 1
        && !picture.channels.is_empty()
        && !picture
            .channels
            .iter()
            .any(|c| matches!(c, ChannelEncoding::Uint(_)))
        && picture.codes.len() == picture.expected_len()
}

/// Returns red, green and blue of a texel; 0 for a channel that the picture lacks.
fn decoded(picture: &Image, codes: &[u32]) -> [f64; 3] {
    [0, 1, 2].map(|c| match (codes.get(c), picture.channels.get(c)) {
        (Some(&code), Some(&encoding)) => decode(encoding, code),
        _ => 0.0,
    })
}

/// The sum of differences from the truth.
#[derive(Clone, Copy, Debug, Default)]
struct Differences {
    texels: u64,
    squares: f64,
    max: f64,
    /// The number of texels that differ by more than [`WRONG`].
    wrong: u64,
}

impl Differences {
    fn add(&mut self, expected: &[f64; 3], color: &[f64; 3]) {
        let mut worst: f64 = 0.0;
        for (value, expected) in color.iter().zip(expected) {
            let difference = (value - expected).abs();
            let difference = if difference.is_finite() {
                difference
            } else {
                1.0
            };
            self.squares += difference * difference;
            worst = worst.max(difference);
        }
        self.max = self.max.max(worst);
        self.wrong += u64::from(worst > WRONG);
        self.texels += 1;
    }

    fn rmse(&self) -> f64 {
        (self.squares / (3 * self.texels) as f64).sqrt()
    }
}
