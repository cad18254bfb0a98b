//! Meshes as case files describe them, and their expansion.

mod builder;
mod field;
mod position;
mod splat;
mod strip;
mod surface;
#[cfg(test)]
mod tests;

pub use field::FieldOf;
pub use position::Position;
pub use splat::Splat;
pub use strip::StripOf;

use crate::mesh::{Mesh, RESTART, Vertex};
use crate::rasterization::FrontFace;
use builder::Builder;
use field::Field;
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A mesh as a case file describes it.
///
/// Rectangles are given in texels of the draw's viewport and cover exactly the samples at their texel centres
/// in a single-sample attachment: every edge is at least 0.17 texels away from every centre, so no legal
/// snapping of vertices changes the coverage. Attributes are constant over each triangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum MeshSource {
    /// The whole attachment.
    Full {
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
        /// The winding.
        #[serde(default = "ccw")]
        winding: FrontFace,
    },
    /// Every sample of every texel: one triangle that reaches far beyond the viewport.
    Cover {
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
        /// Texture coordinates at the viewport's left, top, right and bottom edge.
        #[serde(default)]
        uv: [f32; 4],
    },
    /// A rectangle.
    Rect {
        /// Left, top, right and bottom edge in texels.
        texels: [u32; 4],
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
        /// The winding.
        #[serde(default = "ccw")]
        winding: FrontFace,
    },
    /// The attachment divided into columns whose widths are whole texels and as equal as possible.
    Columns {
        /// The vertex colour of each column.
        values: Vec<Splat>,
        /// Vertex depths of the columns, repeated as needed.
        #[serde(default = "zero")]
        z: Vec<f32>,
        /// Windings of the columns, repeated as needed.
        #[serde(default = "one_ccw")]
        windings: Vec<FrontFace>,
    },
    /// The attachment divided into rows whose heights are whole texels and as equal as possible.
    Rows {
        /// The vertex colour of each row.
        values: Vec<Splat>,
        /// Vertex depths of the rows, repeated as needed.
        #[serde(default = "zero")]
        z: Vec<f32>,
        /// Windings of the rows, repeated as needed.
        #[serde(default = "one_ccw")]
        windings: Vec<FrontFace>,
    },
    /// Several layers over everything, one [`MeshSource::Cover`] after another.
    Stack {
        /// Vertex depth of each layer, in drawing order.
        z: Vec<f32>,
        /// Vertex colours of the layers, repeated as needed.
        #[serde(default = "one_splat")]
        values: Vec<Splat>,
    },
    /// The whole viewport as a sheet of triangles that share their vertices, two per cell.
    ///
    /// The first cell of each row and column is narrower, and all others are equal. If the cells' sides are
    /// whole texels, or a texel is a whole number of them, this keeps the lines between cells away from texel
    /// centres: by a quarter of a cell or of a texel, whichever is less. Other edges can pass through
    /// centres, which two triangles then share.
    Grid {
        /// The number of cells across and down.
        cells: [u32; 2],
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
    },
    /// A torus seen along its axis: a closed mesh whose front half hides the back half. Triangles share their
    /// vertices; seen from outside, they are counter-clockwise. It is centred in the viewport, at depth 0.5.
    Torus {
        /// The number of segments around the axis and around the tube, each at least 3.
        segments: [u32; 2],
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
    },
    /// Separate primitives, each in a cell of its own, row by row from the top left.
    Field {
        /// The primitives, which must fit the draw's topology and polygon mode.
        of: FieldOf,
        /// Width and height of a cell in texels; by default, what the primitives need.
        #[serde(default)]
        cell: Option<[u32; 2]>,
        /// Column and row, within its cell, of the texel at which a primitive starts.
        #[serde(default)]
        at: [u32; 2],
        /// The number of primitives; by default, as many as there are cells.
        #[serde(default)]
        count: Option<u32>,
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour of each primitive, repeated as needed.
        #[serde(default = "one_splat")]
        values: Vec<Splat>,
        /// True for an indexed draw.
        #[serde(default)]
        indexed: bool,
        /// The number of vertices at the front that no index refers to.
        #[serde(default)]
        spare: u32,
    },
    /// One strip of primitives, each with texels of its own, row by row or column by column.
    Strip {
        /// The primitives, which must fit the draw's topology.
        of: StripOf,
        /// The number of primitives with texels of their own, not counting the primitives that join them.
        count: u32,
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
        /// True for an indexed draw.
        #[serde(default)]
        indexed: bool,
    },
    /// Vertices one by one.
    Vertices {
        /// Positions x, y, z and, if it is not 1, w.
        positions: Vec<Position>,
        /// The units of positions: clip space, or texels from the top left corner. In texels, x, y and z are
        /// multiplied by w, so that they are the position after the perspective division.
        #[serde(default)]
        units: Units,
        /// Indices of the drawn vertices, in order; `null` restarts a strip. By default, all vertices in
        /// order.
        #[serde(default)]
        indices: Option<Vec<Option<u32>>>,
        /// Vertex colours, repeated as needed.
        #[serde(default = "one_splat")]
        values: Vec<Splat>,
        /// Texture coordinates, repeated as needed.
        #[serde(default = "one_uv")]
        uv: Vec<[f32; 2]>,
    },
}

