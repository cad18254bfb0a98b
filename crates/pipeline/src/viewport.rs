//! The viewport transform, and culling by facing.

use crate::arithmetic::Arithmetic;
use crate::shader::cull_distances;
use etalon_scene::{CullMode, Draw, FrontFace, PrimitiveVertices, Viewport};

/// Returns the window position of a clip-space position: x and y in texels from the top left corner, depth
/// within the viewport's depths (Vulkan, Controlling the Viewport; WebGPU, 23.2.4: y up in clip space is down
/// in the window).
#[inline]
pub fn window_position<A: Arithmetic>(
    a: &mut A,
    position: [f32; 4],
    viewport: &Viewport,
) -> [A::Real; 3] {
    let [x, y, z, w] = position.map(|v| a.constant(v));
    let [x, y, z] = if position[3] == 1.0 {
        [x, y, z]
    } else {
        [a.div(x, w), a.div(y, w), a.div(z, w)]
    };
    // No loop, because one over the axes costs the rasterizer a third of its vertices.
    [
        placed(a, x, 0, viewport),
        placed(a, y, 1, viewport),
        placed(a, z, 2, viewport),
    ]
}

/// Returns a coordinate of a window position along an axis, from the clip-space coordinate and w.
pub fn window_coordinate<A: Arithmetic>(
    a: &mut A,
    [value, w]: [f32; 2],
    axis: usize,
    viewport: &Viewport,
) -> A::Real {
    let mut ndc = a.constant(value);
    if w != 1.0 {
        let w = a.constant(w);
        ndc = a.div(ndc, w);
    }
    placed(a, ndc, axis, viewport)
}

/// Returns a coordinate of a window position along an axis, from that of normalized device coordinates.
#[inline(always)]
fn placed<A: Arithmetic>(a: &mut A, ndc: A::Real, axis: usize, viewport: &Viewport) -> A::Real {
    if axis == 2 {
        let [near, far] = viewport.depth.map(|d| a.constant(d));
        let range = a.sub(far, near);
        let scaled = a.mul(ndc, range);
        let exact = a.add(near, scaled);
        return a.window_depth(exact, viewport.depth);
    }
    let half = a.constant(0.5);
    let halved = a.mul(ndc, half);
    let unit = if axis == 1 {
        a.sub(half, halved)
    } else {
        a.add(half, halved)
    };
    let (start, length) = (viewport.rect[axis], viewport.rect[axis + 2]);
    let size = a.constant(length);
    let scaled = a.mul(unit, size);
    let start_at = a.constant(start);
    let exact = a.add(start_at, scaled);
    a.window_coordinate(exact, start.abs() + length.abs())
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
