//! Fields of separate primitives, enough of them to overflow a driver's batches.
//!
//! Every primitive has a cell of its own, so a primitive that is lost, doubled or drawn with another's
//! vertices is visible in a cell that no other primitive reaches.

use super::builder::Builder;
use crate::mesh::Vertex;
use etalon_frame::state_enum;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The primitives of a field.
    FieldOf {
        /// Triangles, each in a cell of one texel, whose centre is at least 0.177 texels inside.
        Triangles = "triangles",
        /// Points, each in a cell of one texel.
        Points = "points",
        /// Lines, each along a cell of 8 by 1 texels, 1.5 texels away from its ends.
        Lines = "lines",
        /// Triangles to be drawn as outlines: a right angle in a cell of 8 by 8 texels, 1.5 texels away from
        /// its sides.
        Outlines = "outlines",
    }
}

impl FieldOf {
    /// Returns the width and height in texels of the cell that a primitive needs.
    fn needs(self) -> [u32; 2] {
        match self {
            Self::Triangles | Self::Points => [1, 1],
            Self::Lines => [8, 1],
            Self::Outlines => [8, 8],
        }
    }

    /// Returns the vertices of a primitive in texels from its cell's top left corner, y down,
    /// counter-clockwise.
    fn corners(self) -> &'static [[f64; 2]] {
        match self {
            Self::Triangles => &[[0.0, 0.0], [0.25, 1.0], [1.0, 0.25]],
            Self::Points => &[[0.5, 0.5]],
            Self::Lines => &[[1.5, 0.5], [6.5, 0.5]],
            Self::Outlines => &[[1.5, 1.5], [1.5, 6.5], [6.5, 1.5]],
        }
    }
}

/// The keys of a field that are not attributes.
pub(super) struct Field {
    pub(super) of: FieldOf,
    /// Width and height of a cell; `None` for what the primitives need.
    pub(super) cell: Option<[u32; 2]>,
    /// The texel, within its cell, at which a primitive starts.
    pub(super) at: [u32; 2],
    /// The number of primitives; `None` to fill the viewport.
    pub(super) count: Option<u32>,
    /// The number of unused vertices at the front.
    pub(super) spare: u32,
}

impl Builder {
    /// Adds a primitive to each cell, row by row from the top left, and returns the indices of all of them in
    /// order.
    pub(super) fn field(
        &mut self,
        field: &Field,
        z: f32,
        values: &[[f32; 4]],
    ) -> Result<Vec<u32>, String> {
        let needs = field.of.needs();
        let [width, height] = field.cell.unwrap_or(needs);
        let [x, y] = field.at;
        if x.saturating_add(needs[0]) > width || y.saturating_add(needs[1]) > height {
            return Err(format!("a primitive needs {needs:?} texels of its cell"));
        }
        let [columns, rows] = [self.size[0] / width, self.size[1] / height];
        let capacity = u64::from(columns) * u64::from(rows);
        let count = field.count.map_or(capacity, u64::from);
        if count == 0 || count > capacity {
            return Err(format!("{capacity} primitives fit into {:?}", self.size));
        }
        if values.is_empty() {
            return Err("`values` must not be empty".to_owned());
        }
        let corners = field.of.corners();
        let offset = DVec2::new(f64::from(x), f64::from(y));
        for i in 0..field.spare as usize {
            let [x, y] = [[-2.0, -2.0], [8.0, -2.0], [-2.0, 8.0]][i % 3];
            self.vertices.push(Vertex {
                position: [x, y, z, 1.0],
                color: values[0],
                uv: [0.0; 2],
            });
        }
        for (i, value) in (0..count).zip(values.iter().cycle()) {
            let column = i % u64::from(columns) * u64::from(width);
            let row = i / u64::from(columns) * u64::from(height);
            let cell = DVec2::new(column as f64, row as f64);
            for corner in corners {
                let position = self.clip(cell + offset + DVec2::from_array(*corner), z);
                self.vertices.push(Vertex {
                    position,
                    color: *value,
                    uv: [0.0; 2],
                });
            }
        }
        Ok((field.spare..self.vertices.len() as u32).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_covers_the_centre_of_its_texel_and_no_other() {
        let corners = FieldOf::Triangles.corners();
        let distance = |point: [f64; 2]| -> f64 {
            let edge = |i: usize| {
                let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 3]);
                let cross = (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax);
                // For a counter-clockwise triangle with y down, the edge function is negative inside.
                -cross / (bx - ax).hypot(by - ay)
            };
            (0..3).map(edge).fold(f64::INFINITY, f64::min)
        };
        assert!(distance([0.5, 0.5]) > 0.17);
        for [x, y] in [
            [-0.5, 0.5],
            [1.5, 0.5],
            [0.5, -0.5],
            [0.5, 1.5],
            [1.5, -0.5],
            [-0.5, 1.5],
        ] {
            assert!(distance([x, y]) < -0.17, "{x} {y}");
        }
    }

    #[test]
    fn a_field_has_as_many_primitives_as_asked() {
        let field = |kind, count, spare| {
            let mut builder = Builder::new([16, 8]);
            let (cell, texel) = (None, [0; 2]);
            let field = Field {
                of: kind,
                cell,
                at: texel,
                count,
                spare,
            };
            let indices = builder.field(&field, 0.0, &[[0.0; 4], [1.0; 4]])?;
            Ok::<_, String>((builder.vertices, indices))
        };
        for (kind, expected) in [
            (FieldOf::Triangles, 128 * 3),
            (FieldOf::Points, 128),
            (FieldOf::Lines, 16 * 2),
            (FieldOf::Outlines, 2 * 3),
        ] {
            let (vertices, indices) = field(kind, None, 0).expect("it fits");
            assert_eq!((vertices.len(), indices.len()), (expected, expected));
        }
        let (vertices, indices) = field(FieldOf::Triangles, Some(5), 2).expect("it fits");
        assert_eq!((vertices.len(), indices.len()), (17, 15));
        assert_eq!((indices[0], indices[14]), (2, 16));
        assert_eq!([vertices[2].color, vertices[5].color], [[0.0; 4], [1.0; 4]]);
        let sparse = |texel| {
            let field = Field {
                of: FieldOf::Points,
                cell: Some([8, 4]),
                at: texel,
                count: None,
                spare: 0,
            };
            let mut builder = Builder::new([16, 8]);
            builder.field(&field, 0.0, &[[0.0; 4]])?;
            Ok::<_, String>(builder.vertices)
        };
        let vertices = sparse([3, 1]).expect("it fits");
        assert_eq!(vertices.len(), 4);
        // (11.5, 5.5) of (16, 8).
        assert_eq!(vertices[3].position, [0.4375, -0.375, 0.0, 1.0]);
        assert!(sparse([8, 0]).is_err());
        assert!(field(FieldOf::Lines, Some(17), 0).is_err());
        assert!(field(FieldOf::Points, Some(0), 0).is_err());
    }
}
