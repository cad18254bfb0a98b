//! The viewport transform, and culling by facing.

use crate::arithmetic::Arithmetic;
use crate::shader::cull_distances;
use etalon_scene::{CullMode, Draw, FrontFace, PrimitiveVertices, Viewport};

/// Returns the window position of a clip-space position: x and y in texels from the top left corner, depth
/// within the viewport's depths (Vulkan, Controlling the Viewport; WebGPU, 23.2.4: y up in clip space is down
/// in the window).
pub fn window_position<A: Arithmetic>(
    a: &mut A,
    position: [f32; 4],
    viewport: &Viewport,
) -> [A::Real; 3] {
    let clip = position.map(|v| a.constant(v));
    let half = a.constant(0.5);
    let ndc = if position[3] == 1.0 {
        [clip[0], clip[1], clip[2]]
    } else {
        [0, 1, 2].map(|i| a.div(clip[i], clip[3]))
    };
    let [left, top, width, height] = viewport.rect;
    let axis = |a: &mut A, value: A::Real, start: f32, length: f32, flip: bool| {
        let halved = a.mul(value, half);
        let unit = if flip {
            a.sub(half, halved)
        } else {
            a.add(half, halved)
        };
        let size = a.constant(length);
        let scaled = a.mul(unit, size);
        let start_at = a.constant(start);
        let exact = a.add(start_at, scaled);
        a.window_coordinate(exact, start.abs() + length.abs())
    };
    let x = axis(a, ndc[0], left, width, false);
    let y = axis(a, ndc[1], top, height, true);
    let [near, far] = viewport.depth.map(|d| a.constant(d));
    let range = a.sub(far, near);
    let scaled = a.mul(ndc[2], range);
    let exact = a.add(near, scaled);
    let z = a.window_depth(exact, viewport.depth);
    [x, y, z]
}

/// Returns true if a triangle of this signed area (y up) faces front. Zero area faces back.
pub fn front_facing(signed_area: i64, front_face: FrontFace) -> bool {
    match front_face {
        FrontFace::Ccw => signed_area > 0,
        FrontFace::Cw => signed_area < 0,
    }
}

/// Returns true if one of the cull distances is negative at all vertices of a primitive. Neither w nor the
/// facing matters.
pub fn is_beyond(draw: &Draw, primitive: PrimitiveVertices) -> bool {
    let vertices: &[usize] = match &primitive {
        PrimitiveVertices::Point(vertex) => std::slice::from_ref(vertex),
        PrimitiveVertices::Line(vertices) => vertices,
        PrimitiveVertices::Triangle(vertices) => vertices,
    };
    let distance = |vertex: usize, number: usize| {
        cull_distances(draw.shader, &draw.mesh.vertices[vertex])[number]
    };
    let mut numbers = 0..draw.shader.cull_distances() as usize;
    numbers.any(|number| vertices.iter().all(|v| distance(*v, number) < 0.0))
}

/// Returns true if a face is culled.
pub fn is_culled(mode: CullMode, front: bool) -> bool {
    match mode {
        CullMode::None => false,
        CullMode::Front => front,
        CullMode::Back => !front,
        CullMode::FrontAndBack => true,
    }
}
