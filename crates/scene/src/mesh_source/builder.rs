//! Triangles over the texels of a viewport.

use super::splat::Splat;
use crate::mesh::Vertex;
use crate::rasterization::FrontFace;
use glam::{DVec2, DVec4};

/// The vertices of a mesh while it is being built.
pub(super) struct Builder {
    pub(super) size: [u32; 2],
    pub(super) vertices: Vec<Vertex>,
}

impl Builder {
    pub(super) fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            vertices: Vec::new(),
        }
    }

    /// Adds one triangle that reaches far beyond the viewport.
    pub(super) fn cover(&mut self, z: f32, value: [f32; 4], uv: [f32; 4]) {
        let [left, top, right, bottom] = uv;
        for [x, y] in [[-2.0, -2.0], [8.0, -2.0], [-2.0, 8.0]] {
            self.vertices.push(Vertex {
                position: [x, y, z, 1.0],
                color: value,
                uv: [
                    left + (right - left) * (x + 1.0) / 2.0,
                    top + (bottom - top) * (1.0 - y) / 2.0,
                ],
            });
        }
    }

    pub(super) fn bands(
        &mut self,
        values: &[Splat],
        z: &[f32],
        windings: &[FrontFace],
        columns: bool,
    ) -> Result<(), String> {
        if values.is_empty() || z.is_empty() || windings.is_empty() {
            return Err("`values`, `z` and `windings` must not be empty".to_owned());
        }
        let n = values.len() as u64;
        let length = u64::from(self.size[usize::from(!columns)]);
        if n > length {
            return Err(format!("{n} parts do not fit into {length} texels"));
        }
        let edge = |i: u64| (i * length / n) as u32;
        for (i, value) in values.iter().enumerate() {
            let (a, b) = (edge(i as u64), edge(i as u64 + 1));
            let texels = if columns {
                [a, 0, b, self.size[1]]
            } else {
                [0, a, self.size[0], b]
            };
            self.rect(
                texels,
                z[i % z.len()],
                value.0,
                windings[i % windings.len()],
            )?;
        }
        Ok(())
    }

    /// Covers a rectangle with squares, the largest first: only the diagonal of a square can avoid all texel
    /// centres.
    pub(super) fn rect(
        &mut self,
        texels: [u32; 4],
        z: f32,
        value: [f32; 4],
        winding: FrontFace,
    ) -> Result<(), String> {
        let [left, top, right, bottom] = texels;
        if left >= right || top >= bottom || right > self.size[0] || bottom > self.size[1] {
            return Err(format!(
                "rectangle {texels:?} is empty or reaches outside {:?}",
                self.size
            ));
        }
        let (mut x, mut y) = (left, top);
        while x < right && y < bottom {
            let (w, h) = (right - x, bottom - y);
            let side = w.min(h);
            if w >= h {
                self.square(x, y, side, z, value, winding);
                x += side;
            } else {
                self.square(x, y, side, z, value, winding);
                y += side;
            }
        }
        Ok(())
    }

    /// Returns the clip-space position of a point in texels.
    pub(super) fn clip(&self, texels: DVec2, z: f32) -> [f32; 4] {
        let size = DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]));
        let ndc = (texels / size * 2.0 - 1.0) * DVec2::new(1.0, -1.0);
        DVec4::new(ndc.x, ndc.y, f64::from(z), 1.0)
            .as_vec4()
            .to_array()
    }

    /// Adds two triangles over the square of texels from (x, y) on. With y down, the corners are offset from
    /// the square's by (0, -1/4) bottom left, (0, 0) bottom right, (-1/4, 0) top right and (0, 0) top left.
    /// The diagonal is then 0.177 texels away from the nearest centres, and no texel outside is covered.
    pub(super) fn square(
        &mut self,
        x: u32,
        y: u32,
        side: u32,
        z: f32,
        value: [f32; 4],
        winding: FrontFace,
    ) {
        let (x0, y0) = (f64::from(x), f64::from(y));
        let (x1, y1) = (x0 + f64::from(side), y0 + f64::from(side));
        let bottom_left = DVec2::new(x0, y1 - 0.25);
        let bottom_right = DVec2::new(x1, y1);
        let top_right = DVec2::new(x1 - 0.25, y0);
        let top_left = DVec2::new(x0, y0);
        let mut corners = [
            bottom_left,
            bottom_right,
            top_right,
            bottom_left,
            top_right,
            top_left,
        ];
        if winding == FrontFace::Cw {
            corners.reverse();
        }
        for corner in corners {
            let position = self.clip(corner, z);
            self.vertices.push(Vertex {
                position,
                color: value,
                uv: [0.0; 2],
            });
        }
    }
}
