//! Triangles to spans.

use crate::SUB_PIXEL_BITS;
use crate::span::{LANES, Span, SpanState};
use crate::steps::Steps;
use crate::surface::Surface;
use etalon_case::Scene;
use etalon_case::scene::{Draw, Pass};
use etalon_pipeline::{
    Plain, Point, SnappedTriangle, front_facing, is_culled, signed_area, window_position,
};

/// Sub-texel units per texel.
const UNITS: i64 = 1 << SUB_PIXEL_BITS;

/// Draws one draw into the pass's attachments.
pub(crate) fn draw<S: Steps>(
    scene: &Scene,
    pass: &Pass,
    draw: &Draw,
    surfaces: &mut [Surface],
    steps: &S,
) {
    let Some(target) = pass.color.first().copied().or(pass.depth_stencil) else {
        return;
    };
    let size = scene.attachments[target].size;
    let vertices: Vec<(Point, f32)> = draw
        .mesh
        .vertices
        .iter()
        .map(|v| {
            let [[x], [y], [z]] = window_position(&mut Plain::<1>, v.position, size);
            let snap = |v: f32| (v * UNITS as f32 + 0.5).floor() as i64;
            let point = Point {
                x: snap(x),
                y: snap(y),
            };
            (point, z)
        })
        .collect();
    let mut state = SpanState::new(scene, pass, draw, surfaces, steps);
    for triangle in draw.mesh.triangles(draw.topology) {
        let points = triangle.map(|i| vertices[i].0);
        let front = front_facing(signed_area(points), draw.front_face);
        if is_culled(draw.cull, front) {
            continue;
        }
        let Some(snapped) = SnappedTriangle::new(points) else {
            continue;
        };
        let depth = DepthPlane::new(points, triangle.map(|i| vertices[i].1));
        let color = draw.mesh.vertices[triangle[0]].color;
        rasterize(&snapped, size, |y, x, mask| {
            state.run(&Span {
                x,
                y,
                mask: steps.covered(x, y, size, mask),
                front,
                color,
                depth: depth.at(x, y),
            });
        });
    }
}

/// Window depth over a triangle.
struct DepthPlane {
    origin: Point,
    z: f64,
    dx: f64,
    dy: f64,
    range: [f32; 2],
}

impl DepthPlane {
    fn new(points: [Point; 3], z: [f32; 3]) -> Self {
        let [a, b, c] = points;
        let area = signed_area(points) as f64;
        let (z0, z1, z2) = (f64::from(z[0]), f64::from(z[1]), f64::from(z[2]));
        let (bx, by) = ((b.x - a.x) as f64, (b.y - a.y) as f64);
        let (cx, cy) = ((c.x - a.x) as f64, (c.y - a.y) as f64);
        let (d1, d2) = (z1 - z0, z2 - z0);
        Self {
            origin: a,
            z: z0,
            // With y down the determinant is the negated signed area.
            dx: (d1 * cy - d2 * by) / -area,
            dy: (d2 * bx - d1 * cx) / -area,
            range: [z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2])],
        }
    }

    /// Depths at the centres of a span's texels. They stay between those of the vertices.
    fn at(&self, x: usize, y: usize) -> [f32; LANES] {
        let center = |t: usize| t as i64 * UNITS + UNITS / 2;
        let dy = (center(y) - self.origin.y) as f64 * self.dy;
        std::array::from_fn(|lane| {
            let dx = (center(x + lane) - self.origin.x) as f64 * self.dx;
            ((self.z + dx + dy) as f32).clamp(self.range[0], self.range[1])
        })
    }
}

/// Calls `emit(y, x, mask)` for every span that holds a covered texel.
fn rasterize(
    triangle: &SnappedTriangle,
    size: [u32; 2],
    mut emit: impl FnMut(usize, usize, [bool; LANES]),
) {
    let vertices = triangle.vertices();
    let bound = |f: fn(&Point) -> i64, length: u32| {
        let values = vertices.each_ref().map(f);
        let least = values.into_iter().min().unwrap_or(0).div_euclid(UNITS);
        let most = values.into_iter().max().unwrap_or(0).div_euclid(UNITS) + 1;
        let inside = |v: i64| v.clamp(0, i64::from(length)) as usize;
        (inside(least), inside(most))
    };
    let (left, right) = bound(|p| p.x, size[0]);
    let (top, bottom) = bound(|p| p.y, size[1]);
    let first = left / LANES * LANES;
    for y in top..bottom {
        let mut x = first;
        while x < right {
            let edges = triangle.edges_at(Point {
                x: x as i64 * UNITS + UNITS / 2,
                y: y as i64 * UNITS + UNITS / 2,
            });
            let inside = right.min(size[0] as usize) - x;
            let mask: [bool; LANES] = std::array::from_fn(|lane| {
                let step = lane as i64 * UNITS;
                lane < inside && edges.iter().all(|(value, dx)| value + dx * step >= 0)
            });
            if mask.contains(&true) {
                emit(y, x, mask);
            }
            x += LANES;
        }
    }
}
