//! A strip with enough primitives to overflow a driver's batches.
//!
//! It turns at the ends of rows and has no restart, so that only a driver can split it. Every counted
//! primitive has texels of its own.

use super::builder::Builder;
use crate::mesh::Vertex;
use etalon_frame::state_enum;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::iter;

state_enum! {
    /// The primitives of a strip.
    StripOf {
        /// Counter-clockwise triangles, each over one texel, whose centre is at least 0.22 texels inside.
        /// Four triangles without area join two pairs of rows.
        Triangles = "triangles",
        /// Counter-clockwise triangles of a fan, each over one texel of the first row. Their common corner is far
        /// above.
        Fan = "fan",
        /// Lines, each along 8 texels of a row; between two of them, a line of one texel down or up. If there
        /// is more than one column, the number of rows must be odd.
        Lines = "lines",
    }
}

impl Builder {
    /// Adds the vertices of a strip with `count` primitives that cover texels of their own.
    pub(super) fn strip(
        &mut self,
        kind: StripOf,
        count: u32,
        z: f32,
        value: [f32; 4],
    ) -> Result<(), String> {
        let [width, height] = self.size;
        let [columns, rows] = match kind {
            StripOf::Triangles => [width, height / 2 * 2],
            StripOf::Fan => [width, 1],
            StripOf::Lines => [width / 8, height],
        };
        let capacity = u64::from(columns) * u64::from(rows);
        if count == 0 || u64::from(count) > capacity {
            return Err(format!("{capacity} primitives fit into {:?}", self.size));
        }
        if kind == StripOf::Lines && count > rows && rows.is_multiple_of(2) {
            return Err("lines in several columns need an odd number of rows".to_owned());
        }
        let points = match kind {
            StripOf::Triangles => triangles(width, count),
            StripOf::Fan => fan(width, count),
            StripOf::Lines => lines(rows, count),
        };
        for point in points {
            let position = self.clip(point, z);
            self.vertices.push(Vertex {
                position,
                color: value,
                uv: [0.0; 2],
            });
        }
        Ok(())
    }
}

/// Pairs of rows, each from left to right: an upper and a lower triangle in each column.
fn triangles(width: u32, count: u32) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = Vec::new();
    let mut left = count;
    for row in (0..).step_by(2) {
        let here = left.min(2 * width);
        let corner = |i: u32| DVec2::new(f64::from(i / 2), f64::from(row + i % 2 * 2));
        if let Some(last) = points.last().copied() {
            points.extend([last, corner(0)]);
        }
        points.extend((0..here + 2).map(corner));
        left -= here;
        if left == 0 {
            break;
        }
    }
    points
}

/// The corners of a fan: the common one, then the ends of texels along the first row. The sides move by an
/// eighth of a texel at most from the row's bottom to its middle.
fn fan(width: u32, count: u32) -> Vec<DVec2> {
    let apex = DVec2::new(f64::from(width / 2), f64::from(width) * -2.0);
    let ends = (0..=count).map(|x| DVec2::new(f64::from(x), 1.0));
    iter::once(apex).chain(ends).collect()
}

/// Columns, alternately downwards and upwards; within a column, rows run alternately to the right and to the
/// left.
fn lines(rows: u32, count: u32) -> Vec<DVec2> {
    let line = |i: u32| {
        let (column, step) = (i / rows, i % rows);
        let row = if column % 2 == 0 {
            step
        } else {
            rows - 1 - step
        };
        let ends = if step % 2 == 0 {
            [1.5, 6.5]
        } else {
            [6.5, 1.5]
        };
        ends.map(|x| DVec2::new(f64::from(column * 8) + x, f64::from(row) + 0.5))
    };
    (0..count).flat_map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns twice the area of each triangle of a strip, positive if counter-clockwise with y down.
    fn areas(points: &[DVec2]) -> Vec<f64> {
        let each = points.windows(3).enumerate();
        each.map(|(i, p)| {
            let area = -(p[1] - p[0]).perp_dot(p[2] - p[0]);
            if i % 2 == 0 { area } else { -area }
        })
        .collect()
    }

    #[test]
    fn every_triangle_of_a_strip_has_the_same_winding_and_a_texel_of_its_own() {
        for count in [1, 9, 10, 11, 20, 23] {
            let points = triangles(5, count);
            let areas = areas(&points);
            assert_eq!(areas.iter().filter(|a| **a > 0.0).count(), count as usize);
            assert!(areas.iter().all(|a| [0.0, 2.0].contains(a)), "{areas:?}");
            let mut covered = [[0; 5]; 6];
            for (i, p) in points.windows(3).enumerate() {
                for (y, row) in covered.iter_mut().enumerate() {
                    for (x, texel) in row.iter_mut().enumerate() {
                        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                        let turn = if i % 2 == 0 { -1.0 } else { 1.0 };
                        let side = |a: usize| {
                            let (a, b) = (p[a], p[(a + 1) % 3]);
                            let length = (b - a).length();
                            let distance = turn * (b - a).perp_dot(centre - a) / length.max(1e-9);
                            assert!(length == 0.0 || distance.abs() > 0.2 || areas[i] == 0.0);
                            distance
                        };
                        *texel += i32::from(areas[i] > 0.0 && (0..3).all(|a| side(a) > 0.0));
                    }
                }
            }
            assert_eq!(covered.iter().flatten().sum::<i32>(), count as i32);
            assert!(covered.iter().flatten().all(|n| *n <= 1), "{covered:?}");
        }
    }

    #[test]
    fn the_lines_of_a_strip_are_joined_by_lines_of_a_few_texels() {
        let points = lines(3, 8);
        let texels = points.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
        let expected = [
            [[1.5, 0.5], [6.5, 0.5]],
            [[6.5, 1.5], [1.5, 1.5]],
            [[1.5, 2.5], [6.5, 2.5]],
            [[9.5, 2.5], [14.5, 2.5]],
            [[14.5, 1.5], [9.5, 1.5]],
            [[9.5, 0.5], [14.5, 0.5]],
            [[17.5, 0.5], [22.5, 0.5]],
            [[22.5, 1.5], [17.5, 1.5]],
        ];
        assert_eq!(texels, expected.concat());
    }

    #[test]
    fn a_strip_that_does_not_fit_is_an_error() {
        let strip = |kind, size, count| Builder::new(size).strip(kind, count, 0.0, [0.0; 4]);
        assert!(strip(StripOf::Triangles, [4, 5], 16).is_ok());
        assert!(strip(StripOf::Triangles, [4, 5], 17).is_err());
        assert!(strip(StripOf::Triangles, [4, 5], 0).is_err());
        assert!(strip(StripOf::Lines, [16, 4], 4).is_ok());
        assert!(strip(StripOf::Lines, [16, 4], 5).is_err());
        assert!(strip(StripOf::Lines, [16, 5], 10).is_ok());
    }
}