/// The units of vertex positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Clip space: -w to w, y up.
    #[default]
    Clip,
    /// Texels from the top left corner, y down.
    Texels,
}

fn ccw() -> FrontFace {
    FrontFace::Ccw
}

fn one_ccw() -> Vec<FrontFace> {
    vec![FrontFace::Ccw]
}

fn zero() -> Vec<f32> {
    vec![0.0]
}

fn one_uv() -> Vec<[f32; 2]> {
    vec![[0.0; 2]]
}

fn one_splat() -> Vec<Splat> {
    vec![Splat::default()]
}

impl MeshSource {
    /// Returns the mesh for a viewport of a size in texels. One arm per kind of mesh.
    ///
    /// # Errors
    /// If a list is empty, a rectangle is empty or reaches outside, or a part would be narrower than a texel.
    /// The message says which.
    pub fn expand(&self, size: [u32; 2]) -> Result<Mesh, String> {
        let mut builder = Builder::new(size);
        let mut indices = None;
        match self {
            Self::Full { z, value, winding } => {
                builder.rect([0, 0, size[0], size[1]], *z, value.0, *winding)?;
            }
            Self::Cover { z, value, uv } => builder.cover(*z, value.0, *uv),
            Self::Stack { z, values } => {
                if z.is_empty() || values.is_empty() {
                    return Err("`z` and `values` must not be empty".to_owned());
                }
                for (z, value) in z.iter().zip(values.iter().cycle()) {
                    builder.cover(*z, value.0, [0.0; 4]);
                }
            }
            Self::Grid { cells, z, value } => {
                indices = Some(builder.grid(*cells, *z, value.0)?);
            }
            Self::Field {
                of: kind,
                cell,
                at: texel,
                count,
                z,
                values,
                indexed,
                spare,
            } => {
                if *spare > 0 && !indexed {
                    return Err("`spare` needs `indexed`".to_owned());
                }
                let values: Vec<_> = values.iter().map(|v| v.0).collect();
                let field = Field {
                    of: *kind,
                    cell: *cell,
                    at: *texel,
                    count: *count,
                    spare: *spare,
                };
                let listed = builder.field(&field, *z, &values)?;
                indices = indexed.then_some(listed);
            }
            Self::Strip {
                of: kind,
                count,
                z,
                value,
                indexed,
            } => {
                builder.strip(*kind, *count, *z, value.0)?;
                indices = indexed.then(|| (0..builder.vertices.len() as u32).collect());
            }
            Self::Torus { segments, value } => {
                indices = Some(builder.torus(*segments, value.0)?);
            }
            Self::Rect {
                texels,
                z,
                value,
                winding,
            } => builder.rect(*texels, *z, value.0, *winding)?,
            Self::Columns {
                values,
                z,
                windings,
            } => builder.bands(values, z, windings, true)?,
            Self::Rows {
                values,
                z,
                windings,
            } => builder.bands(values, z, windings, false)?,
            Self::Vertices {
                positions,
                units,
                indices: list,
                values,
                uv,
            } => {
                if values.is_empty() || uv.is_empty() {
                    return Err("`values` and `uv` must not be empty".to_owned());
                }
                let attributes = values.iter().cycle().zip(uv.iter().cycle());
                for (position, (value, uv)) in positions.iter().zip(attributes) {
                    let [x, y, z, w] = position.0;
                    let position = match units {
                        Units::Clip => position.0,
                        Units::Texels => {
                            let corner = DVec2::new(f64::from(x), f64::from(y));
                            builder.clip(corner, z).map(|v| v * w)
                        }
                    };
                    builder.vertices.push(Vertex {
                        position,
                        color: value.0,
                        uv: *uv,
                    });
                }
                if let Some(list) = list {
                    let count = positions.len() as u32;
                    if let Some(wrong) = list.iter().flatten().find(|i| **i >= count) {
                        return Err(format!(
                            "index {wrong} is out of range: there are {count} vertices"
                        ));
                    }
                    indices = Some(list.iter().map(|i| i.unwrap_or(RESTART)).collect());
                }
            }
        }
        let finite = |v: &Vertex| {
            let components = v.position.iter().chain(&v.color).chain(&v.uv);
            components.into_iter().all(|c| c.is_finite())
        };
        if !builder.vertices.iter().all(finite) {
            return Err("a vertex has a value that is not a finite 32-bit float".to_owned());
        }
        Ok(Mesh {
            vertices: builder.vertices,
            indices,
        })
    }
}
