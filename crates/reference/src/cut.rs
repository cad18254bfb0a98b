//! Primitives that reach behind the eye, or farther than vertices are snapped: their visible part after
//! clipping.
//!
//! Every clipping that is exact up to floating-point precision is legal: by the view volume, by a larger one,
//! or no clipping at all, in homogeneous coordinates (Vulkan, Primitive Clipping; OpenGL 4.6, 13.7, which
//! lets implementations cut primitives for reasons of their own). The remaining edges, depths and attributes
//! are those of the whole primitive. A vertex that clipping makes can be off by its roundings and by a step
//! of the grid.

use crate::bias::slope;
use crate::context::PassContext;
use crate::depth::Depth;
use crate::distance::ClipDistance;
use crate::interval::Interval;
use crate::primitive::{Edge, Triangle, VertexId};
use crate::rules::DepthTerms;
use crate::snap::{SnapBox, units_per_texel};
use crate::varying::{Perspective, Varying};
use etalon_pipeline::{
    FARTHEST, HomogeneousTriangle, Point, WindowVertex, clipped_segment, dot, window_vertex,
};
use etalon_scene::{Draw, Interpolation};

/// The number of roundings in a clipped vertex's coordinates: two products and their sum, the quotient by w,
/// and the viewport's product and sum; all doubled, since two planes can cut an edge.
const ROUNDINGS: f64 = 12.0;

/// The distance beyond a viewport up to which a primitive is tracked, in texels. Nothing farther out can reach
/// into the viewport.
const BEYOND: f64 = 64.0;

/// The fraction of w by which the near and far planes are moved outwards, so that rounded vertices stay
/// between them.
const DEPTH_SLACK: f64 = 1.0 / 1024.0;

/// Returns true if the perspective division or the grid cannot place one of the vertices.
pub(crate) fn is_cut(context: &PassContext<'_>, draw: &Draw, vertices: &[usize]) -> bool {
    let units = units_per_texel(context.limits) as f64;
    let position = |i: &usize| draw.mesh.vertices[*i].position;
    let mut positions = vertices.iter().map(position);
    positions.any(|p| etalon_pipeline::is_cut(window_vertex(p, &draw.viewport, units)))
}

/// Returns true if a line crosses the near or the far plane, or is otherwise cut.
pub(crate) fn is_cut_line(context: &PassContext<'_>, draw: &Draw, ends: [usize; 2]) -> bool {
    let side = |i: usize| {
        let [.., z, w] = draw.mesh.vertices[i].position;
        (z < 0.0, z > w)
    };
    let crosses = !draw.depth_clamp && side(ends[0]) != side(ends[1]);
    crosses || is_cut(context, draw, &ends)
}

/// The visible part of a primitive and its position error.
struct VisiblePart<'a> {
    context: &'a PassContext<'a>,
    draw: &'a Draw,
    units: f64,
    /// The maximum error of a vertex made by clipping along each axis, in units.
    off: [f64; 2],
}

impl<'a> VisiblePart<'a> {
    fn new(context: &'a PassContext<'a>, draw: &'a Draw) -> Self {
        Self {
            context,
            draw,
            units: units_per_texel(context.limits) as f64,
            off: [0.0; 2],
        }
    }

    fn window(&self, vertex: usize) -> WindowVertex {
        let position = self.draw.mesh.vertices[vertex].position;
        window_vertex(position, &self.draw.viewport, self.units)
    }

    /// Returns the magnitudes of the terms of a vertex's window coordinates, times w.
    fn terms(&self, vertex: usize) -> [f64; 2] {
        let [x, y, _, w] = self.draw.mesh.vertices[vertex].position.map(f64::from);
        let rect = self.draw.viewport.rect.map(|v| f64::from(v) * self.units);
        let axis = |v: f64, start: f64, length: f64| {
            (v * length / 2.0).abs() + w.abs() * (start.abs() + length.abs() / 2.0)
        };
        [axis(x, rect[0], rect[2]), axis(y, rect[1], rect[3])]
    }

    fn error(&self) -> f64 {
        self.context.rules.float_error.value() * ROUNDINGS
    }

    /// Returns functions that are all non-negative near the viewport and in front of the eye.
    fn near_viewport(&self, [x, y, w]: WindowVertex) -> [f64; 5] {
        let area = self.draw.viewport.area();
        let [left, top, width, height] = area.map(|v| f64::from(v) * self.units);
        let beyond = BEYOND * self.units;
        [
            w,
            x - w * (left - beyond),
            w * (left + width + beyond) - x,
            y - w * (top - beyond),
            w * (top + height + beyond) - y,
        ]
    }

