//! The depths of a triangle.

use super::triangle::{RasterTriangle, point};
use crate::lanes::{LANES, LaneCodes};
use crate::linear::UNITS;
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::DepthPlane;
use etalon_scene::Draw;

/// Returns a depth plus its bias, clamped to the viewport's range as before the depth test.
#[inline(always)]
pub(crate) fn biased(draw: &Draw, depth: f32, bias: f64) -> f32 {
    let depth = (f64::from(depth) + bias) as f32;
    Faithful.held_to_range(depth, draw.viewport.depth, draw.depth_clamp)
}

/// Clamps a depth, without the assertion of [`f32::clamp`].
#[inline(always)]
fn clamped(depth: f32, [low, high]: [f32; 2]) -> f32 {
    let depth = if depth < low { low } else { depth };
    if depth > high { high } else { depth }
}

/// The number of doubles in a vector. The compiler does not vectorize larger loops well.
const DOUBLE_LANES: usize = 8;

/// The depths of a triangle over the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depths {
    /// The place of `z`, in units of the grid.
    origin: [i32; 2],
    /// The depth at `origin`, and its change per unit of the grid to the right and down.
    z: f64,
    across: f64,
    down: f64,
    /// The least and the greatest depth of the vertices.
    ends: [f32; 2],
    bias: f64,
    range: [f32; 2],
    encoding: ChannelEncoding,
}

impl Depths {
    /// Returns the depths of a triangle with a bias.
    #[inline(always)]
    pub(crate) fn new(
        draw: &Draw,
        triangle: &RasterTriangle,
        bias: f64,
        encoding: ChannelEncoding,
    ) -> Self {
        let z = triangle.corners.map(|v| v.z);
        let points = triangle.corners.map(|v| point(v.at));
        let plane = DepthPlane::new(points, z.map(f64::from));
        let [near, far] = draw.viewport.depth;
        Self {
            origin: triangle.corners[0].at,
            z: f64::from(z[0]),
            across: plane.dx,
            down: plane.dy,
            ends: [z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2])],
            bias,
            range: [near.min(far), near.max(far)],
            encoding,
        }
    }

    /// Returns true if [`floats`](Self::floats) gives the codes: they are floats without a bias, and within
    /// all ranges.
    #[inline(always)]
    pub(crate) fn are_floats(&self) -> bool {
        let [low, high] = [self.range[0].max(0.0), self.range[1].min(1.0)];
        self.encoding == ChannelEncoding::Float32
            && self.bias == 0.0
            && self.ends[0] >= low
            && self.ends[1] <= high
    }

    /// Computes the part of the depths that depends on the column, for columns from `x` on. Their number must
    /// be a multiple of [`DOUBLE_LANES`].
    #[inline(always)]
    pub(crate) fn columns(&self, x: i32, sample: [i32; 2], columns: &mut [f64]) {
        let units = UNITS as i32;
        let mut first = x * units + sample[0] - self.origin[0];
        for columns in columns.as_chunks_mut::<DOUBLE_LANES>().0 {
            for (lane, column) in columns.iter_mut().enumerate() {
                *column = self.z + f64::from(first + lane as i32 * units) * self.across;
            }
            first += DOUBLE_LANES as i32 * units;
        }
    }

    /// Computes the codes of float depths in a row, clamped to the depths of the vertices. The number of
    /// columns must be a multiple of [`DOUBLE_LANES`].
    #[inline(always)]
    pub(crate) fn floats(&self, columns: &[f64], y: i32, sample: [i32; 2], codes: &mut [u32]) {
        let down = f64::from(y * UNITS as i32 + sample[1] - self.origin[1]) * self.down;
        let pairs = codes.as_chunks_mut::<DOUBLE_LANES>().0.iter_mut();
        for (codes, columns) in pairs.zip(columns.as_chunks::<DOUBLE_LANES>().0) {
            for (code, column) in codes.iter_mut().zip(columns) {
                let depth = clamped((column + down) as f32, self.ends);
                // Adding 0 removes the sign of a negative zero.
                *code = (depth + 0.0).to_bits();
            }
        }
    }

    /// Returns the codes at one point of the texels from column `x` on.
    #[inline(always)]
    pub(crate) fn codes(&self, x: i32, y: i32, sample: [i32; 2]) -> LaneCodes {
        let units = UNITS as i32;
        let down = f64::from(y * units + sample[1] - self.origin[1]) * self.down;
        let first = x * units + sample[0] - self.origin[0];
        let mut depths = [0.0_f32; LANES];
        for (part, depths) in depths
            .as_chunks_mut::<DOUBLE_LANES>()
            .0
            .iter_mut()
            .enumerate()
        {
            let first = first + (part * DOUBLE_LANES) as i32 * units;
            for (lane, depth) in depths.iter_mut().enumerate() {
                let across = f64::from(first + lane as i32 * units) * self.across;
                let value = clamped((self.z + across + down) as f32, self.ends);
                *depth = clamped((f64::from(value) + self.bias) as f32, self.range);
            }
        }
        Faithful.depth_codes(self.encoding, depths)
    }
}
