//! Snapped primitives: the samples they can and must cover, and their depth there.

use crate::depth::Depth;
use crate::distance::ClipDistance;
use crate::interval::Interval;
use crate::possible::Possible;
use crate::range::Range as Values;
use crate::snap::{PackedBox, SnapBox, area, texel_of};
use crate::varying::Varying;
use etalon_pipeline::{DepthPlane, Point, edge_value};
use etalon_scene::InterpolationSampling;
use std::num::NonZeroU64;
use std::ops::Range;

/// The shape of a primitive.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// The inside of a triangle.
    Triangle(Triangle),
    /// The edges of a triangle.
    Outline(Triangle),
    /// A line one texel wide.
    Line([SnapBox; 2]),
    /// A point of one texel.
    Point {
        /// Where its centre is snapped to.
        center: SnapBox,
        /// Whether its vertex is between the sides of the view volume, which is decided before it is snapped.
        is_inside: bool,
    },
}

/// The identity of a vertex's position in the picture: its clip-space x, y and w, bit for bit. Edges are the
/// same if both ends are. Comparing x and y alone would join vertices that the perspective division
/// separates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct VertexId([u32; 3]);

impl VertexId {
    pub(crate) fn new([x, y, _, w]: [f32; 4]) -> Self {
        Self([x, y, w].map(f32::to_bits))
    }
}

/// A triangle's edges, each from a vertex to the next one.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    edges: Edges,
    /// The identities of the vertices' positions.
    pub(crate) ids: [VertexId; 3],
    /// Least and greatest signed area, y up.
    pub(crate) area: (i64, i64),
    /// The maximum change of an edge function near the triangle through legal snapping.
    moved: i64,
}

/// All edges of a triangle, in little memory: a picture can have a million triangles.
#[derive(Clone, Debug)]
enum Edges {
    /// Between snapped vertices.
    Between([PackedBox; 3]),
    /// At least one is cut, or very far out. The box contains the part of the triangle that can be visible.
    Cut(Box<([Edge; 3], SnapBox)>),
}

/// An edge of a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edge {
    /// Between two snapped vertices.
    Between([SnapBox; 2]),
    /// The remaining part of an edge that reaches behind the eye, or farther than vertices are snapped.
    /// Wherever legal clipping can put the edge, the line's value there is at most `off`.
    Cut { line: DepthPlane, off: f64 },
}

/// A primitive with snapped vertices.
#[derive(Clone, Debug)]
pub(crate) struct SnappedPrimitive {
    pub(crate) shape: Shape,
    /// True if a cull distance is negative at all vertices.
    pub(crate) beyond: bool,
    /// The least and the greatest flat vertex colour.
    pub(crate) color: [[f32; 2]; 4],
    /// Window depth, before any bias.
    pub(crate) window_depth: Depth,
    /// Clip-space depth, by which the near and far planes clip; `None` if they certainly clip nothing.
    pub(crate) clip_depth: Option<Box<Depth>>,
    /// The depth bias.
    pub(crate) bias: Interval,
    /// Texture coordinates, if the shader reads them.
    pub(crate) uv: Option<Box<[Varying; 2]>>,
    /// 1 over the clip-space w, if the shader reads it.
    pub(crate) reciprocal_w: Option<Box<Varying>>,
    /// The enabled clip distances.
    pub(crate) distances: Box<[ClipDistance]>,
    /// A number that is equal for the same vertices under the same viewport; `None` if the draw tests no
    /// depth, or if no other fragment of the scene can have the same.
    pub(crate) geometry: Option<NonZeroU64>,
    /// The primitive's index in the draw.
    pub(crate) index: u32,
}

/// The side of an edge on which a sample is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum EdgeSide {
    /// The edge function is positive under every legal snapping.
    Positive,
    /// The edge function is negative under every legal snapping.
    Negative,
    /// The sample is exactly on the edge under every legal snapping.
    On,
    /// The side depends on the snapping.
    Unknown,
}

