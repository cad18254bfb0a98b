//! Primitives, once per scene: snapped positions, facing, depth, and which rows they can reach.

use crate::depth::{Depth, depth_bias};
use crate::interval::Interval;
use crate::judging::{Judging, Range};
use crate::rules::{Rules, Snap};
use crate::texels::Lattice;
use etalon_frame::{ChannelEncoding, Limits};
use etalon_pipeline::{Arithmetic, Plain, Point, edge_value, signed_area, window_position};
use etalon_scene::{Draw, PolygonMode, PrimitiveVertices as Vertices};
use std::hash::{DefaultHasher, Hash, Hasher};

/// All positions that legal snapping can give one vertex: x and y each from low to high, in units
/// of [`units_per_texel`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct SnapBox {
    pub(crate) low: Point,
    pub(crate) high: Point,
}

impl SnapBox {
    pub(crate) fn corners(self) -> [Point; 4] {
        let point = |x, y| Point { x, y };
        [
            self.low,
            point(self.high.x, self.low.y),
            point(self.low.x, self.high.y),
            self.high,
        ]
    }

    pub(crate) fn is_exact(self) -> bool {
        self.low == self.high
    }

    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            low: Point {
                x: self.low.x.min(other.low.x),
                y: self.low.y.min(other.low.y),
            },
            high: Point {
                x: self.high.x.max(other.high.x),
                y: self.high.y.max(other.high.y),
            },
        }
    }
}

/// Sub-texel units: fine enough for the adapter's grid and for sample positions in 1/256 texel.
pub(crate) fn units_per_texel(limits: &Limits) -> i64 {
    1 << limits.sub_pixel_bits.max(8)
}

/// What a primitive covers.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    /// The inside of a triangle.
    Triangle(Triangle),
    /// The edges of a triangle.
    Outline(Triangle),
    /// A line one texel wide.
    Line([SnapBox; 2]),
    /// A point of one texel.
    Point(SnapBox),
}

/// A triangle's vertices in their own order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) vertices: [SnapBox; 3],
    /// Which positions coincide: equal numbers, equal places in clip space.
    pub(crate) ids: [u64; 3],
    /// Least and greatest signed area, y up.
    pub(crate) area: (i64, i64),
}

/// A primitive ready to be judged.
#[derive(Clone, Debug)]
pub(crate) struct Primitive {
    pub(crate) shape: Shape,
    /// The flat vertex colour.
    pub(crate) color: [Range; 4],
    /// Texels it may touch: left, top, right, bottom, the last two excluded.
    pub(crate) bounds: [i64; 4],
    /// Window depth, before any bias.
    window_depth: Depth,
    /// Clip-space depth, by which the near and far planes clip.
    clip_depth: Depth,
    /// What a depth bias adds.
    bias: Interval,
    /// All snapped vertices.
    all: SnapBox,
    /// Texture coordinates, where the shader reads them.
    uv: Option<[Depth; 2]>,
    /// Tells geometries apart: the same number, the same vertices under the same viewport. 0 where the
    /// draw tests no depth.
    pub(crate) geometry: u64,
    /// Its place in the draw.
    pub(crate) index: u32,
}

/// Where a sample lies relative to one edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// On the side where the edge function is positive, whatever the snapping.
    Positive,
    /// On the side where it is negative.
    Negative,
    /// On the edge exactly, whatever the snapping.
    On,
    /// It depends on the snapping.
    Unknown,
}

impl Triangle {
    /// The side of the edge from vertex `i` to the next one on which a point lies.
    pub(crate) fn side(&self, i: usize, at: Point) -> Side {
        let (p, q) = (self.vertices[i], self.vertices[(i + 1) % 3]);
        // One corner settles most samples: the others are no farther from it than the boxes let them
        // be.
        let size = |b: SnapBox| (b.high.x - b.low.x).max(b.high.y - b.low.y);
        let moved = size(p).max(size(q));
        let reach = |v: Point| (v.x - at.x).abs() + (v.y - at.y).abs();
        let bound = moved * (reach(p.low) + reach(q.low)) + 2 * moved * moved;
        match edge_value(p.low, q.low, at) {
            value if value > bound => return Side::Positive,
            value if value < -bound => return Side::Negative,
            _ => {}
        }
        // The edge function is linear in each coordinate alone, so its extremes stand at corners.
        let (mut least, mut most) = (i64::MAX, i64::MIN);
        for p in p.corners() {
            for q in q.corners() {
                let value = edge_value(p, q, at);
                least = least.min(value);
                most = most.max(value);
            }
        }
        if least > 0 {
            Side::Positive
        } else if most < 0 {
            Side::Negative
        } else if p.is_exact() && q.is_exact() {
            Side::On
        } else {
            Side::Unknown
        }
    }

