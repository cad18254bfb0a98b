//! Meshes: described in case files, expanded here, the same bits for every backend.

mod splat;
mod surface;

pub use splat::Splat;

use crate::state::{FrontFace, PrimitiveTopology};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec4};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One vertex: 40 bytes, attributes in this order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Clip-space position, y up, depth 0..=w.
    pub position: [f32; 4],
    /// Colour or any four values.
    pub color: [f32; 4],
    /// Texture coordinates.
    pub uv: [f32; 2],
}

/// The most vertices of one mesh.
pub const MAX_VERTICES: usize = 4 << 20;

/// The index that ends a strip and begins the next one.
pub const RESTART: u32 = u32::MAX;

/// Vertices and, where they are not drawn in their own order, indices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Which vertices are drawn, in order; [`RESTART`] ends a strip.
    pub indices: Option<Vec<u32>>,
}

impl Mesh {
    /// The vertices as bytes, [`Vertex`] after [`Vertex`].
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.vertices)
    }

    /// The vertex indices of each primitive in order: one for points, two for lines, three for
    /// triangles, which keep their winding (of a strip's odd triangles the first two vertices are
    /// exchanged: Vulkan, Triangle Strips; OpenGL 4.6, 10.1.8).
    pub fn primitives(&self, topology: PrimitiveTopology) -> Vec<Primitive> {
        let order: Vec<u32> = match &self.indices {
            Some(indices) => indices.clone(),
            None => (0..self.vertices.len() as u32).collect(),
        };
        let mut all = Vec::new();
        for run in order.split(|i| *i == RESTART) {
            let run: Vec<usize> = run.iter().map(|i| *i as usize).collect();
            match topology {
                PrimitiveTopology::PointList => {
                    all.extend(run.iter().map(|i| Primitive::Point(*i)));
                }
                PrimitiveTopology::LineList => {
                    all.extend(run.chunks_exact(2).map(|c| Primitive::Line([c[0], c[1]])));
                }
                PrimitiveTopology::LineStrip => {
                    all.extend(run.windows(2).map(|w| Primitive::Line([w[0], w[1]])));
                }
                PrimitiveTopology::TriangleList => {
                    let triangles = run.chunks_exact(3);
                    all.extend(triangles.map(|c| Primitive::Triangle([c[0], c[1], c[2]])));
                }
                PrimitiveTopology::TriangleStrip => {
                    all.extend(run.windows(3).enumerate().map(|(i, w)| {
                        Primitive::Triangle(match i % 2 {
                            0 => [w[0], w[1], w[2]],
                            _ => [w[1], w[0], w[2]],
                        })
                    }));
                }
                PrimitiveTopology::TriangleFan => {
                    let rest = run.get(1..).unwrap_or_default();
                    all.extend(
                        rest.windows(2)
                            .map(|w| Primitive::Triangle([run[0], w[0], w[1]])),
                    );
                }
            }
        }
        all
    }
}

/// The vertices of one primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// A point.
    Point(usize),
    /// A line.
    Line([usize; 2]),
    /// A triangle.
    Triangle([usize; 3]),
}

/// A mesh as a case file describes it.
///
/// Rectangles are given in texels of the draw's viewport and cover the samples at texel centres
/// of a single-sample attachment, no others: every edge keeps at least 0.17 texels away from every
/// centre, so that no legal snapping of vertices changes what is covered. Attributes are constant
/// over each triangle.
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
    /// Everything, every sample of every texel: one triangle that reaches far beyond the viewport.
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
    /// The attachment divided into columns of equal width as far as whole texels allow.
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
    /// The attachment divided into rows of equal height as far as whole texels allow.
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
    /// Several layers over everything, one [`MeshSource::Cover`] after the other.
    Stack {
        /// Vertex depth of each layer, in the order of drawing.
        z: Vec<f32>,
        /// Vertex colours of the layers, repeated as needed.
        #[serde(default = "one_splat")]
        values: Vec<Splat>,
    },
    /// The whole viewport as a sheet of triangles that share their vertices, two to a cell.
    ///
    /// Cells are alike but for the first of each row and column, which is narrower: so the lines between
    /// cells keep a quarter of a cell or of a texel, whichever is less, away from texel centres, where the
    /// cells' sides are whole texels or whole parts of one. Elsewhere edges may pass through centres, and
    /// two triangles share what they cover there.
    Grid {
        /// How many cells lie side by side and one above the other.
        cells: [u32; 2],
        /// Vertex depth.
        #[serde(default)]
        z: f32,
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
    },
    /// A torus seen along its axis: a closed mesh whose front half hides the back half. Triangles share
    /// their vertices; seen from outside, they are counter-clockwise. Its middle lies in the viewport's
    /// middle, at depth 0.5.
    Torus {
        /// How many segments lie around the axis and around the tube, each at least 3.
        segments: [u32; 2],
        /// The vertex colour.
        #[serde(default)]
        value: Splat,
    },
    /// Vertices one by one.
    Vertices {
        /// Positions x, y, z.
        positions: Vec<[f32; 3]>,
        /// What x and y count: clip space, or texels from the top left corner.
        #[serde(default)]
        units: Units,
        /// Which vertices are drawn, in order; `null` ends a strip. Without it, all in order.
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

/// What the positions of single vertices count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Units {
    /// Clip space: -1 to 1, y up.
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
    /// The mesh for a viewport of a size in texels, or what is wrong with the description.
    ///
    /// # Errors
    /// A sentence when a list is empty, a rectangle is empty or reaches outside, or a part would
    /// be narrower than a texel.
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
                    let [x, y, z] = *position;
                    let position = match units {
                        Units::Clip => [x, y, z, 1.0],
                        Units::Texels => {
                            let corner = DVec2::new(f64::from(x), f64::from(y));
                            builder.clip(corner, z)
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
                        return Err(format!("index {wrong} names none of {count} vertices"));
                    }
                    indices = Some(list.iter().map(|i| i.unwrap_or(RESTART)).collect());
                }
            }
        }
        let finite = |v: &Vertex| {
            let all = v.position.iter().chain(&v.color).chain(&v.uv);
            all.into_iter().all(|c| c.is_finite())
        };
        if !builder.vertices.iter().all(finite) {
            return Err("a vertex holds a value that is not a finite 32-bit float".to_owned());
        }
        Ok(Mesh {
            vertices: builder.vertices,
            indices,
        })
    }
}