impl Triangle {
    pub(crate) fn new(vertices: [SnapBox; 3], ids: [VertexId; 3], units: i64) -> Self {
        let size = |b: SnapBox| (b.high.x - b.low.x).max(b.high.y - b.low.y);
        let moved = vertices.map(size).into_iter().max().unwrap_or(0);
        let [a, b, c] = vertices;
        let bounds = a.hull(b).hull(c);
        // No sample of a texel that the triangle can touch is farther from a vertex.
        let reach = (bounds.high.x - bounds.low.x) + (bounds.high.y - bounds.low.y) + 4 * units;
        let edges = match vertices.map(PackedBox::new) {
            [Some(a), Some(b), Some(c)] => Edges::Between([a, b, c]),
            _ => {
                let edges = [[a, b], [b, c], [c, a]].map(Edge::Between);
                Edges::Cut(Box::new((edges, bounds)))
            }
        };
        Self {
            edges,
            ids,
            area: area(vertices),
            moved: 2 * moved * reach + 2 * moved * moved,
        }
    }

    /// Returns a triangle that can have cut edges. Whether a sample is inside a cut edge never depends on
    /// other primitives.
    pub(crate) fn cut(
        edges: [Edge; 3],
        ids: [VertexId; 3],
        area: (i64, i64),
        bounds: SnapBox,
    ) -> Self {
        Self {
            edges: Edges::Cut(Box::new((edges, bounds))),
            ids,
            area,
            moved: i64::MAX,
        }
    }

    /// Returns the hull of all snapped vertices, or of the visible part.
    #[inline]
    fn bounds(&self) -> SnapBox {
        match &self.edges {
            Edges::Between(vertices) => {
                let [a, b, c] = vertices.map(PackedBox::unpacked);
                a.hull(b).hull(c)
            }
            Edges::Cut(cut) => cut.1,
        }
    }

    /// Returns the edge from vertex `i` to the next one.
    #[inline]
    fn edge_from(&self, i: usize) -> Edge {
        match &self.edges {
            Edges::Between(vertices) => {
                Edge::Between([i, (i + 1) % 3].map(|i| vertices[i].unpacked()))
            }
            Edges::Cut(cut) => cut.0[i],
        }
    }

    /// Returns the edges, each from a vertex to the next one.
    pub(crate) fn edges(&self) -> [Edge; 3] {
        [0, 1, 2].map(|i| self.edge_from(i))
    }

    /// Returns the side of the edge from vertex `i` to the next one on which a point is.
    #[inline]
    pub(crate) fn side(&self, i: usize, at: Point) -> EdgeSide {
        // One corner decides most samples.
        if let Edges::Between(vertices) = &self.edges {
            let value = edge_value(vertices[i].low(), vertices[(i + 1) % 3].low(), at);
            if value > self.moved {
                return EdgeSide::Positive;
            } else if value < -self.moved {
                return EdgeSide::Negative;
            }
        }
        Self::side_of_edge(self.edge_from(i), at)
    }

    fn side_of_edge(edge: Edge, at: Point) -> EdgeSide {
        let (p, q) = match edge {
            Edge::Between([p, q]) => (p, q),
            Edge::Cut { line, off } => {
                let value = line.at(at);
                return if value > off {
                    EdgeSide::Positive
                } else if value < -off {
                    EdgeSide::Negative
                } else {
                    EdgeSide::Unknown
                };
            }
        };
        let (least, most) = edge_values(p, q, at);
        if least > 0 {
            EdgeSide::Positive
        } else if most < 0 {
            EdgeSide::Negative
        } else if p.is_exact() && q.is_exact() {
            EdgeSide::On
        } else {
            EdgeSide::Unknown
        }
    }