    /// Returns functions that are both non-negative between the near and far planes, which are moved outwards
    /// by a fraction of w.
    fn between_planes(&self, vertex: usize, slack: f64) -> [f64; 2] {
        let [.., z, w] = self.draw.mesh.vertices[vertex].position.map(f64::from);
        if self.draw.depth_clamp {
            return [0.0; 2];
        }
        [z + slack * w, w * (1.0 + slack) - z]
    }

    /// Increases the vertex error for a corner that is given by weights of the primitive's vertices.
    fn grow(&mut self, vertices: &[usize], shares: &[f64]) {
        let sum = |value: &dyn Fn(usize) -> f64| -> f64 {
            let each = vertices.iter().zip(shares);
            each.map(|(v, share)| share * value(*v)).sum()
        };
        let w = sum(&|v| self.window(v)[2]);
        let step = self.context.step() as f64;
        let off = [0, 1].map(|axis| {
            let terms = sum(&|v| self.terms(v)[axis]);
            let off = terms / w * self.error() + step;
            if off.is_finite() && w > 0.0 {
                off
            } else {
                f64::INFINITY
            }
        });
        self.off = [0, 1].map(|axis| self.off[axis].max(off[axis]));
    }
}

/// The part of a triangle that clipping leaves.
pub(crate) struct ClippedTriangle<'a> {
    seen: VisiblePart<'a>,
    vertices: [usize; 3],
    homogeneous: HomogeneousTriangle,
    /// The corners of the visible part, each as its weights of the three vertices.
    corners: Vec<[f64; 3]>,
    /// The fraction of the visible area that is within the error of its edges. At 1 and above, the area can
    /// have either sign.
    flatness: f64,
}

impl<'a> ClippedTriangle<'a> {
    /// Returns the part of a triangle that clipping leaves; `None` if nothing is left.
    pub(crate) fn new(
        context: &'a PassContext<'a>,
        draw: &'a Draw,
        vertices: [usize; 3],
    ) -> Option<Self> {
        let mut seen = VisiblePart::new(context, draw);
        let windows = vertices.map(|v| seen.window(v));
        let near = windows.map(|window| seen.near_viewport(window));
        let depths = vertices.map(|v| seen.between_planes(v, DEPTH_SLACK));
        let functions = (0..5).map(|f| near.map(|values| values[f]));
        let planes = (0..2).map(|f| depths.map(|values| values[f]));
        let corners = HomogeneousTriangle::clipped(functions.chain(planes));
        if corners.len() < 3 {
            return None;
        }
        for corner in &corners {
            seen.grow(&vertices, corner);
        }
        let mut cut = Self {
            seen,
            vertices,
            homogeneous: HomogeneousTriangle::new(windows),
            corners,
            flatness: 0.0,
        };
        cut.flatness = cut.flatness();
        Some(cut)
    }

    /// Returns a corner's position in the window.
    fn place(&self, corner: [f64; 3]) -> [f64; 2] {
        let sum = |axis: usize| dot(corner, self.homogeneous.vertices.map(|v| v[axis]));
        [sum(0) / sum(2), sum(1) / sum(2)]
    }

    /// Returns the fraction of the visible area that is within the error of its edges.
    fn flatness(&self) -> f64 {
        let places: Vec<[f64; 2]> = self.corners.iter().map(|c| self.place(*c)).collect();
        let (mut area, mut around) = (0.0, 0.0);
        for (i, [x, y]) in places.iter().enumerate() {
            let [u, v] = places[(i + 1) % places.len()];
            area += x * v - y * u;
            around += (u - x).abs() + (v - y).abs();
        }
        let off = self.seen.off[0] + self.seen.off[1];
        let flatness = 2.0 * around * off / area.abs();
        if flatness.is_finite() {
            flatness
        } else {
            f64::INFINITY
        }
    }

    /// Returns the triangle's edges. An edge between two snapped vertices, given by `boxes`, is the line
    /// through both.
    pub(crate) fn triangle(&self, boxes: [Option<SnapBox>; 3], ids: [VertexId; 3]) -> Triangle {
        let edges = [0, 1, 2].map(|i| match (boxes[i], boxes[(i + 1) % 3]) {
            (Some(from), Some(to)) => Edge::Between([from, to]),
            _ => {
                let line = self.homogeneous.edge(i);
                let [across, down] = self.seen.off;
                let off = line.dx.abs() * across + line.dy.abs() * down;
                Edge::Cut {
                    line,
                    off: if off.is_finite() { off } else { f64::INFINITY },
                }
            }
        });
        // With y down, the determinant is negative if the area is positive.
        let area = if self.flatness >= 1.0 {
            (-1, 1)
        } else if self.homogeneous.determinant < 0.0 {
            (1, 1)
        } else {
            (-1, -1)
        };
        Triangle::cut(edges, ids, area, self.bounds())
    }

