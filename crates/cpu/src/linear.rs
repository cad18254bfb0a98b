//! Values over primitives, in sub-texel units.

use crate::lanes::LANES;
use etalon_pipeline::{DepthPlane, Point};

/// Bits of sub-pixel precision.
pub(crate) const SUB_PIXEL_BITS: u8 = 8;

/// The number of sub-texel units per texel.
pub(crate) const UNITS: i64 = 1 << SUB_PIXEL_BITS;

/// A value over a primitive.
#[derive(Clone, Copy)]
pub(crate) struct LinearVarying {
    /// The value, or, if `reciprocal_w` is present, the value over w.
    value: DepthPlane,
    /// 1 over w, if the value is linear in space.
    reciprocal_w: Option<DepthPlane>,
}

impl LinearVarying {
    /// Returns a value that is linear over the window.
    pub(crate) fn linear(value: DepthPlane) -> Self {
        Self {
            value,
            reciprocal_w: None,
        }
    }

    /// Returns a value that is linear in space, from the plane of the value over w and the plane of 1 over w.
    pub(crate) fn perspective(value: DepthPlane, reciprocal_w: DepthPlane) -> Self {
        let reciprocal_w = Some(reciprocal_w);
        Self {
            value,
            reciprocal_w,
        }
    }

    /// Returns the values at one point of each texel of a span.
    pub(crate) fn at(&self, x: usize, y: usize, points: &[Point; LANES]) -> [f32; LANES] {
        std::array::from_fn(|lane| {
            let point = position(x + lane, y, points[lane]);
            let value = self.value.at(point);
            match self.reciprocal_w {
                None => value as f32,
                Some(reciprocal_w) => (value / reciprocal_w.at(point)) as f32,
            }
        })
    }
}

/// The centre of a texel.
pub(crate) const CENTER: Point = Point {
    x: UNITS / 2,
    y: UNITS / 2,
};

/// Returns a position in a texel, in sub-texel units of the window.
pub(crate) fn position(x: usize, y: usize, sample: Point) -> Point {
    Point {
        x: x as i64 * UNITS + sample.x,
        y: y as i64 * UNITS + sample.y,
    }
}
