//! Primitives that reach behind the eye, or beyond the positions to which vertices can be snapped.
//!
//! Triangles are not clipped: their edges are lines in homogeneous coordinates, and depths and attributes are
//! those of the whole triangle. Lines get new ends.

use crate::linear::{LinearVarying, UNITS};
use crate::planes::{PlaneVertex, Planes, plane_bias, viewport};
use crate::steps::Steps;
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{
    CutEdge, DepthPlane, HomogeneousTriangle, Point, WindowVertex, clipped_segment, dot,
    edge_value, front_facing, is_top_left, window_vertex,
};
use etalon_scene::{Draw, Interpolation};

/// The number of texels beyond a viewport up to which a line is drawn.
const BEYOND: f64 = 64.0;

fn window(draw: &Draw, vertex: &PlaneVertex) -> WindowVertex {
    window_vertex(vertex.position, &draw.viewport, UNITS as f64)
}

/// Returns true if a vertex is behind the eye or too far out to be snapped.
pub(crate) fn is_cut(draw: &Draw, vertex: &PlaneVertex) -> bool {
    etalon_pipeline::is_cut(window(draw, vertex))
}

/// Returns true if all vertices of a point or line are beyond the same side of the view volume. It is then
/// discarded before it is widened.
pub(crate) fn is_beside(vertices: &[PlaneVertex]) -> bool {
    let beyond: [fn([f32; 4]) -> bool; 4] = [
        |[x, _, _, w]| x < -w,
        |[x, _, _, w]| x > w,
        |[_, y, _, w]| y < -w,
        |[_, y, _, w]| y > w,
    ];
    let all_beyond = |beyond: &fn([f32; 4]) -> bool| vertices.iter().all(|v| beyond(v.position));
    beyond.iter().any(all_beyond)
}

/// Returns the part of a line, or of an outline's edge, between the sides of the view volume, as shares of its second
/// end in the window; `None` if there is no such part. It is clipped before it is widened, so its fragments can be
/// outside, and no fragment of the rest is drawn.
pub(crate) fn between_sides(ends: [&PlaneVertex; 2]) -> Option<[f64; 2]> {
    let positions = ends.map(|v| v.position.map(f64::from));
    let sides: [fn([f64; 4]) -> f64; 4] = [
        |[x, _, _, w]| w + x,
        |[x, _, _, w]| w - x,
        |[_, y, _, w]| w + y,
        |[_, y, _, w]| w - y,
    ];
    let [from, to] = positions.map(|[.., w]| w);
    let kept = clipped_segment(sides.map(|side| positions.map(side)))?;
    Some(kept.map(|t| t * to / ((1.0 - t) * from + t * to)))
}

/// An edge with the side that the triangle is on.
enum SidedEdge {
    /// An edge between snapped vertices, clockwise on the screen.
    Snapped([Point; 2]),
    Cut(CutEdge),
}

/// A triangle that reaches behind the eye.
pub(crate) struct CutTriangle {
    vertices: [PlaneVertex; 3],
    homogeneous: HomogeneousTriangle,
    edges: [SidedEdge; 3],
}

impl CutTriangle {
    /// Returns the triangle, or `None` if all its vertices are snapped, or if it has no area.
    pub(crate) fn new(draw: &Draw, vertices: [PlaneVertex; 3]) -> Option<Self> {
        let cut = vertices.each_ref().map(|v| is_cut(draw, v));
        if cut == [false; 3] {
            return None;
        }
        let homogeneous = HomogeneousTriangle::new(vertices.each_ref().map(|v| window(draw, v)));
        let clockwise = homogeneous.determinant > 0.0;
        let edges = [0, 1, 2].map(|i| {
            let next = (i + 1) % 3;
            if cut[i] || cut[next] {
                return SidedEdge::Cut(CutEdge::new(homogeneous.edge(i), clockwise));
            }
            let ends = [vertices[i].at, vertices[next].at];
            SidedEdge::Snapped(if clockwise { ends } else { [ends[1], ends[0]] })
        });
        Some(Self {
            vertices,
            homogeneous,
            edges,
        })
    }

    /// Returns true if the triangle faces front.
    pub(crate) fn is_front(&self, draw: &Draw) -> bool {
        let determinant = self.homogeneous.determinant;
        // With y down, the determinant is negative if the area is positive.
        let area = i64::from(determinant < 0.0) - i64::from(determinant > 0.0);
        front_facing(area, draw.front_face)
    }

    /// Returns the flat colour.
    pub(crate) fn color(&self) -> [f32; 4] {
        self.vertices[0].color
    }

    /// Returns true if the sample at a point is covered.
    pub(crate) fn covers(&self, at: Point) -> bool {
        self.homogeneous.determinant != 0.0
            && self.edges.iter().all(|edge| match edge {
                SidedEdge::Cut(edge) => edge.holds(at),
                SidedEdge::Snapped([p, q]) => {
                    let value = edge_value(*p, *q, at);
                    value > 0 || (value == 0 && is_top_left(*p, *q))
                }
            })
    }

    fn over_w(&self, value: impl Fn(&PlaneVertex) -> f32) -> DepthPlane {
        let values = self.vertices.each_ref().map(|v| f64::from(value(v)));
        self.homogeneous.over_w(values)
    }