    /// The exact end points of an edge that lies on its sample exactly.
    pub(crate) fn edge(&self, i: usize) -> (Point, Point) {
        (self.vertices[i].low, self.vertices[(i + 1) % 3].low)
    }
}

/// How often a sample is covered by one primitive: at least, at most.
pub(crate) type Times = (u32, u32);

impl Primitive {
    /// How often a sample of a texel is covered by a point, a line or an outline. Triangles are
    /// walked edge by edge instead.
    pub(crate) fn times(&self, at: Point, units: i64) -> Times {
        match &self.shape {
            Shape::Point(center) => point_times(*center, at, units),
            Shape::Line(ends) => line_times(*ends, at, units),
            Shape::Outline(triangle) => {
                let v = triangle.vertices;
                let edges = [[v[0], v[1]], [v[1], v[2]], [v[2], v[0]]];
                let each = edges.map(|edge| line_times(edge, at, units));
                let most = each.iter().map(|t| t.1).sum();
                // Edges that overlap may be drawn once.
                (each.iter().map(|t| t.0).max().unwrap_or(0), most)
            }
            Shape::Triangle(_) => (0, 1),
        }
    }

    /// The window depth at a sample that the primitive covers, with its bias.
    pub(crate) fn depth_at(&self, at: Point) -> Range {
        let depth = self.window_depth.at(at);
        Range::same(depth.corners(self.bias, |a, b| a + b))
    }

    /// The depth that a shader sees at the fragment of a texel: of several samples it may stand for
    /// any point of the texel, and whether a bias is in it is not told.
    pub(crate) fn depth_seen(&self, at: Point, units: i64, samples: u32) -> Range {
        let mut depth = self.window_depth.at(at);
        if samples > 1 {
            depth = depth.hull(self.window_depth.over_texel(at, units));
        }
        let biased = depth.corners(self.bias, |a, b| a + b);
        Range::same(depth.hull(biased))
    }

    /// The texture coordinates that a shader sees at a sample that the primitive covers, where it reads
    /// them. Of several samples they may be those of any point of the texel, the centre outside of the
    /// primitive too (Vulkan, Interpolation Decorations; OpenGL 4.6, 14.3.1).
    pub(crate) fn uv_seen(&self, at: Point, units: i64, samples: u32) -> Option<[Interval; 2]> {
        let both = self.uv.as_ref()?;
        Some(both.each_ref().map(|one| {
            if samples > 1 {
                one.at(at).hull(one.over_texel(at, units))
            } else {
                one.at(at)
            }
        }))
    }

    /// Whether a depth bias may move its fragments.
    pub(crate) fn is_biased(&self) -> bool {
        !self.bias.is(0.0)
    }

    /// Whether all vertices lie inside a rectangle of left, top, width and height.
    pub(crate) fn inside_rect(&self, [x, y, w, h]: [f64; 4]) -> bool {
        let (low, high) = (self.all.low, self.all.high);
        low.x as f64 >= x && low.y as f64 >= y && high.x as f64 <= x + w && high.y as f64 <= y + h
    }

    /// Whether a covered sample lies between near and far plane: whether it can, whether it must.
    pub(crate) fn inside_depth(&self, at: Point) -> (bool, bool) {
        let depth = self.clip_depth.at(at);
        (
            depth.high >= 0.0 && depth.low <= 1.0,
            depth.low >= 0.0 && depth.high <= 1.0,
        )
    }
}

fn point_times(center: SnapBox, at: Point, units: i64) -> Times {
    let half = units / 2;
    let axis = |low: i64, high: i64, at: i64| {
        let must = high - half < at && at < low + half;
        let can = low - half <= at && at <= high + half;
        (can, must)
    };
    let x = axis(center.low.x, center.high.x, at.x);
    let y = axis(center.low.y, center.high.y, at.y);
    (u32::from(x.1 && y.1), u32::from(x.0 && y.0))
}