    /// Returns the columns of a row, within `among`, whose samples a triangle can cover, and the columns whose
    /// samples it certainly covers. The samples of a texel are inside `samples`.
    pub(crate) fn columns(
        &self,
        row: u32,
        among: Range<u32>,
        samples: SnapBox,
        units: i64,
    ) -> [Range<u32>; 2] {
        let (least, most) = self.area;
        let mut outer = i64::from(among.start)..i64::from(among.end);
        let mut inner = outer.clone();
        let sign = match (least > 0, most < 0) {
            // Edge functions are negative inside.
            (true, _) => 1,
            (_, true) => -1,
            _ => return [among, 0..0],
        };
        let top = i64::from(row) * units;
        let Edges::Between(vertices) = &self.edges else {
            return [among, 0..0];
        };
        for i in 0..3 {
            let (p, q) = (vertices[i].low(), vertices[(i + 1) % 3].low());
            let (dx, dy) = (sign * (q.x - p.x), sign * (q.y - p.y));
            // At the upper left corner of the texel in column x, the edge function is start + growth * x.
            let (start, growth) = (dx * (top - p.y) + dy * p.x, -dy * units);
            let values = samples.corners().map(|at| start + dx * at.y - dy * at.x);
            let lowest = values.into_iter().fold(i64::MAX, i64::min);
            let highest = values.into_iter().fold(i64::MIN, i64::max);
            keep_below(&mut outer, lowest, growth, self.moved);
            keep_below(&mut inner, highest, growth, -self.moved - 1);
        }
        let range = |r: Range<i64>| {
            if r.is_empty() {
                0..0
            } else {
                r.start as u32..r.end as u32
            }
        };
        [range(outer), range(inner)]
    }

    /// Returns the end points of an edge that passes exactly through its sample; `None` for a cut edge.
    pub(crate) fn edge(&self, i: usize) -> Option<(Point, Point)> {
        match self.edge_from(i) {
            Edge::Between([p, q]) => Some((p.low, q.low)),
            Edge::Cut { .. } => None,
        }
    }
}

/// Returns the least and the greatest value at a point of the function of an edge.
fn edge_values(p: SnapBox, q: SnapBox, at: Point) -> (i64, i64) {
    // The function is linear in each coordinate alone, so its extremes are at corners.
    let (mut least, mut most) = (i64::MAX, i64::MIN);
    for p in p.corners() {
        for q in q.corners() {
            let value = edge_value(p, q, at);
            least = least.min(value);
            most = most.max(value);
        }
    }
    (least, most)
}

/// Restricts columns to those in which a linear function is at most `most`.
fn keep_below(columns: &mut Range<i64>, start: i64, growth: i64, most: i64) {
    let room = most - start;
    match growth {
        0 if room < 0 => columns.end = columns.start,
        0 => {}
        1.. => columns.end = columns.end.min(room.div_euclid(growth) + 1),
        _ => {
            // x * growth <= room, so x is at least room / growth, rounded up.
            let least = -room.div_euclid(-growth);
            columns.start = columns.start.max(least);
        }
    }
}

/// An area of texels: left, top, right and bottom, the last two exclusive.
pub(crate) type Bounds = [i64; 4];

/// The least and the largest number of times that one primitive covers a sample.
pub(crate) type CoverTimes = (u32, u32);

impl Shape {
    /// Returns the hull of all snapped vertices, or of the visible part.
    #[inline]
    fn hull(&self) -> SnapBox {
        match self {
            Self::Triangle(triangle) | Self::Outline(triangle) => triangle.bounds(),
            Self::Line([a, b]) => a.hull(*b),
            Self::Point { center, .. } => *center,
        }
    }

    /// Returns the texels that a primitive of this shape can touch.
    pub(crate) fn bounds(&self, units: i64) -> Bounds {
        let reach = match self {
            Self::Triangle(_) => 0,
            _ => 2 * units,
        };
        let SnapBox { low, high } = self.hull();
        [
            texel_of(low.x - reach, units),
            texel_of(low.y - reach, units),
            texel_of(high.x + reach, units) + 1,
            texel_of(high.y + reach, units) + 1,
        ]
    }
}

