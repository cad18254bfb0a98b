//! The distance of a picture from the truth.

use serde::{Deserialize, Serialize};

/// The distance of a picture from the truth over red, green and blue, in units of full brightness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distance {
    /// Root of the mean squared difference over all texels and channels.
    pub rmse: f64,
    /// The largest difference of any channel.
    pub max: f64,
    /// Mean of the FLIP difference (Andersson and others 2020) at 67 pixels per degree, 0 to 1. FLIP takes
    /// 8-bit sRGB: values are clamped to 0 to 1 and rounded to codes without the sRGB curve, as if a display
    /// showed them that way.
    pub flip: f64,
    /// Fraction of texels that differ by more than 2 of 255 in some channel, 0 to 1.
    pub wrong: f64,
    /// The largest error of the truth itself in any channel of any texel: 0 if it is in closed form.
    pub truth_error: f64,
}

/// The distance of a frame from the truth on a lattice of its texels, in units of full brightness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SizedDistance {
    /// The number of texels that were compared.
    pub texels: u64,
    /// Root of the mean squared difference over these texels and red, green and blue.
    pub rmse: f64,
    /// The largest difference of any channel.
    pub max: f64,
}
