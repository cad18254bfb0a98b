//! Provoking vertices: those whose attributes a flat primitive has.
//!
//! The APIs number them by the vertices of the draw call and not by those of the primitive (of a strip's
//! odd triangles the first two are exchanged), so they are found from the topology once more.

use crate::draw::Draw;
use crate::mesh::{Mesh, RESTART};
use crate::rasterization::{PrimitiveTopology, ProvokingVertex};

impl Mesh {
    /// Returns the first and the last vertex of each primitive, in the order of
    /// [`Mesh::primitives`] (OpenGL 4.6, table 13.2; Vulkan, Primitive Topologies).
    fn ends(&self, topology: PrimitiveTopology) -> Vec<[usize; 2]> {
        // The primitives of a run of vertices: the number of vertices that the first takes, those that
        // each further one takes, and the first and last of them by their place in it.
        let (size, step, [first, last]) = match topology {
            PrimitiveTopology::PointList => (1, 1, [0, 0]),
            PrimitiveTopology::LineList => (2, 2, [0, 1]),
            PrimitiveTopology::LineStrip => (2, 1, [0, 1]),
            PrimitiveTopology::TriangleList => (3, 3, [0, 2]),
            PrimitiveTopology::TriangleStrip => (3, 1, [0, 2]),
            // The hub never provokes.
            PrimitiveTopology::TriangleFan => (3, 1, [1, 2]),
        };
        let order: Vec<u32> = match &self.indices {
            Some(indices) => indices.clone(),
            None => (0..self.vertices.len() as u32).collect(),
        };
        let runs = order.split(|i| *i == RESTART);
        runs.flat_map(|run| {
            let windows = run.windows(size).step_by(step);
            windows.map(move |w| [w[first] as usize, w[last] as usize])
        })
        .collect()
    }
}

impl Draw {
    /// Returns the first and the last vertex of each primitive, in the order of [`Draw::primitives`].
    pub fn primitive_ends(&self) -> Vec<[usize; 2]> {
        self.mesh.ends(self.topology)
    }

    /// Returns the provoking vertex of each primitive, in the order of [`Draw::primitives`]; the first
    /// of each if the draw names no convention.
    pub fn provoking_vertices(&self) -> Vec<usize> {
        let ends = self.mesh.ends(self.topology).into_iter();
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
    fn ends_are_those_of_the_table() {
        let ends = |topology, vertices| mesh(vertices, None).ends(topology);
        use PrimitiveTopology as T;
        assert_eq!(ends(T::PointList, 2), [[0, 0], [1, 1]]);
        assert_eq!(ends(T::LineList, 5), [[0, 1], [2, 3]]);
        assert_eq!(ends(T::LineStrip, 3), [[0, 1], [1, 2]]);
        assert_eq!(ends(T::TriangleList, 7), [[0, 2], [3, 5]]);
        assert_eq!(ends(T::TriangleStrip, 5), [[0, 2], [1, 3], [2, 4]]);
        assert_eq!(ends(T::TriangleFan, 5), [[1, 2], [2, 3], [3, 4]]);
    }

    #[test]
    fn each_primitive_has_its_own_ends() {
        let indices = vec![4, 2, 0, 1, RESTART, 3, 1, 0];
        for topology in PrimitiveTopology::ALL {
            let mesh = mesh(5, Some(indices.clone()));
            let (all, ends) = (mesh.primitives(*topology), mesh.ends(*topology));
            assert_eq!(all.len(), ends.len(), "{topology}");
            for (one, ends) in all.iter().zip(&ends) {
                let own = match one {
                    PrimitiveVertices::Point(i) => vec![*i],
                    PrimitiveVertices::Line(own) => own.to_vec(),
                    PrimitiveVertices::Triangle(own) => own.to_vec(),
                };
                assert!(ends.iter().all(|end| own.contains(end)), "{topology}");
            }
        }
    }
}