/// A line that runs along an axis covers, between its end texels, the texels it runs through; at
/// the ends and beside slanted lines the rules (diamond exit, rectangle) differ, so that anything
/// is legal there.
fn line_times(ends: [SnapBox; 2], at: Point, units: i64) -> Times {
    let [a, b] = ends;
    let reach = units * 3 / 2;
    let all = a.hull(b);
    let near = at.x >= all.low.x - reach
        && at.x <= all.high.x + reach
        && at.y >= all.low.y - reach
        && at.y <= all.high.y + reach;
    let distance = edge_value(a.low, b.low, at).unsigned_abs() as f64;
    let length = ((b.low.x - a.low.x) as f64).hypot((b.low.y - a.low.y) as f64);
    // Legal snapping moves either end by no more than a texel's sixteenth, far less than the half
    // texel that the reach leaves over.
    if !near || (length > 0.0 && distance > length * reach as f64) {
        return (0, 0);
    }
    let along = |low: i64, high: i64, at: i64| at - units > low && at + units < high;
    // Whether a line between two positions neither runs through the sample's texel nor, one texel
    // wide, reaches the sample.
    let misses = |low: i64, high: i64, at: i64| {
        let far = at < low - units / 2 || at > high + units / 2;
        far && !touches(low, high, at, units)
    };
    let across = |line: SnapBox, low: fn(Point) -> i64, at: i64| {
        let (least, most) = (low(line.low), low(line.high));
        let cell = at.div_euclid(units);
        least.div_euclid(units) == cell
            && most.div_euclid(units) == cell
            && most - units / 2 < at
            && at < least + units / 2
    };
    let horizontal = a.low.y == b.low.y && a.high.y == b.high.y;
    let vertical = a.low.x == b.low.x && a.high.x == b.high.x;
    let x = (a.high.x.min(b.high.x), a.low.x.max(b.low.x));
    let y = (a.high.y.min(b.high.y), a.low.y.max(b.low.y));
    let must = (horizontal && along(x.0, x.1, at.x) && across(all, |p| p.y, at.y))
        || (vertical && along(y.0, y.1, at.y) && across(all, |p| p.x, at.x));
    // An axis-aligned line covers nothing farther beside it.
    let beside = (horizontal && misses(all.low.y, all.high.y, at.y))
        || (vertical && misses(all.low.x, all.high.x, at.x));
    (u32::from(must), u32::from(!beside))
}

/// Whether a line that lies between two positions can run through a sample's texel.
fn touches(low: i64, high: i64, at: i64, units: i64) -> bool {
    let cell = at.div_euclid(units);
    low.div_euclid(units) <= cell && cell <= high.div_euclid(units)
}

/// A draw's primitives and, per row of texels, those that may touch it, in drawing order.
#[derive(Clone, Debug)]
pub(crate) struct DrawSetup {
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) rows: Vec<Vec<u32>>,
}

#[derive(Clone, Copy)]
struct Vertex {
    snapped: SnapBox,
    window_z: Interval,
    clip_z: Interval,
    id: u64,
}

/// What [`draw`] needs to know besides the draw.
pub(crate) struct Context<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) limits: &'a Limits,
    /// The size of the pass's attachments.
    pub(crate) size: [u32; 2],
    /// Which of their texels are looked at.
    pub(crate) lattice: Lattice,
    /// The encoding of the pass's depth, where it has one.
    pub(crate) depth: Option<ChannelEncoding>,
}

pub(crate) fn draw(context: &Context<'_>, draw: &Draw) -> DrawSetup {
    let height = i64::from(context.size[1]);
    let mut rows = vec![Vec::new(); context.size[1] as usize];
    let mut primitives = Vec::new();
    if draw.rasterizer_discard {
        return DrawSetup { primitives, rows };
    }
    for (index, one) in draw.mesh.primitives(draw.topology).into_iter().enumerate() {
        if is_far(context, draw, one) {
            continue;
        }
        let own: Vec<usize> = match one {
            Vertices::Point(i) => vec![i],
            Vertices::Line(line) => line.to_vec(),
            Vertices::Triangle(triangle) => triangle.to_vec(),
        };
        let color = std::array::from_fn(|c| {
            let value = |i: &usize| Interval::exact(f64::from(draw.mesh.vertices[*i].color[c]));
            let hull = own.iter().map(value).reduce(Interval::hull);
            Range::same(hull.unwrap_or(Interval::exact(0.0)))
        });
        let mut primitive = primitive(context, draw, one, color, index as u32);
        primitive.uv = texture_coordinates(context, draw, &primitive.shape, one);
        let first = primitive.bounds[1].clamp(0, height) as usize;
        let last = primitive.bounds[3].clamp(0, height) as usize;
        for row in &mut rows[first..last.max(first)] {
            row.push(primitives.len() as u32);
        }
        primitives.push(primitive);
    }
    DrawSetup { primitives, rows }
}

