//! Provoking vertices: the vertices that give a primitive its flat attributes.
//!
//! The APIs number them by the vertices of the draw call, not of the primitive (in a strip's odd triangles,
//! the first two are exchanged), so they are derived from the topology separately.

use crate::draw::Draw;
use crate::mesh::{Mesh, RESTART};
use crate::rasterization::{PrimitiveTopology, ProvokingVertex};

impl Mesh {
    /// Returns the two vertices of each primitive that can provoke, its first and its last, in the order of
    /// [`Mesh::primitives`] (OpenGL 4.6, table 13.2; Vulkan, Primitive Topologies). A fan's first vertex never
    /// provokes, so its triangles have their second and third.
    fn provoking_candidates(&self, topology: PrimitiveTopology) -> Vec<[usize; 2]> {
        // For each topology: the number of vertices that the first primitive takes, the number that each
        // further one adds, and the positions of the first and the last vertex within the primitive.
        let (size, step, [first, last]) = match topology {
            PrimitiveTopology::PointList => (1, 1, [0, 0]),
            PrimitiveTopology::LineList => (2, 2, [0, 1]),
            PrimitiveTopology::LineStrip => (2, 1, [0, 1]),
            PrimitiveTopology::TriangleList => (3, 3, [0, 2]),
            PrimitiveTopology::TriangleStrip => (3, 1, [0, 2]),
            PrimitiveTopology::TriangleFan => (3, 1, [1, 2]),
        };
        let order = self.order();
        let runs = order.split(|i| *i == RESTART);
        runs.flat_map(|run| {
            let windows = run.windows(size).step_by(step);
            windows.map(move |w| [w[first] as usize, w[last] as usize])
        })
        .collect()
    }
}

impl Draw {
    /// Returns the two vertices of each primitive that can provoke, its first and its last, in the order of
    /// [`Draw::primitives`]. A fan's triangles have their second and third.
    pub fn primitive_ends(&self) -> Vec<[usize; 2]> {
        self.mesh.provoking_candidates(self.topology)
    }

    /// Returns the provoking vertex of each primitive, in the order of [`Draw::primitives`]; the first one if
    /// the draw sets no convention.
    pub fn provoking_vertices(&self) -> Vec<usize> {
        let ends = self.mesh.provoking_candidates(self.topology).into_iter();
        ends.map(|[first, last]| match self.provoking {
            None | Some(ProvokingVertex::First) => first,
            Some(ProvokingVertex::Last) => last,
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{PrimitiveVertices, Vertex};
    use bytemuck::Zeroable;

    fn mesh(vertices: usize, indices: Option<Vec<u32>>) -> Mesh {
        Mesh {
            vertices: vec![Vertex::zeroed(); vertices],
            indices,
        }
    }

    /// OpenGL 4.6, table 13.2, with vertices counted from 0.
    #[test]
    fn candidates_are_those_of_the_table() {
        let ends = |topology, vertices| mesh(vertices, None).provoking_candidates(topology);
        use PrimitiveTopology as T;
        assert_eq!(ends(T::PointList, 2), [[0, 0], [1, 1]]);
        assert_eq!(ends(T::LineList, 5), [[0, 1], [2, 3]]);
        assert_eq!(ends(T::LineStrip, 3), [[0, 1], [1, 2]]);
        assert_eq!(ends(T::TriangleList, 7), [[0, 2], [3, 5]]);
        assert_eq!(ends(T::TriangleStrip, 5), [[0, 2], [1, 3], [2, 4]]);
        assert_eq!(ends(T::TriangleFan, 5), [[1, 2], [2, 3], [3, 4]]);
    }

    #[test]
    fn the_convention_chooses_the_vertex_and_defaults_to_the_first() {
        use crate::{Shader, Viewport};
        let whole = Viewport::whole([4, 4]);
        let mut draw = Draw::new(Shader::FlatColor, mesh(5, None), whole);
        draw.topology = PrimitiveTopology::TriangleFan;
        assert_eq!(draw.provoking_vertices(), [1, 2, 3]);
        draw.provoking = Some(ProvokingVertex::First);
        assert_eq!(draw.provoking_vertices(), [1, 2, 3]);
        draw.provoking = Some(ProvokingVertex::Last);
        assert_eq!(draw.provoking_vertices(), [2, 3, 4]);
    }

    #[test]
    fn each_primitive_has_its_own_candidates() {
        let indices = vec![4, 2, 0, 1, RESTART, 3, 1, 0];
        for topology in PrimitiveTopology::ALL {
            let mesh = mesh(5, Some(indices.clone()));
            let (primitives, ends) = (
                mesh.primitives(*topology),
                mesh.provoking_candidates(*topology),
            );
            assert_eq!(primitives.len(), ends.len(), "{topology}");
            for (primitive, ends) in primitives.iter().zip(&ends) {
                let vertices = match primitive {
                    PrimitiveVertices::Point(i) => vec![*i],
                    PrimitiveVertices::Line(line) => line.to_vec(),
                    PrimitiveVertices::Triangle(triangle) => triangle.to_vec(),
                };
                assert!(ends.iter().all(|end| vertices.contains(end)), "{topology}");
            }
        }
    }
}
