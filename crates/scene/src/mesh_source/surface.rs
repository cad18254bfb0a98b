//! Meshes of many triangles that share their vertices.

use super::builder::Builder;
use crate::mesh::{MAX_VERTICES, Vertex};
use glam::DVec2;
use std::f64::consts::TAU;

/// The radii of the torus in clip space: from its axis to the middle of the tube, and of the tube.
const RADII: [f64; 2] = [0.6, 0.3];

impl Builder {
    /// Adds a sheet over the viewport and returns the indices of its triangles.
    pub(super) fn grid(
        &mut self,
        cells: [u32; 2],
        z: f32,
        value: [f32; 4],
    ) -> Result<Vec<u32>, String> {
        let [columns, rows] = cells;
        self.fits(columns.saturating_add(1), rows.saturating_add(1))?;
        if columns == 0 || rows == 0 {
            return Err("a grid has at least one cell each way".to_owned());
        }
        let lines = |axis: usize| -> Vec<f64> {
            let (count, length) = (cells[axis], f64::from(self.size[axis]));
            let step = length / f64::from(count);
            let shift = step.min(1.0) / 4.0;
            let line = |i: u32| match i {
                0 => 0.0,
                // The last line is slightly before the viewport's end, but past the last centre.
                i => f64::from(i) * length / f64::from(count) - shift,
            };
            (0..=count).map(line).collect()
        };
        let (across, down) = (lines(0), lines(1));
        for y in &down {
            for x in &across {
                let position = self.clip(DVec2::new(*x, *y), z);
                self.vertices.push(Vertex {
                    position,
                    color: value,
                    uv: [0.0; 2],
                });
            }
        }
        let vertex = |column: u32, row: u32| row * (columns + 1) + column;
        Ok(quads([columns, rows], vertex))
    }

    /// Adds a torus and returns the indices of its triangles.
    pub(super) fn torus(
        &mut self,
        segments: [u32; 2],
        value: [f32; 4],
    ) -> Result<Vec<u32>, String> {
        let [around, tube] = segments;
        if around < 3 || tube < 3 {
            return Err("a torus has at least 3 segments each way".to_owned());
        }
        self.fits(around, tube)?;
        let angle = |i: u32, segments: u32| TAU * f64::from(i) / f64::from(segments);
        let [large, small] = RADII;
        for j in 0..tube {
            // Starts at the outside and goes over the far half first, so the first rows move away from the
            // eye.
            let (height, out) = (-angle(j, tube)).sin_cos();
            for i in 0..around {
                let (y, x) = angle(i, around).sin_cos();
                let radius = large + small * out;
                // Depth grows away from the eye.
                let depth = 0.5 - small * height;
                let position = [x * radius, y * radius, depth, 1.0];
                self.vertices.push(Vertex {
                    position: position.map(|v| v as f32),
                    color: value,
                    uv: [0.0; 2],
                });
            }
        }
        let vertex = |i: u32, j: u32| (j % tube) * around + i % around;
        Ok(quads([around, tube], vertex))
    }

    fn fits(&self, columns: u32, rows: u32) -> Result<(), String> {
        let most = MAX_VERTICES as u64;
        if u64::from(columns) * u64::from(rows) > most {
            return Err(format!("a mesh has {most} vertices at most"));
        }
        Ok(())
    }
}

/// Returns two triangles for each cell of a surface, cut from bottom left to top right; `vertex` gives the
/// vertices' indices. They are counter-clockwise if columns go right and rows go down.
fn quads([columns, rows]: [u32; 2], vertex: impl Fn(u32, u32) -> u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(6 * columns as usize * rows as usize);
    for row in 0..rows {
        for column in 0..columns {
            let (top_left, top_right) = (vertex(column, row), vertex(column + 1, row));
            let (bottom_left, bottom_right) =
                (vertex(column, row + 1), vertex(column + 1, row + 1));
            indices.extend([bottom_left, bottom_right, top_right]);
            indices.extend([bottom_left, top_right, top_left]);
        }
    }
    indices
}