impl SnappedPrimitive {
    /// Returns how often a point, a line or an outline covers a sample, from the box in which the sample lies. Triangles
    /// are walked edge by edge instead.
    pub(crate) fn times(&self, at: Point, sample: SnapBox, units: i64) -> CoverTimes {
        match &self.shape {
            Shape::Point { center, .. } => point_times(*center, sample, units),
            Shape::Line(ends) => line_times(*ends, at, units),
            Shape::Outline(triangle) => {
                let each = triangle.edges().map(|edge| match edge {
                    Edge::Between(ends) => line_times(ends, at, units),
                    Edge::Cut { .. } => (0, 1),
                });
                let most = each.iter().map(|t| t.1).sum();
                // The rules permit drawing overlapping edges only once.
                (each.iter().map(|t| t.0).max().unwrap_or(0), most)
            }
            Shape::Triangle(_) => (0, 1),
        }
    }

    /// Returns the flat vertex colour.
    pub(crate) fn flat_color(&self) -> [Interval; 4] {
        self.color.map(|ends| {
            let [low, high] = ends.map(f64::from);
            Interval { low, high }
        })
    }

    /// Returns the window depth at a sample that the primitive covers, with its bias; with the units of a texel, the
    /// depth at any covered point of the sample's texel.
    pub(crate) fn depth_at(&self, at: Point, anywhere: Option<i64>) -> Values {
        let mut depth = self.window_depth.at(at);
        if let Some(units) = anywhere {
            let hull = self.window_depth.hull;
            let texel = self.window_depth.over_texel(at, units);
            depth = depth.hull(texel.clamp(hull.low, hull.high));
        }
        Values::same(depth.plus(self.bias))
    }

    /// Returns the depth that a shader reads, with or without the bias. With several samples it can be the
    /// depth at any point of the texel.
    pub(crate) fn depth_seen(&self, at: Point, units: i64, samples: u32) -> Values {
        let mut depth = self.window_depth.at(at);
        if samples > 1 {
            depth = depth.hull(self.window_depth.over_texel(at, units));
        }
        let biased = depth.plus(self.bias);
        Values::same(depth.hull(biased))
    }

    /// Returns the texture coordinates at a sample that the primitive covers, if the shader reads any.
    pub(crate) fn uv_seen(
        &self,
        at: Point,
        units: i64,
        samples: u32,
        sampling: InterpolationSampling,
    ) -> Option<[Interval; 2]> {
        let both = self.uv.as_deref()?;
        let is_triangle = matches!(self.shape, Shape::Triangle(_));
        Some(both.each_ref().map(|value| match sampling {
            _ if samples == 1 => value.at(at),
            InterpolationSampling::Sample if is_triangle => value.at(at),
            InterpolationSampling::Centroid if is_triangle => {
                value.over_texel(at, units).clamp_to(value.hull())
            }
            _ => seen(value, at, units, samples),
        }))
    }

    /// Returns 1 over w at a sample that the primitive covers, if the shader reads it.
    pub(crate) fn w_seen(&self, at: Point, units: i64, samples: u32) -> Option<Interval> {
        let value = self.reciprocal_w.as_deref()?;
        Some(seen(value, at, units, samples))
    }

    /// Returns true if the shader reads texture coordinates that vary over the primitive.
    pub(crate) fn uv_varies(&self) -> bool {
        (self.uv.as_deref()).is_some_and(|uv| !uv.iter().all(Varying::is_flat))
    }

    /// Returns true if the shader reads 1 over w and it varies over the primitive.
    pub(crate) fn w_varies(&self) -> bool {
        (self.reciprocal_w.as_deref()).is_some_and(|w| !w.is_flat())
    }

    /// Returns true if a depth bias can move the primitive's fragments.
    pub(crate) fn is_biased(&self) -> bool {
        !self.bias.is(0.0)
    }

    /// Returns true if all vertices are inside a rectangle of left, top, width and height.
    pub(crate) fn inside_rect(&self, [x, y, w, h]: [f64; 4]) -> bool {
        let SnapBox { low, high } = self.shape.hull();
        low.x as f64 >= x && low.y as f64 >= y && high.x as f64 <= x + w && high.y as f64 <= y + h
    }

