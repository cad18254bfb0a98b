//! Meshes of many triangles that share their vertices.

use super::{Builder, MAX_VERTICES, Vertex};
use glam::DVec2;
use std::f64::consts::TAU;

/// The torus in clip space: from its axis to the middle of the tube, and the tube itself.
const RADII: [f64; 2] = [0.6, 0.3];

impl Builder {
    /// A sheet over the viewport; the indices of its triangles.
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
                // The last line stands a little before the viewport's end, but behind the last centre.
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
        let at = |column: u32, row: u32| row * (columns + 1) + column;
        Ok(quads([columns, rows], at))
    }

    /// A closed surface; the indices of its triangles.
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
        let angle = |i: u32, of: u32| TAU * f64::from(i) / f64::from(of);
        let [large, small] = RADII;
        for j in 0..tube {
            // From the outside over the far half: rows that go down from the eye.
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
        let at = |i: u32, j: u32| (j % tube) * around + i % around;
        Ok(quads([around, tube], at))
    }

    fn fits(&self, columns: u32, rows: u32) -> Result<(), String> {
        let most = MAX_VERTICES as u64;
        if u64::from(columns) * u64::from(rows) > most {
            return Err(format!("a mesh has {most} vertices at most"));
        }
        Ok(())
    }
}

/// Two triangles to each cell, cut from its bottom left to its top right corner, of a surface whose
/// vertices `at` numbers; counter-clockwise where columns count to the right and rows down.
fn quads([columns, rows]: [u32; 2], at: impl Fn(u32, u32) -> u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(6 * columns as usize * rows as usize);
    for row in 0..rows {
        for column in 0..columns {
            let (top_left, top_right) = (at(column, row), at(column + 1, row));
            let (bottom_left, bottom_right) = (at(column, row + 1), at(column + 1, row + 1));
            indices.extend([bottom_left, bottom_right, top_right]);
            indices.extend([bottom_left, top_right, top_left]);
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use crate::mesh::{Mesh, MeshSource, Primitive, Splat};
    use crate::state::PrimitiveTopology;
    use glam::DVec2;
    use std::collections::HashMap;

    fn triangles(mesh: &Mesh) -> Vec<[usize; 3]> {
        let all = mesh.primitives(PrimitiveTopology::TriangleList);
        all.into_iter()
            .map(|p| match p {
                Primitive::Triangle(t) => t,
                other => panic!("{other:?} is no triangle"),
            })
            .collect()
    }

    /// Twice the signed area in clip space, above 0 where the winding is counter-clockwise.
    fn area(mesh: &Mesh, t: [usize; 3]) -> f64 {
        let p = t.map(|i| {
            let [x, y, ..] = mesh.vertices[i].position.map(f64::from);
            DVec2::new(x, y)
        });
        (p[1] - p[0]).perp_dot(p[2] - p[0])
    }

    fn grid(cells: [u32; 2], size: [u32; 2]) -> Mesh {
        let source = MeshSource::Grid {
            cells,
            z: 0.5,
            value: Splat([1.0; 4]),
        };
        source.expand(size).expect("valid")
    }

    #[test]
    fn a_grid_covers_every_centre_once_with_room() {
        // Cells of several texels, of one, and parts of one.
        for (cells, size) in [([4, 3], [16, 12]), ([8, 8], [8, 8]), ([24, 24], [8, 8])] {
            let mesh = grid(cells, size);
            let all = triangles(&mesh);
            assert_eq!(all.len() as u32, 2 * cells[0] * cells[1]);
            assert!(all.iter().all(|t| area(&mesh, *t) > 0.0));
            let texels = |i: usize| {
                let [x, y, ..] = mesh.vertices[i].position.map(f64::from);
                DVec2::new(
                    (x + 1.0) / 2.0 * f64::from(size[0]),
                    (1.0 - y) / 2.0 * f64::from(size[1]),
                )
            };
            // The first cells' diagonals pass through centres: those of both cells share them.
            let whole = cells[0] >= size[0];
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let mut covered = 0;
                    for t in &all {
                        let p = t.map(texels);
                        let sides = [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])];
                        let distances =
                            sides.map(|(a, b)| -(b - a).normalize().perp_dot(centre - a));
                        let least = distances.into_iter().fold(f64::MAX, f64::min);
                        covered += u32::from(least > 0.0);
                        assert!(
                            !whole || least.abs() > 0.08,
                            "{cells:?} ({x}, {y}): {least}"
                        );
                    }
                    assert_eq!(covered, 1, "{cells:?} ({x}, {y})");
                }
            }
        }
    }

    #[test]
    fn a_torus_is_closed_and_faces_outwards() {
        let source = MeshSource::Torus {
            segments: [16, 12],
            value: Splat([1.0; 4]),
        };
        let mesh = source.expand([64, 64]).expect("valid");
        let all = triangles(&mesh);
        assert_eq!(all.len(), 2 * 16 * 12);
        let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
        for [a, b, c] in &all {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from, *to)).or_default() += 1;
            }
        }
        // Each edge belongs to two triangles, which run along it in opposite directions.
        for ((from, to), count) in &edges {
            assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)));
        }
        // The half that is nearer to the eye faces it.
        for t in all {
            let depth = t.map(|i| f64::from(mesh.vertices[i].position[2]));
            let nearer = depth.iter().sum::<f64>() / 3.0 < 0.5;
            assert_eq!(area(&mesh, t) > 0.0, nearer, "{t:?}");
        }
    }

    #[test]
    fn what_is_empty_or_too_large_is_refused() {
        for cells in [[0, 4], [4, 0], [5000, 5000], [u32::MAX, u32::MAX]] {
            let source = MeshSource::Grid {
                cells,
                z: 0.0,
                value: Splat::default(),
            };
            assert!(source.expand([16, 16]).is_err(), "{cells:?}");
        }
        let source = MeshSource::Torus {
            segments: [2, 8],
            value: Splat::default(),
        };
        assert!(source.expand([16, 16]).is_err());
    }
}