    /// Returns left, top, right and bottom of the visible part, in units.
    pub(crate) fn bounds(&self) -> SnapBox {
        let places = self.corners.iter().map(|corner| self.place(*corner));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in places {
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis] - self.seen.off[axis]);
                high[axis] = high[axis].max(place[axis] + self.seen.off[axis]);
            }
        }
        // The cast saturates. NaN counts as reaching everywhere.
        let within = |v: f64, otherwise: f64| {
            let v = if v.is_nan() { otherwise } else { v };
            v.clamp(-FARTHEST, FARTHEST)
        };
        SnapBox {
            low: Point {
                x: within(low[0], -FARTHEST).floor() as i64,
                y: within(low[1], -FARTHEST).floor() as i64,
            },
            high: Point {
                x: within(high[0], FARTHEST).ceil() as i64,
                y: within(high[1], FARTHEST).ceil() as i64,
            },
        }
    }

    /// Returns the linear function of a value divided by w.
    fn over_w(&self, values: [f64; 3]) -> Depth {
        let w = self.homogeneous.vertices.map(|v| v[2]);
        let value = |corner: &[f64; 3]| Interval::exact(dot(*corner, values) / dot(*corner, w));
        let hull = self.corners.iter().map(value).reduce(Interval::hull);
        let magnitude = |corner: &[f64; 3]| dot(*corner, values.map(f64::abs)) / dot(*corner, w);
        let largest = self.corners.iter().map(magnitude).fold(0.0, f64::max);
        let error = largest * self.seen.error();
        let hull = hull.filter(|h| error.is_finite() && h.low.is_finite() && h.high.is_finite());
        let Some(hull) = hull else {
            return Depth::flat(&[Interval::EVERYTHING]);
        };
        let plane = self.homogeneous.over_w(values);
        Depth::of_plane(plane, self.seen.off, hull, error)
    }

    /// Returns the depth that the near and far planes clip by.
    pub(crate) fn clip_depth(&self) -> Depth {
        self.over_w(self.values(|v| v.position[2]))
    }

    /// Returns the window depth.
    pub(crate) fn window_depth(&self) -> Depth {
        let [near, far] = self.seen.draw.viewport.depth.map(f64::from);
        let w = self.values(|v| v.position[3]);
        let z = self.values(|v| v.position[2]);
        let mut depth = self.over_w([0, 1, 2].map(|i| near * w[i] + (far - near) * z[i]));
        let error = self.seen.error() * near.abs().max(far.abs());
        if self.seen.context.rules.depth_terms.value() == DepthTerms::Middle {
            depth.error += error;
            depth.hull = depth.hull.widen(error);
        }
        if !self.seen.draw.depth_clamp {
            // The visible part is between the planes.
            depth.hull = depth
                .hull
                .clamp(near.min(far) - error, near.max(far) + error);
        }
        depth
    }

    fn values(&self, value: impl Fn(&etalon_scene::Vertex) -> f32) -> [f64; 3] {
        self.vertices
            .map(|v| f64::from(value(&self.seen.draw.mesh.vertices[v])))
    }

    /// Returns the texture coordinates.
    pub(crate) fn uv(&self) -> [Varying; 2] {
        [0, 1].map(|axis| self.varying(self.values(|v| v.uv[axis])))
    }

    fn varying(&self, values: [f64; 3]) -> Varying {
        let error = self.seen.context.rules.float_error.value();
        let linear = self.seen.draw.shader.interpolation() == Interpolation::Linear;
        let flat = values[0] == values[1] && values[1] == values[2];
        if linear || flat || !self.seen.off.iter().all(|v| v.is_finite()) {
            // A value cannot be linear in the window behind the eye.
            return Varying::Linear(Depth::flat(&values.map(Interval::exact)).interpolated(error));
        }
        let planes = [values, [1.0; 3]].map(|values| self.homogeneous.over_w(values));
        Varying::Perspective(Perspective::of([planes], self.seen.off, values, error))
    }

    /// Returns 1 over w.
    pub(crate) fn reciprocal_w(&self) -> Varying {
        Varying::Linear(self.over_w([1.0; 3]))
    }

    /// Returns a clip distance.
    pub(crate) fn distance(&self, values: [f64; 3]) -> ClipDistance {
        if values.iter().all(|v| *v >= 0.0) || values.iter().all(|v| *v < 0.0) {
            return ClipDistance::between(&values);
        }
        ClipDistance::of_plane(self.over_w(values))
    }

    /// Returns the slope per texel that a depth bias uses.
    pub(crate) fn slope(&self, window_depth: &Depth) -> Interval {
        let z = self.values(|v| v.position[2]);
        let [near, far] = self.seen.draw.viewport.depth.map(f64::from);
        let plane = self.homogeneous.over_w(z);
        let texel = (far - near).abs() * self.seen.units;
        let interval = slope(self.seen.context, plane.dx * texel, plane.dy * texel);
        let high = interval.high;
        if high == 0.0 {
            return interval;
        }
        if !(self.flatness < 0.5 && high.is_finite()) {
            return Interval {
                low: 0.0,
                high: f64::from(f32::MAX),
            };
        }
        // Errors in corners and depths tilt the plane.
        let off = (self.seen.off[0] + self.seen.off[1]) / self.seen.units;
        let turned = window_depth.error * self.flatness / off;
        interval
            .widen_relative(self.seen.error() + 2.0 * self.flatness)
            .widen(turned)
            .clamp(0.0, f64::INFINITY)
    }
}

