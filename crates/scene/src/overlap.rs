//! Draws whose primitives may reach a sample twice.
//!
//! Advanced blending without coherence leaves the second time undefined (OpenGL ES 3.2, 15.1.5.3; Vulkan,
//! Advanced Blend Operations), so such a draw needs the feature. The answer is yes wherever it would take
//! more than a comparison of flat triangles to be sure: no case has to draw such a mesh.

use crate::draw::Draw;
use crate::mesh::PrimitiveVertices;

/// The most triangles that are compared with each other.
const COMPARED: usize = 256;

/// True if two primitives of a draw may cover the same sample.
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

/// True if no side of either triangle separates the two.
fn share_area(a: &[[f64; 2]; 3], b: &[[f64; 2]; 3]) -> bool {
    let separates = |of: &[[f64; 2]; 3], from: &[[f64; 2]; 3]| {
        (0..3).any(|i| {
            let ([x, y], [u, v]) = (of[i], of[(i + 1) % 3]);
            let side = |[p, q]: [f64; 2]| (u - x) * (q - y) - (v - y) * (p - x);
            let inside = side(of[(i + 2) % 3]);
            from.iter().all(|p| side(*p) * inside <= 0.0)
        })
    };
    !separates(a, b) && !separates(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh_source::MeshSource;
    use crate::rasterization::Viewport;
    use crate::shader::Shader;

    fn overlaps(mesh: &str) -> bool {
        let source: MeshSource = serde_json::from_str(mesh).unwrap();
        let mesh = source.expand([16, 16]).unwrap();
        let viewport = Viewport::whole([16, 16]);
        may_overlap(&Draw::new(Shader::FlatColor, mesh, viewport))
    }

    #[test]
    fn rectangles_are_two_triangles_side_by_side() {
        assert!(!overlaps(r#"{ "kind": "full" }"#));
        assert!(!overlaps(r#"{ "kind": "rect", "texels": [1, 2, 9, 5] }"#));
        assert!(!overlaps(r#"{ "kind": "cover" }"#));
        assert!(!overlaps(
            r#"{ "kind": "field", "of": "triangles", "count": 20 }"#
        ));
    }

    #[test]
    fn layers_lie_over_each_other() {
        assert!(overlaps(r#"{ "kind": "stack", "z": [0, 0] }"#));
        let crossed = r#"{ "kind": "vertices", "positions":
            [[-1, -1, 0], [1, -1, 0], [0, 1, 0], [-1, 0.5, 0], [0, -1.5, 0], [1, 0.5, 0]] }"#;
        assert!(overlaps(crossed));
    }

    #[test]
    fn what_is_not_compared_may_overlap() {
        let source: MeshSource =
            serde_json::from_str(r#"{ "kind": "field", "of": "triangles", "count": 250 }"#)
                .unwrap();
        let mesh = source.expand([32, 32]).unwrap();
        let mut draw = Draw::new(Shader::FlatColor, mesh, Viewport::whole([32, 32]));
        draw.fetch.instances = 2;
        assert!(may_overlap(&draw));
    }
}
