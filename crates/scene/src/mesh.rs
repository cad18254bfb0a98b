//! Meshes as backends draw them: the same bits for every backend.

use crate::rasterization::PrimitiveTopology;
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// A vertex: 40 bytes, with the attributes in this order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Clip-space position, y up, depth 0..=w.
    pub position: [f32; 4],
    /// Colour, or any four values.
    pub color: [f32; 4],
    /// Texture coordinates.
    pub uv: [f32; 2],
}

/// The maximum number of vertices in a mesh.
pub const MAX_VERTICES: usize = 4 << 20;

/// The index that ends a strip and begins the next one.
pub const RESTART: u32 = u32::MAX;

/// Vertices, and indices if the vertices are not drawn in their own order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// The distinct vertices; in the order of drawing if there are no indices.
    #[serde(with = "crate::pod_bytes")]
    pub vertices: Vec<Vertex>,
    /// Indices of the drawn vertices, in order; [`RESTART`] restarts a strip.
    #[serde(with = "crate::pod_bytes::optional")]
    pub indices: Option<Vec<u32>>,
}

impl Mesh {
    /// Returns the vertices as bytes, [`Vertex`] after [`Vertex`].
    pub fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.vertices)
    }

    /// Returns the indices of the vertices in the order of fetching.
    pub(crate) fn order(&self) -> Cow<'_, [u32]> {
        match &self.indices {
            Some(indices) => Cow::Borrowed(indices),
            None => (0..self.vertices.len() as u32).collect(),
        }
    }

    /// Returns the vertex indices of each primitive in order: one for points, two for lines, three for
    /// triangles. Triangles keep their winding: in a strip's odd triangles, the first two vertices are
    /// exchanged (Vulkan, Triangle Strips; OpenGL 4.6, 10.1.8).
    pub fn primitives(&self, topology: PrimitiveTopology) -> Vec<PrimitiveVertices> {
        let order = self.order();
        let mut primitives = Vec::new();
        for run in order.split(|i| *i == RESTART) {
            let run: Vec<usize> = run.iter().map(|i| *i as usize).collect();
            match topology {
                PrimitiveTopology::PointList => {
                    primitives.extend(run.iter().map(|i| PrimitiveVertices::Point(*i)));
                }
                PrimitiveTopology::LineList => {
                    primitives.extend(
                        run.chunks_exact(2)
                            .map(|c| PrimitiveVertices::Line([c[0], c[1]])),
                    );
                }
                PrimitiveTopology::LineStrip => {
                    primitives.extend(
                        run.windows(2)
                            .map(|w| PrimitiveVertices::Line([w[0], w[1]])),
                    );
                }
                PrimitiveTopology::TriangleList => {
                    let triangles = run.chunks_exact(3);
                    primitives
                        .extend(triangles.map(|c| PrimitiveVertices::Triangle([c[0], c[1], c[2]])));
                }
                PrimitiveTopology::TriangleStrip => {
                    primitives.extend(run.windows(3).enumerate().map(|(i, w)| {
                        PrimitiveVertices::Triangle(match i % 2 {
                            0 => [w[0], w[1], w[2]],
                            _ => [w[1], w[0], w[2]],
                        })
                    }));
                }
                PrimitiveTopology::TriangleFan => {
                    let rest = run.get(1..).unwrap_or_default();
                    primitives.extend(
                        rest.windows(2)
                            .map(|w| PrimitiveVertices::Triangle([run[0], w[0], w[1]])),
                    );
                }
            }
        }
        primitives
    }
}

/// A mesh that the copies of a scene share until one of them changes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SharedMesh(Arc<Mesh>);

impl From<Mesh> for SharedMesh {
    fn from(mesh: Mesh) -> Self {
        Self(Arc::new(mesh))
    }
}

impl Deref for SharedMesh {
    type Target = Mesh;

    fn deref(&self) -> &Mesh {
        &self.0
    }
}

impl DerefMut for SharedMesh {
    fn deref_mut(&mut self) -> &mut Mesh {
        Arc::make_mut(&mut self.0)
    }
}

impl Serialize for SharedMesh {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SharedMesh {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Mesh::deserialize(deserializer).map(Self::from)
    }
}

/// The vertices of one primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrimitiveVertices {
    /// A point, by the index of its vertex.
    Point(usize),
    /// A line, by the indices of its vertices.
    Line([usize; 2]),
    /// A triangle, by the indices of its vertices.
    Triangle([usize; 3]),
}