/// The part of a line that clipping leaves: its ends and their depths.
pub(crate) struct CutLine {
    pub(crate) ends: [SnapBox; 2],
    pub(crate) window_z: [Interval; 2],
    pub(crate) reciprocal_w: [Interval; 2],
    /// True if rounding can clip the whole line.
    pub(crate) may_be_clipped: bool,
}

impl CutLine {
    /// Returns the part of a line that clipping leaves; `None` if nothing is left.
    pub(crate) fn new(context: &PassContext<'_>, draw: &Draw, line: [usize; 2]) -> Option<Self> {
        let mut seen = VisiblePart::new(context, draw);
        let windows = line.map(|v| seen.window(v));
        let near = windows.map(|window| seen.near_viewport(window));
        let error = seen.error();
        let with = |slack: f64| {
            let depths = line.map(|v| seen.between_planes(v, slack));
            let functions = (0..5).map(|f| near.map(|values| values[f]));
            let planes = (0..2).map(|f| depths.map(|values| values[f]));
            clipped_segment(functions.chain(planes))
        };
        let outer = with(error)?;
        let inner = with(-error);
        let both = [Some(outer), inner];
        for t in both.into_iter().flatten().flatten() {
            seen.grow(&line, &[1.0 - t, t]);
        }
        // Near the viewport, w is 0 only where x and y are 0 too. All of such a line is at one place, and covers
        // nothing.
        if !seen.off.iter().all(|off| off.is_finite()) {
            return None;
        }
        let depth = draw.viewport.depth.map(f64::from);
        let sum = |t: f64, [a, b]: [f64; 2]| a * (1.0 - t) + b * t;
        let w = |t: f64| sum(t, windows.map(|v| v[2]));
        let z = line.map(|v| f64::from(draw.mesh.vertices[v].position[2]));
        let end = |i: usize| -> Vec<f64> { both.into_iter().flatten().map(|t| t[i]).collect() };
        let place = |i: usize| {
            let axis = |axis: usize| {
                let places = end(i).into_iter().map(|t| {
                    let exact = sum(t, windows.map(|v| v[axis])) / w(t);
                    // Equal positions stay equal, however their weights are rounded.
                    Interval::exact((exact * 1024.0).round() / 1024.0)
                });
                let hull = places
                    .reduce(Interval::hull)
                    .unwrap_or(Interval::EVERYTHING);
                hull.widen(seen.off[axis])
            };
            let (x, y) = (axis(0), axis(1));
            SnapBox {
                low: Point {
                    x: x.low.floor() as i64,
                    y: y.low.floor() as i64,
                },
                high: Point {
                    x: x.high.ceil() as i64,
                    y: y.high.ceil() as i64,
                },
            }
        };
        let value = |i: usize, value: &dyn Fn(f64) -> f64| {
            let values = end(i).into_iter().map(|t| Interval::exact(value(t)));
            let hull = values
                .reduce(Interval::hull)
                .unwrap_or(Interval::EVERYTHING);
            hull.widen_relative(error)
        };
        let window_z = [0, 1].map(|i| {
            let z = value(i, &|t| depth[0] + (depth[1] - depth[0]) * sum(t, z) / w(t));
            z.widen(error * depth[0].abs().max(depth[1].abs()))
        });
        Some(Self {
            ends: [0, 1].map(place),
            window_z,
            reciprocal_w: [0, 1].map(|i| value(i, &|t| 1.0 / w(t))),
            may_be_clipped: inner.is_none(),
        })
    }
}