struct Builder {
    size: [u32; 2],
    vertices: Vec<Vertex>,
}

impl Builder {
    fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            vertices: Vec::new(),
        }
    }

    /// One triangle that reaches far beyond the viewport.
    fn cover(&mut self, z: f32, value: [f32; 4], uv: [f32; 4]) {
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

    fn bands(
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

    /// Covers a rectangle with squares, the largest first: only a square's diagonal can be kept
    /// away from all texel centres.
    fn rect(
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

    /// The clip-space position of a point in texels.
    fn clip(&self, texels: DVec2, z: f32) -> [f32; 4] {
        let size = DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]));
        let ndc = (texels / size * 2.0 - 1.0) * DVec2::new(1.0, -1.0);
        DVec4::new(ndc.x, ndc.y, f64::from(z), 1.0)
            .as_vec4()
            .to_array()
    }

    /// Two triangles over the texels from (x, y) on. With y down, the corners stand at (0, -1/4)
    /// bottom left, (0, 0) bottom right, (-1/4, 0) top right and (0, 0) top left from the square's;
    /// so the diagonal lies 0.177 texels beside the nearest centres and nothing leaves the square.
    fn square(&mut self, x: u32, y: u32, side: u32, z: f32, value: [f32; 4], winding: FrontFace) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the signed area with y up, and the least distance of any edge from any texel centre.
    fn measure(mesh: &Mesh, size: [u32; 2]) -> (Vec<f64>, f64) {
        let to_texels = |v: &Vertex| {
            DVec2::new(
                (f64::from(v.position[0]) + 1.0) / 2.0 * f64::from(size[0]),
                (1.0 - f64::from(v.position[1])) / 2.0 * f64::from(size[1]),
            )
        };
        let mut areas = Vec::new();
        let mut least = f64::MAX;
        for primitive in mesh.primitives(PrimitiveTopology::TriangleList) {
            let Primitive::Triangle(t) = primitive else {
                continue;
            };
            let p = t.map(|i| to_texels(&mesh.vertices[i]));
            areas.push(-(p[1] - p[0]).perp_dot(p[2] - p[0]));
            for (a, b) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
                for y in 0..size[1] {
                    for x in 0..size[0] {
                        let c = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let along = (b - a).normalize();
                        let t = (c - a).dot(along).clamp(0.0, (b - a).length());
                        least = least.min((a + along * t).distance(c));
                    }
                }
            }
        }
        (areas, least)
    }

    #[test]
    fn every_edge_keeps_away_from_every_centre() {
        let sources = [
            MeshSource::Full {
                z: 0.0,
                value: Splat::default(),
                winding: FrontFace::Ccw,
            },
            MeshSource::Columns {
                values: vec![Splat::default(); 5],
                z: zero(),
                windings: one_ccw(),
            },
            MeshSource::Rect {
                texels: [3, 1, 10, 4],
                z: 0.0,
                value: Splat::default(),
                winding: FrontFace::Ccw,
            },
        ];
        for source in sources {
            let mesh = source.expand([16, 16]).expect("valid");
            let (areas, least) = measure(&mesh, [16, 16]);
            assert!(areas.iter().all(|a| *a > 0.0), "{source:?} is not ccw");
            assert!(least > 0.17, "{source:?}: {least}");
        }
    }

    #[test]
    fn clockwise_is_clockwise() {
        let source = MeshSource::Full {
            z: 0.5,
            value: Splat([1.0; 4]),
            winding: FrontFace::Cw,
        };
        let mesh = source.expand([16, 16]).expect("valid");
        let (areas, _) = measure(&mesh, [16, 16]);
        assert!(areas.iter().all(|a| *a < 0.0));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let source = MeshSource::Columns {
            values: vec![Splat::default(); 17],
            z: zero(),
            windings: one_ccw(),
        };
        assert!(source.expand([16, 16]).is_err());
    }
}