    /// Returns the greatest clip-space depth of the visible part.
    fn greatest_depth(&self, draw: &Draw) -> f64 {
        let [left, top, right, bottom] = viewport(draw).map(|v| v as f64);
        let w = self.homogeneous.vertices.map(|v| v[2]);
        let z = self.vertices.each_ref().map(|v| f64::from(v.position[2]));
        let each = |f: &dyn Fn(WindowVertex) -> f64| self.homogeneous.vertices.map(f);
        let mut planes = vec![
            w,
            each(&|[x, _, w]| x - left * w),
            each(&|[x, _, w]| right * w - x),
            each(&|[_, y, w]| y - top * w),
            each(&|[_, y, w]| bottom * w - y),
        ];
        if !draw.depth_clamp {
            planes.extend([z, [0, 1, 2].map(|i| w[i] - z[i])]);
        }
        let corners = HomogeneousTriangle::clipped(planes).into_iter();
        let depths = corners.map(|c| dot(c, z) / dot(c, w));
        depths.filter(|z| z.is_finite()).fold(0.0, f64::max)
    }

    pub(crate) fn planes(
        &self,
        draw: &Draw,
        interpolation: Interpolation,
        encoding: Option<ChannelEncoding>,
        steps: &impl Steps,
    ) -> Planes {
        let [near, far] = draw.viewport.depth;
        let clip = self.over_w(|v| v.position[2]);
        let [value, dx, dy] = clip.parts();
        let (start, range) = (f64::from(near), f64::from(far) - f64::from(near));
        let window = DepthPlane::of(start + range * value, range * dx, range * dy);
        let largest = start + range * self.greatest_depth(draw);
        let held = [near.min(far), near.max(far)];
        let count = draw.clipping_distances().count_ones() as usize;
        let negative = |n: &usize| self.vertices.iter().any(|v| v.distances[*n] < 0.0);
        let distances = (0..count).filter(negative);
        Planes {
            window,
            uv: draw.shader.uses_uv().then(|| {
                [0, 1].map(|axis| match interpolation {
                    Interpolation::Perspective => LinearVarying::perspective(
                        self.over_w(|v| v.uv[axis]),
                        self.homogeneous.over_w([1.0; 3]),
                    ),
                    // A position behind the eye has no value that could be linear in the window.
                    Interpolation::Linear => LinearVarying::linear(DepthPlane::of(
                        f64::from(self.vertices[0].uv[axis]),
                        0.0,
                        0.0,
                    )),
                })
            }),
            reciprocal_w: (draw.shader.reads_w())
                .then(|| LinearVarying::linear(self.homogeneous.over_w([1.0; 3]))),
            clip,
            range: if draw.depth_clamp {
                [f32::MIN, f32::MAX]
            } else {
                held
            },
            clip_range: [f64::NEG_INFINITY, f64::INFINITY],
            bias: plane_bias(draw, || window, largest, encoding, steps),
            clamp: draw.depth_clamp.then_some(held),
            clips: !draw.depth_clamp,
            distances: distances.map(|n| self.over_w(|v| v.distances[n])).collect(),
            leaves: true,
            viewport: viewport(draw),
        }
    }
}

/// Returns the line with new ends if it reaches behind the eye, crosses the near or far plane, or reaches far
/// out. Returns `None` if the whole line is clipped.
pub(crate) fn line(draw: &Draw, ends: [PlaneVertex; 2]) -> Option<[PlaneVertex; 2]> {
    let outside = |v: &PlaneVertex| !draw.depth_clamp && !(0.0..=1.0).contains(&v.clip_z);
    if !ends.iter().any(|v| is_cut(draw, v) || outside(v)) {
        return Some(ends);
    }
    let windows = ends.each_ref().map(|v| window(draw, v));
    let [left, top, right, bottom] = viewport(draw).map(|v| v as f64);
    let beyond = BEYOND * UNITS as f64;
    let each = |f: &dyn Fn(WindowVertex) -> f64| windows.map(f);
    let mut planes = vec![
        each(&|[_, _, w]| w),
        each(&|[x, _, w]| x - (left - beyond) * w),
        each(&|[x, _, w]| (right + beyond) * w - x),
        each(&|[_, y, w]| y - (top - beyond) * w),
        each(&|[_, y, w]| (bottom + beyond) * w - y),
    ];
    if !draw.depth_clamp {
        planes.push(ends.each_ref().map(|v| f64::from(v.position[2])));
        planes.push(
            ends.each_ref()
                .map(|v| f64::from(v.position[3]) - f64::from(v.position[2])),
        );
    }
    let [near, far] = draw.viewport.depth.map(f64::from);
    let cut = clipped_segment(planes)?.map(|t| {
        let mix = |a: f64, b: f64| a * (1.0 - t) + b * t;
        let [a, b] = &ends;
        let both = |value: fn(&PlaneVertex) -> f32| mix(f64::from(value(a)), f64::from(value(b)));
        let [x, y, w] = [0, 1, 2].map(|axis| mix(windows[0][axis], windows[1][axis]));
        let snap = |v: f64| (v / w + 0.5).floor() as i64;
        let z = both(|v| v.position[2]) / w;
        let mixed = |a: f32, b: f32| mix(f64::from(a), f64::from(b)) as f32;
        PlaneVertex {
            position: std::array::from_fn(|i| mixed(a.position[i], b.position[i])),
            at: Point {
                x: snap(x),
                y: snap(y),
            },
            z: (near + (far - near) * z) as f32,
            clip_z: if draw.depth_clamp {
                z
            } else {
                z.clamp(0.0, 1.0)
            } as f32,
            color: a.color,
            uv: std::array::from_fn(|i| mixed(a.uv[i], b.uv[i])),
            distances: std::array::from_fn(|n| mixed(a.distances[n], b.distances[n])),
        }
    });
    cut.iter()
        .all(|v| v.position[3] > 0.0 && v.z.is_finite())
        .then_some(cut)
}
