//! Bugs of cull distances.

use crate::fields::FieldPlaces;
use crate::list::bugs;
use crate::plant::{draws, each};
use etalon_scene::{Draw, PrimitiveTopology, Vertex};

/// The vertices of draws that have cull distances.
const VERTICES: FieldPlaces<Vertex> = |d| {
    let culls = d.shader.cull_distances() > 0;
    d.mesh.vertices.iter_mut().filter(|_| culls).collect()
};

/// Culls each triangle of a list that has a vertex with a negative distance.
fn cull_by_one(draw: &mut Draw) {
    let culls = draw.shader.cull_distances() > 0;
    if culls && draw.topology == PrimitiveTopology::TriangleList {
        for triangle in draw.mesh.vertices.chunks_mut(3) {
            if triangle.iter().any(|v| v.uv[0] < 0.0 || v.uv[1] < 0.0) {
                triangle.iter_mut().for_each(|v| v.uv = [-1.0; 2]);
            }
        }
    }
}

bugs! {
    class "cull-distance", "capabilities";
    "ignored: Nothing is culled by distances." => each(VERTICES, |v| v.uv = [1.0; 2]);
    "first-only: The second distance does not cull." => each(VERTICES, |v| v.uv[1] = 1.0);
    "zero-is-outside: A distance of 0 is negative." =>
        each(VERTICES, |v| v.uv = v.uv.map(|c| if c == 0.0 { -1.0 } else { c }));
    "small-is-zero: Distances near 0 are 0." =>
        each(VERTICES, |v| v.uv = v.uv.map(|c| if c.abs() < 1e-6 { 0.0 } else { c }));
    "all-together: A primitive is culled if each of its vertices has a negative distance." =>
        each(VERTICES, |v| v.uv = [v.uv[0].min(v.uv[1]); 2]);
    "one-is-enough: A triangle is culled by one vertex." => draws(cull_by_one);
}