/// Whether no texel that is looked at is anywhere near a primitive, by a rough estimate: most of a
/// million small triangles then cost no more than this.
fn is_far(context: &Context<'_>, draw: &Draw, one: Vertices) -> bool {
    if context.lattice == Lattice::ALL {
        return false;
    }
    let own: &[usize] = match &one {
        Vertices::Point(i) => &[*i],
        Vertices::Line(line) => line,
        Vertices::Triangle(triangle) => triangle,
    };
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for i in own {
        let position = draw.mesh.vertices[*i].position;
        let [[x], [y], _] = window_position(&mut Plain::<1>, position, &draw.viewport);
        for (axis, v) in [x, y].into_iter().enumerate() {
            if !v.is_finite() {
                return false;
            }
            // More than all that rules let a position be off and a line reach beyond its ends.
            let slack = 4.0 + v.abs() / 1024.0;
            low[axis] = low[axis].min(v - slack);
            high[axis] = high[axis].max(v + slack);
        }
    }
    let [width, height] = context.size;
    // `as` holds what is out of range to the ends.
    let within = |v: f32, most: u32| (v as u32).min(most);
    !context.lattice.meets([
        within(low[0].floor(), width),
        within(low[1].floor(), height),
        within(high[0].ceil(), width),
        within(high[1].ceil(), height),
    ])
}

fn primitive(
    context: &Context<'_>,
    draw: &Draw,
    one: Vertices,
    color: [Range; 4],
    index: u32,
) -> Primitive {
    let of = |i: usize| vertex(context, draw, draw.mesh.vertices[i].position);
    let units = units_per_texel(context.limits);
    let grid = units >> context.limits.sub_pixel_bits;
    let error = context.rules.float_error.value;
    let mut bias = Interval::exact(0.0);
    let (shape, window_depth, clip_depth) = match one {
        Vertices::Point(i) => {
            let v = of(i);
            (
                Shape::Point(v.snapped),
                Depth::flat(&[v.window_z]),
                Depth::flat(&[v.clip_z]),
            )
        }
        Vertices::Line(line) => {
            let v = line.map(of);
            (
                Shape::Line(v.map(|v| v.snapped)),
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.window_z), units),
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.clip_z), units),
            )
        }
        Vertices::Triangle(triangle) => {
            let v = triangle.map(of);
            let boxes = v.map(|v| v.snapped);
            let triangle = Triangle {
                vertices: boxes,
                ids: v.map(|v| v.id),
                area: area(boxes),
            };
            let window = Depth::over(boxes, v.map(|v| v.window_z), grid, error);
            bias = depth_bias(context, draw, boxes, v.map(|v| v.window_z));
            let shape = match draw.polygon_mode {
                PolygonMode::Fill => Shape::Triangle(triangle),
                PolygonMode::Line => Shape::Outline(triangle),
            };
            let mut depths = [window, Depth::over(boxes, v.map(|v| v.clip_z), grid, error)];
            if draw.polygon_mode == PolygonMode::Line {
                depths.iter_mut().for_each(|depth| depth.reach_out(units));
            }
            let [window, clip] = depths;
            (shape, window, clip)
        }
    };
    let all = match &shape {
        Shape::Point(one) => *one,
        Shape::Line([a, b]) => a.hull(*b),
        Shape::Triangle(t) | Shape::Outline(t) => {
            let [a, b, c] = t.vertices;
            a.hull(b).hull(c)
        }
    };
    let reach = match shape {
        Shape::Triangle(_) => 0,
        _ => 2 * units,
    };
    Primitive {
        shape,
        color,
        bounds: [
            (all.low.x - reach).div_euclid(units),
            (all.low.y - reach).div_euclid(units),
            (all.high.x + reach).div_euclid(units) + 1,
            (all.high.y + reach).div_euclid(units) + 1,
        ],
        window_depth,
        clip_depth,
        bias,
        all,
        uv: None,
        geometry: match (context.depth, draw.depth) {
            (Some(_), Some(_)) => geometry(draw, one),
            _ => 0,
        },
        index,
    }
}

