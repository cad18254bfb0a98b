//! Draws whose primitives can reach a sample twice.
//!
//! Advanced blending without coherence leaves the result of the second time undefined (OpenGL ES 3.2,
//! 15.1.5.3; Vulkan, Advanced Blend Operations), so such a draw needs the feature for coherence. If a
//! comparison of flat triangles cannot decide this, the answer is yes. No case needs such a mesh.

use crate::draw::Draw;
use crate::mesh::PrimitiveVertices;

/// The maximum number of triangles that are compared with each other.
const COMPARED: usize = 256;

/// Returns true if two primitives of a draw can cover the same sample.
pub(crate) fn may_overlap(draw: &Draw) -> bool {
    let flat = |i: &usize| draw.mesh.vertices[*i].position[3] == 1.0;
    let mut triangles: Vec<[[f64; 2]; 3]> = Vec::new();
    let primitives = draw.mesh.primitives(draw.topology);
    if draw.fetch.instances > 1 || primitives.len() > COMPARED {
        return true;
    }
    for primitive in &primitives {
        match primitive {
            PrimitiveVertices::Triangle(corners) if corners.iter().all(flat) => {
                triangles.push(corners.map(|i| {
                    let [x, y, ..] = draw.mesh.vertices[i].position;
                    [f64::from(x), f64::from(y)]
                }));
            }
            _ if primitives.len() == 1 => return false,
            _ => return true,
        }
    }
    let mut others = triangles.as_slice();
    while let [first, rest @ ..] = others {
        if rest.iter().any(|second| share_area(first, second)) {
            return true;
        }
        others = rest;
    }
    false
}

/// Returns true if no side of either triangle separates the two.
fn share_area(a: &[[f64; 2]; 3], b: &[[f64; 2]; 3]) -> bool {
    let separates = |triangle: &[[f64; 2]; 3], from: &[[f64; 2]; 3]| {
        (0..3).any(|i| {
            let ([x, y], [u, v]) = (triangle[i], triangle[(i + 1) % 3]);
            let side = |[p, q]: [f64; 2]| (u - x) * (q - y) - (v - y) * (p - x);
            let inside = side(triangle[(i + 2) % 3]);
            from.iter().all(|p| side(*p) * inside <= 0.0)
        })
    };
    !separates(a, b) && !separates(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_source::{FieldOf, MeshSource, Splat, Units};
    use crate::rasterization::{FrontFace, Viewport};
    use crate::shader::Shader;

    const VALUE: Splat = Splat([1.0; 4]);

    fn draw(source: &MeshSource) -> Draw {
        let mesh = source.expand([16, 16]).expect("the mesh fits");
        Draw::new(Shader::FlatColor, mesh, Viewport::whole([16, 16]))
    }

    fn field(count: Option<u32>) -> MeshSource {
        MeshSource::Field {
            of: FieldOf::Triangles,
            cell: None,
            at: [0, 0],
            count,
            z: 0.0,
            values: vec![VALUE],
            indexed: false,
            spare: 0,
        }
    }

    #[test]
    fn a_rectangle_is_two_triangles_side_by_side() {
        let full = MeshSource::Full {
            z: 0.0,
            value: VALUE,
            winding: FrontFace::Ccw,
        };
        assert!(!may_overlap(&draw(&full)));
        let columns = MeshSource::Columns {
            values: vec![VALUE; 2],
            z: vec![0.0],
            windings: vec![FrontFace::Ccw, FrontFace::Cw],
        };
        assert!(!may_overlap(&draw(&columns)));
        assert!(!may_overlap(&draw(&field(Some(20)))));
    }

    #[test]
    fn layers_overlap() {
        let stack = MeshSource::Stack {
            z: vec![0.0; 2],
            values: vec![VALUE],
        };
        assert!(may_overlap(&draw(&stack)));
        let crossed = MeshSource::Vertices {
            positions: vec![
                [-1.0, -1.0, 0.0].into(),
                [1.0, -1.0, 0.0].into(),
                [0.0, 1.0, 0.0].into(),
                [-1.0, 0.5, 0.0].into(),
                [0.0, -1.5, 0.0].into(),
                [1.0, 0.5, 0.0].into(),
            ],
            units: Units::Clip,
            indices: None,
            values: vec![VALUE],
            uv: vec![[0.0; 2]],
        };
        assert!(may_overlap(&draw(&crossed)));
    }

    #[test]
    fn meshes_that_are_not_compared_may_overlap() {
        let mut instanced = draw(&field(Some(20)));
        instanced.fetch.instances = 2;
        assert!(may_overlap(&instanced));
        let mut large = draw(&field(None));
        assert!(!may_overlap(&large));
        let again = large.mesh.vertices[..3].to_vec();
        large.mesh.vertices.extend(again);
        assert!(may_overlap(&large));
    }
}