    /// Returns true if all vertices are beyond one side of a rectangle by more than `by` units, wherever they
    /// are snapped to.
    pub(crate) fn beyond_rect(&self, [x, y, w, h]: [f64; 4], by: f64) -> bool {
        let hull = self.shape.hull();
        let [low, high] = [hull.low, hull.high].map(|p| [p.x as f64, p.y as f64]);
        let beyond = |axis: usize, start: f64, length: f64| {
            high[axis] < start - by || low[axis] > start + length + by
        };
        beyond(0, x, w) || beyond(1, y, h)
    }

    /// Returns whether a covered sample is between the near and far planes.
    pub(crate) fn inside_depth(&self, at: Point, spread: Option<i64>) -> Possible {
        let Some(depth) = &self.clip_depth else {
            return Possible::Always;
        };
        let depth = match spread {
            None => depth.at(at),
            Some(units) => depth.over_texel(at, units),
        };
        Possible::of(
            depth.high >= 0.0 && depth.low <= 1.0,
            depth.low >= 0.0 && depth.high <= 1.0,
        )
    }
}

impl SnappedPrimitive {
    /// Returns whether the clip distances keep a covered sample: at a point, or anywhere in its texel if
    /// `spread` gives the units per texel.
    pub(crate) fn inside_distances(&self, at: Point, spread: Option<i64>) -> Possible {
        let mut inside = Possible::Always;
        for distance in &self.distances {
            inside = inside.and(match spread {
                None => distance.keeps(at),
                Some(units) => distance.keeps_in_texel(at, units),
            });
        }
        inside
    }
}

/// Returns a value that a shader reads. With several samples it can be the value at any point of the texel,
/// even at a centre outside the primitive (Vulkan, Interpolation Decorations; OpenGL 4.6, 14.3.1).
fn seen(value: &Varying, at: Point, units: i64, samples: u32) -> Interval {
    if samples > 1 {
        value.at(at).hull(value.over_texel(at, units))
    } else {
        value.at(at)
    }
}

fn point_times(center: SnapBox, sample: SnapBox, units: i64) -> CoverTimes {
    let half = units / 2;
    let axis = |[low, high]: [i64; 2], [first, last]: [i64; 2]| {
        let must = high - half < first && last < low + half;
        let can = low - half <= last && first <= high + half;
        (can, must)
    };
    let x = axis([center.low.x, center.high.x], [sample.low.x, sample.high.x]);
    let y = axis([center.low.y, center.high.y], [sample.low.y, sample.high.y]);
    (u32::from(x.1 && y.1), u32::from(x.0 && y.0))
}