/// A number for the vertices of a primitive in their order and all that its depth comes from.
fn geometry(draw: &Draw, one: Vertices) -> u64 {
    let mut hasher = DefaultHasher::new();
    let own = match one {
        Vertices::Point(i) => [i, i, i],
        Vertices::Line([a, b]) => [a, b, a],
        Vertices::Triangle(triangle) => triangle,
    };
    for i in own {
        let position = draw.mesh.vertices[i].position;
        position.map(f32::to_bits).hash(&mut hasher);
    }
    let viewport = &draw.viewport;
    viewport.rect.map(f32::to_bits).hash(&mut hasher);
    viewport.depth.map(f32::to_bits).hash(&mut hasher);
    let bias = draw.depth_bias;
    (bias.constant, bias.slope.to_bits(), bias.clamp.to_bits()).hash(&mut hasher);
    (draw.topology, draw.polygon_mode, draw.depth_clamp).hash(&mut hasher);
    hasher.finish()
}

/// The texture coordinates over a primitive.
fn texture_coordinates(
    context: &Context<'_>,
    draw: &Draw,
    shape: &Shape,
    one: Vertices,
) -> Option<[Depth; 2]> {
    if !draw.shader.uses_uv() {
        return None;
    }
    let units = units_per_texel(context.limits);
    let grid = units >> context.limits.sub_pixel_bits;
    let error = context.rules.float_error.value;
    let value = |i: usize, axis: usize| Interval::exact(f64::from(draw.mesh.vertices[i].uv[axis]));
    Some([0, 1].map(|axis| match (shape, one) {
        (Shape::Triangle(triangle), Vertices::Triangle(own)) => {
            Depth::over(triangle.vertices, own.map(|i| value(i, axis)), grid, error)
        }
        (Shape::Outline(triangle), Vertices::Triangle(own)) => {
            let values = own.map(|i| value(i, axis));
            let mut plane = Depth::over(triangle.vertices, values, grid, error);
            plane.reach_out(units);
            plane
        }
        (Shape::Line(ends), Vertices::Line(own)) => {
            Depth::along(*ends, own.map(|i| value(i, axis)), units)
        }
        (_, Vertices::Point(i)) => Depth::flat(&[value(i, axis)]),
        (_, Vertices::Line(own)) => Depth::flat(&own.map(|i| value(i, axis))),
        (_, Vertices::Triangle(own)) => Depth::flat(&own.map(|i| value(i, axis))),
    }))
}

pub(crate) fn area(boxes: [SnapBox; 3]) -> (i64, i64) {
    // One corner settles most triangles; see `side`.
    let size = |b: SnapBox| (b.high.x - b.low.x).max(b.high.y - b.low.y);
    let moved = boxes.map(size).into_iter().max().unwrap_or(0);
    let [a, b, c] = boxes.map(|b| b.low);
    let span = |p: Point, q: Point| (p.x - q.x).abs() + (p.y - q.y).abs();
    let bound = 2 * moved * (span(a, b) + span(b, c) + span(c, a)) + 8 * moved * moved;
    let one = signed_area([a, b, c]);
    if one.abs() > bound {
        return (one - bound, one + bound);
    }
    let (mut least, mut most) = (i64::MAX, i64::MIN);
    for a in boxes[0].corners() {
        for b in boxes[1].corners() {
            for c in boxes[2].corners() {
                let value = signed_area([a, b, c]);
                least = least.min(value);
                most = most.max(value);
            }
        }
    }
    (least, most)
}

fn vertex(context: &Context<'_>, draw: &Draw, position: [f32; 4]) -> Vertex {
    let mut judging = Judging::new(context.rules);
    let window = window_position(&mut judging, position, &draw.viewport);
    let clip = judging.constant(position[2] / position[3]);
    let limits = context.limits;
    let grid = f64::from(1_u32 << limits.sub_pixel_bits);
    let step = units_per_texel(limits) >> limits.sub_pixel_bits;
    let snap = |range: Range| -> (i64, i64) {
        let Interval { low, high } = range.hull();
        let (low, high) = match context.rules.snap.value {
            Snap::EitherSide => ((low * grid).floor(), (high * grid).ceil()),
            Snap::Nearest => ((low * grid + 0.5).floor(), (high * grid + 0.5).floor()),
        };
        (low as i64 * step, high as i64 * step)
    };
    let (x, y) = (snap(window[0]), snap(window[1]));
    Vertex {
        snapped: SnapBox {
            low: Point { x: x.0, y: y.0 },
            high: Point { x: x.1, y: y.1 },
        },
        window_z: window[2].hull(),
        clip_z: clip.hull(),
        id: u64::from(position[0].to_bits()) << 32 | u64::from(position[1].to_bits()),
    }
}
