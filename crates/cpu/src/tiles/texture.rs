//! Textures whose nearest texels are stored unchanged.

use super::image::TiledImage;
use super::triangle::{RasterTriangle, point};
use crate::lanes::{LANES, LaneCodes, Real};
use crate::linear::{CENTER, UNITS};
use etalon_pipeline::{DepthPlane, texel_position};
use etalon_scene::{AddressMode, Draw};

/// Whole numbers below this limit have 22 bits, and stay exact as floats if three times the limit is added.
const WHOLE: f32 = 4_194_304.0;

/// A texture's texels, row by row.
#[derive(Debug)]
pub(crate) struct TexelRows {
    width: usize,
    height: usize,
    texels: Vec<u32>,
}

impl TexelRows {
    /// Returns the texels of an image that has one sample and one word per texel.
    pub(crate) fn new(image: &TiledImage) -> Self {
        let (width, height) = (image.width, image.height);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texel = |(x, y)| match image.color.cleared(image.tile(x, y)) {
            Some([value, ..]) => value,
            None => image.color.texels[image.place(x, y, 0)],
        };
        Self {
            width,
            height,
            texels: places.map(texel).collect(),
        }
    }

    /// Returns the texels at one coordinate per lane.
    #[inline(always)]
    pub(crate) fn nearest(&self, address: [AddressMode; 2], [u, v]: [Real; 2]) -> LaneCodes {
        let columns = positions(address[0], u, self.width);
        let rows = positions(address[1], v, self.height);
        let mut result = [0; LANES];
        // Most textures are upright, so that a span has one row.
        if rows == [rows[0]; LANES] {
            let row = &self.texels[rows[0] as usize * self.width..][..self.width];
            for (texel, x) in result.iter_mut().zip(columns) {
                *texel = row[x as usize];
            }
            return result;
        }
        for ((texel, x), y) in result.iter_mut().zip(columns).zip(rows) {
            *texel = self.texels[y as usize * self.width + x as usize];
        }
        result
    }
}

/// Returns the texel positions along an axis, at one coordinate per lane.
#[inline(always)]
fn positions(mode: AddressMode, coordinate: Real, size: usize) -> LaneCodes {
    let mut scaled = [0.0; LANES];
    for (scaled, c) in scaled.iter_mut().zip(coordinate) {
        *scaled = (c * size as f32).floor();
    }
    let small = scaled
        .iter()
        .fold(true, |small, v| small & (v.abs() < WHOLE));
    let mut result = [0; LANES];
    if mode == AddressMode::Repeat && size.is_power_of_two() && small {
        for (place, v) in result.iter_mut().zip(scaled) {
            // The low bits of the sum are the low bits of the whole number.
            *place = (v + 3.0 * WHOLE).to_bits() & (size as u32 - 1);
        }
    } else {
        for (place, v) in result.iter_mut().zip(scaled) {
            *place = texel_position(mode, v as i64, size as u32) as u32;
        }
    }
    result
}

/// The texture coordinates of a triangle over the window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coordinates {
    origin: [i32; 2],
    /// For each axis, the value at the origin and its increments per unit to the right and down.
    axes: [[f64; 3]; 2],
}

impl Coordinates {
    #[inline(always)]
    pub(crate) fn new(draw: &Draw, triangle: &RasterTriangle, vertices: &[u32; 3]) -> Self {
        let points = triangle.corners.map(|v| point(v.at));
        let uv = vertices.map(|i| draw.mesh.vertices[i as usize].uv);
        let axis = |axis: usize| {
            let values = uv.map(|uv| f64::from(uv[axis]));
            let plane = DepthPlane::new(points, values);
            [values[0], plane.dx, plane.dy]
        };
        Self {
            origin: triangle.corners[0].at,
            axes: [axis(0), axis(1)],
        }
    }

    /// Returns the coordinates at the centres of consecutive texels.
    #[inline(always)]
    pub(crate) fn at(&self, x: i32, y: i32) -> [Real; 2] {
        let units = UNITS as i32;
        let first = x * units + CENTER.x as i32 - self.origin[0];
        let down = f64::from(y * units + CENTER.y as i32 - self.origin[1]);
        let mut result = [[0.0; LANES]; 2];
        for (values, [start, growth, growth_down]) in result.iter_mut().zip(self.axes) {
            let down = down * growth_down;
            for (lane, value) in values.iter_mut().enumerate() {
                let across = f64::from(first + lane as i32 * units) * growth;
                *value = (start + across + down) as f32;
            }
        }
        result
    }
}
