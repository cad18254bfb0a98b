//! Values that are linear over the window, in sub-texel units.

use crate::lanes::LANES;
use etalon_pipeline::{DepthPlane, Point};

/// Bits of sub-pixel precision.
pub(crate) const SUB_PIXEL_BITS: u8 = 8;

/// The number of sub-texel units per texel.
pub(crate) const UNITS: i64 = 1 << SUB_PIXEL_BITS;

/// A value that is linear over the window.
#[derive(Clone, Copy)]
pub(crate) struct Linear(pub(crate) DepthPlane);

impl Linear {
    /// Returns the values at one point of each of a span's texels.
    pub(crate) fn at(&self, x: usize, y: usize, point: Point) -> [f32; LANES] {
        std::array::from_fn(|lane| self.0.at(position(x + lane, y, point)) as f32)
    }
}

/// The centre of a texel.
pub(crate) const CENTER: Point = Point {
    x: UNITS / 2,
    y: UNITS / 2,
};

/// Returns a position in a texel in sub-texel units of the window.
pub(crate) fn position(x: usize, y: usize, sample: Point) -> Point {
    Point {
        x: x as i64 * UNITS + sample.x,
        y: y as i64 * UNITS + sample.y,
    }
}