/// Returns how often a line covers a sample. A line along an axis covers the texels it runs through, except
/// near its ends. Near the ends and at slanted lines, the rules (diamond exit, rectangle) differ, so anything
/// is legal there.
pub(crate) fn line_times(ends: [SnapBox; 2], at: Point, units: i64) -> CoverTimes {
    let [a, b] = ends;
    let bounds = a.hull(b);
    let unit = units as f64;
    let far = (2.5 * unit) as i64;
    // Such a fragment covers all samples of its texel (Vulkan, Bresenham Line Segment Rasterization).
    let middle = |position: i64| texel_of(position, units) * units + units / 2;
    let center = Point {
        x: middle(at.x),
        y: middle(at.y),
    };
    let is_near = center.x >= bounds.low.x - far
        && center.x <= bounds.high.x + far
        && center.y >= bounds.low.y - far
        && center.y <= bounds.high.y + far;
    if !is_near {
        return (0, 0);
    }
    let (dx, dy) = ((b.low.x - a.low.x) as f64, (b.low.y - a.low.y) as f64);
    let length = dx.hypot(dy);
    // Half a texel for the diamond, and one texel along each axis for a fragment that deviates.
    let along_axes = if length > 0.0 {
        (dx.abs() + dy.abs()) / length
    } else {
        2.0
    };
    let reach = unit * (0.5 + along_axes);
    let far_from_line = |value: i64| length > 0.0 && value as f64 > length * reach;
    // One corner of each box decides most texels.
    let is_far = far_from_line(edge_value(a.low, b.low, center).abs()) && {
        let (least, most) = edge_values(a, b, center);
        far_from_line(least.max(-most))
    };
    if is_far {
        return (0, 0);
    }
    // A texel is certain if it is more than 1.5 texels from both ends: half a texel for the diamond at an end,
    // and one texel for a fragment that deviates or is missing.
    let along = |low: i64, high: i64, position: i64| {
        position - units * 3 / 2 > low && position + units * 3 / 2 < high
    };
    // True if a line between two positions runs neither through the sample's texel nor through an adjacent
    // one.
    let misses =
        |low: i64, high: i64, position: i64| !touches(low - units, high + units, position, units);
    let across = |line: SnapBox, low: fn(Point) -> i64, position: i64| {
        let (least, most) = (low(line.low), low(line.high));
        let cell = texel_of(position, units);
        texel_of(least, units) == cell
            && texel_of(most, units) == cell
            && most - units / 2 < position
            && position < least + units / 2
    };
    let horizontal = a.low.y == b.low.y && a.high.y == b.high.y;
    let vertical = a.low.x == b.low.x && a.high.x == b.high.x;
    let x = (a.high.x.min(b.high.x), a.low.x.max(b.low.x));
    let y = (a.high.y.min(b.high.y), a.low.y.max(b.low.y));
    let must = (horizontal && along(x.0, x.1, at.x) && across(bounds, |p| p.y, at.y))
        || (vertical && along(y.0, y.1, at.y) && across(bounds, |p| p.x, at.x));
    // An axis-aligned line covers nothing farther away than the adjacent texel: a fragment may deviate by one
    // unit from the diamond-exit rule's fragment (OpenGL 3.3, 3.5.1; OpenGL 4.6, 14.5.1; OpenGL ES 3.2,
    // 13.6.1; Vulkan, Bresenham Line Segment Rasterization, which lines that are not strict may follow).
    let beside = (horizontal && misses(bounds.low.y, bounds.high.y, at.y))
        || (vertical && misses(bounds.low.x, bounds.high.x, at.x));
    (u32::from(must), u32::from(!beside))
}

/// Returns true if a line between two positions can run through a sample's texel.
fn touches(low: i64, high: i64, position: i64, units: i64) -> bool {
    let cell = texel_of(position, units);
    texel_of(low, units) <= cell && cell <= texel_of(high, units)
}

/// Returns the inner side of a triangle's edges. With y down, edge functions are negative inside a triangle
/// of positive area (y up).
pub(crate) fn inside_of(positive_area: bool) -> EdgeSide {
    if positive_area {
        EdgeSide::Negative
    } else {
        EdgeSide::Positive
    }
}

/// Returns true if a sample is outside a triangle of either orientation, and so uncovered in every world.
pub(crate) fn misses(triangle: &Triangle, sides: [EdgeSide; 3]) -> bool {
    let (least, most) = triangle.area;
    let outside = |positive: bool| sides.into_iter().any(|side| is_outside(side, positive));
    least != 0 && most != 0 && (most < 0 || outside(true)) && (least > 0 || outside(false))
}

/// Returns true if a side of an edge is certainly outside a triangle.
pub(crate) fn is_outside(side: EdgeSide, positive_area: bool) -> bool {
    matches!(side, EdgeSide::Positive | EdgeSide::Negative) && side != inside_of(positive_area)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_the_same_if_x_y_and_w_are() {
        let id = VertexId::new([0.5, -0.25, 0.75, 1.0]);
        assert_eq!(id, VertexId::new([0.5, -0.25, 0.125, 1.0]));
        assert_ne!(id, VertexId::new([0.5, -0.25, 0.75, 2.0]));
        assert_ne!(id, VertexId::new([0.5, 0.25, 0.75, 1.0]));
    }
}
