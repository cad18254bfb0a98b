//! Primitive setup, once per draw: snapped positions and depths.

use crate::bias::{Biased, clamped_at_vertices, depth_bias, slopes};
use crate::context::PassContext;
use crate::cut::{ClippedTriangle, CutLine, is_cut, is_cut_line};
use crate::depth::Depth;
use crate::distance::ClipDistance;
use crate::interval::Interval;
use crate::primitive::{Shape, SnappedPrimitive, Triangle, VertexId};
use crate::snap::{SnapBox, area, units_per_texel};
use crate::texels::Lattice;
use crate::varying::{Perspective, Varying};
use crate::vertex::{Grid, Vertices};
use etalon_pipeline::{Plain, is_beyond, shader, window_position};
use etalon_scene::{DepthBias, Draw, Interpolation, PolygonMode, PrimitiveVertices};
use smallvec::{SmallVec, smallvec};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::num::NonZeroU64;

/// The maximum number of vertices of a draw whose triangles are tried on the coarsest grid. Of many triangles,
/// one needs the adapter's grid.
const MOST_ON_COARSEST: usize = 256;

/// Functions that filter shapes by the judged samples of a pass.
pub(crate) struct Filter<'a> {
    /// Returns false if a shape misses all judged samples.
    pub(crate) keeps: &'a dyn Fn(&Shape) -> bool,
    /// Returns true if a shape covers or misses each judged sample, wherever its vertices are snapped.
    pub(crate) decides: &'a dyn Fn(&Shape) -> bool,
}

/// Returns a draw's primitives in drawing order, without primitives far from all judged texels and primitives
/// that the filter does not keep.
pub(crate) fn draw(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    filter: &Filter<'_>,
) -> Vec<SnappedPrimitive> {
    let mut primitives = Vec::new();
    if draw.rasterizer_discard {
        return primitives;
    }
    let provoking: Option<Vec<SmallVec<[usize; 3]>>> = if draw.shader.flat_from_either() {
        let ends = draw.primitive_ends().into_iter();
        Some(ends.map(|ends| SmallVec::from_slice(&ends)).collect())
    } else {
        let convention = draw.provoking.map(|_| draw.provoking_vertices());
        convention.map(|vertices| {
            vertices
                .into_iter()
                .map(|vertex| smallvec![vertex])
                .collect()
        })
    };
    vertices.enter(context, &draw.viewport);
    let draw_geometry = draw_geometry(draw);
    let assembled = draw.primitives();
    // On a lattice, most primitives can be far from all judged texels.
    if context.keeps_misses || context.lattice == Lattice::ALL {
        primitives.reserve_exact(assembled.len());
    }
    for (index, indices) in assembled.into_iter().enumerate() {
        if is_far(context, draw, indices) {
            continue;
        }
        // Without a convention, any vertex may provide the flat colour.
        let sources: SmallVec<[usize; 3]> = match (&provoking, indices) {
            (Some(candidates), _) => candidates[index].clone(),
            (None, PrimitiveVertices::Point(i)) => smallvec![i],
            (None, PrimitiveVertices::Line(line)) => SmallVec::from_slice(&line),
            (None, PrimitiveVertices::Triangle(triangle)) => SmallVec::from_slice(&triangle),
        };
        let color = std::array::from_fn(|c| {
            let values = sources.iter().map(|i| draw.mesh.vertices[*i].color[c]);
            let ends = values.map(|value| [value; 2]);
            let hull = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            hull.unwrap_or_default()
        });
        let geometry = match (context.depth, draw.depth) {
            (Some(_), Some(_)) => Some(geometry(draw, indices, draw_geometry.clone())),
            _ => None,
        };
        let primitive =
            parts(context, draw, vertices, indices, filter).map(|parts| SnappedPrimitive {
                shape: parts.shape,
                beyond: is_beyond(draw, indices),
                color,
                window_depth: parts.window_depth,
                clip_depth: Some(parts.clip_depth)
                    .filter(|depth| !(depth.hull.low >= 0.0 && depth.hull.high <= 1.0))
                    .map(Box::new),
                bias: parts.bias,
                uv: parts.uv.map(Box::new),
                reciprocal_w: parts.reciprocal_w.map(Box::new),
                distances: parts.distances.into(),
                geometry,
                index: index as u32,
            });
        primitives.extend(primitive.filter(|primitive| (filter.keeps)(&primitive.shape)));
    }
    primitives
}

/// Returns true if no judged texel of the scissor rectangle is near a primitive, by a rough estimate. Most of
/// a million small triangles need only this check.
fn is_far(context: &PassContext<'_>, draw: &Draw, indices: PrimitiveVertices) -> bool {
    let scissor = draw.scissor.filter(|_| !context.keeps_misses);
    if context.lattice == Lattice::ALL && scissor.is_none() {
        return false;
    }
    let corners: &[usize] = match &indices {
        PrimitiveVertices::Point(i) => &[*i],
        PrimitiveVertices::Line(line) => line,
        PrimitiveVertices::Triangle(triangle) => triangle,
    };
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for i in corners {
        let position = draw.mesh.vertices[*i].position;
        if position[3] <= 0.0 {
            return false;
        }
        let [[x], [y], _] = window_position(&mut Plain::<1>, position, &draw.viewport);
        for (axis, v) in [x, y].into_iter().enumerate() {
            if !v.is_finite() {
                return false;
            }
            // This is more than the legal error of a position, and more than a line's reach beyond its ends.
            let slack = 4.0 + v.abs() / 1024.0;
            low[axis] = low[axis].min(v - slack);
            high[axis] = high[axis].max(v + slack);
        }
    }
    let [width, height] = context.size;
    let [left, top, w, h] = scissor.unwrap_or([0, 0, width, height]);
    let ends = [left.saturating_add(w), top.saturating_add(h)];
    // The casts saturate.
    !context.lattice.meets([
        (low[0].floor() as u32).max(left),
        (low[1].floor() as u32).max(top),
        (high[0].ceil() as u32).min(ends[0]).min(width),
        (high[1].ceil() as u32).min(ends[1]).min(height),
    ])
}

/// The data that differ between shapes of primitives.
struct ShapeData {
    shape: Shape,
    window_depth: Depth,
    clip_depth: Depth,
    bias: Interval,
    uv: Option<[Varying; 2]>,
    reciprocal_w: Option<Varying>,
    distances: Vec<ClipDistance>,
}

/// Returns the parts of a primitive; `None` if all of it is clipped.
fn parts(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    indices: PrimitiveVertices,
    filter: &Filter<'_>,
) -> Option<ShapeData> {
    let fill = draw.polygon_mode == PolygonMode::Fill;
    match indices {
        PrimitiveVertices::Point(i) if is_cut(context, draw, &[i]) => {
            point_behind(context, draw, vertices, i)
        }
        PrimitiveVertices::Line(line) if is_cut_line(context, draw, line) => {
            cut_line(context, draw, line)
        }
        PrimitiveVertices::Triangle(triangle) if fill && is_cut(context, draw, &triangle) => {
            cut_triangle(context, draw, vertices, triangle)
        }
        PrimitiveVertices::Triangle(triangle)
            if fill && only_covers(context, draw, vertices, triangle) =>
        {
            let widest = snapped(context, draw, vertices, indices, Grid::Coarsest);
            Some(if (filter.decides)(&widest.shape) {
                widest
            } else {
                snapped(context, draw, vertices, indices, Grid::Adapter)
            })
        }
        _ => Some(snapped(context, draw, vertices, indices, Grid::Adapter)),
    }
}

/// Returns true if the position of a triangle only affects which samples it covers. If the coarsest grid
/// decides these, the adapter's grid is unimportant, and adapters with different grids share a legal set.
fn only_covers(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    triangle: [usize; 3],
) -> bool {
    let shader = draw.shader;
    let may = draw.mesh.vertices.len() <= MOST_ON_COARSEST
        && !context.keeps_misses
        && draw.depth_bias == DepthBias::default()
        && !shader.uses_uv()
        && !shader.reads_w()
        && !shader.reads_mask()
        && clipping_distances(draw).next().is_none();
    may && {
        let [a, b, c] = triangle.map(|i| vertices.get(context, draw, i, Grid::Coarsest));
        let mut others = [b, c].into_iter();
        others.all(|v| (v.window_z, v.clip_z) == (a.window_z, a.clip_z))
    }
}

/// Returns true if a position in clip space is between the left, right, bottom and top of the view volume.
fn is_between_sides([x, y, _, w]: [f32; 4]) -> bool {
    x.abs() <= w && y.abs() <= w
}

/// Returns the interval that a depth bias may add to a point or a line: none, and their own if the rules let them have
/// one. No specification defines the slope of a line, so the steepest between two sub-texels bounds it.
fn line_bias(
    context: &PassContext<'_>,
    draw: &Draw,
    z: [Interval; 3],
    boxes: [SnapBox; 3],
) -> Interval {
    let none = Interval::exact(0.0);
    if !context.rules.biases_lines.value() {
        return none;
    }
    let all = z.into_iter().fold(z[0], Interval::hull);
    let steepest = (all.high - all.low) * units_per_texel(context.limits) as f64;
    let biased = Biased {
        z: &z,
        boxes: &boxes,
        slope: &|| Interval {
            low: 0.0,
            high: steepest,
        },
    };
    depth_bias(context, draw, &biased).hull(none)
}

/// Returns a primitive whose vertices are in front of the eye and are snapped.
fn snapped(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    indices: PrimitiveVertices,
    grid: Grid,
) -> ShapeData {
    let units = units_per_texel(context.limits);
    let error = context.rules.float_error.value();
    let v = match indices {
        PrimitiveVertices::Point(i) => [i; 3],
        PrimitiveVertices::Line([a, b]) => [a, b, a],
        PrimitiveVertices::Triangle(triangle) => triangle,
    }
    .map(|i| vertices.get(context, draw, i, grid));
    let boxes = v.map(|v| v.snapped);
    let mut bias = match indices {
        PrimitiveVertices::Triangle(_) => Interval::exact(0.0),
        PrimitiveVertices::Point(_) | PrimitiveVertices::Line(_) => {
            line_bias(context, draw, v.map(|v| v.window_z), boxes)
        }
    };
    let (shape, window_depth, clip_depth) = match indices {
        PrimitiveVertices::Point(i) => (
            Shape::Point {
                center: v[0].snapped,
                is_inside: is_between_sides(draw.mesh.vertices[i].position),
            },
            Depth::flat(&[v[0].window_z]),
            Depth::flat(&[v[0].clip_z]),
        ),
        PrimitiveVertices::Line(_) => {
            let v = [v[0], v[1]];
            (
                Shape::Line(v.map(|v| v.snapped)),
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.window_z), units, error),
                // Only the vertices decide whether anything is clipped.
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.clip_z), units, 0.0),
            )
        }
        PrimitiveVertices::Triangle(_) => {
            let triangle = Triangle::new(boxes, v.map(|v| v.id), units);
            let sub_texels = context.sub_texels();
            let window = Depth::over(boxes, v.map(|v| v.window_z), sub_texels, error);
            let z = v.map(|v| v.window_z);
            let biased = Biased {
                z: &z,
                boxes: &boxes,
                slope: &|| slopes(context, boxes, z),
            };
            bias = depth_bias(context, draw, &biased);
            if !bias.is(0.0) && !context.rules.bias_clamps_fragments.value() {
                bias = clamped_at_vertices(bias, &z);
            }
            let shape = match draw.polygon_mode {
                PolygonMode::Fill => Shape::Triangle(triangle),
                PolygonMode::Line => Shape::Outline(triangle),
            };
            // Only the vertices decide whether anything is clipped.
            let clip_z = v.map(|v| v.clip_z);
            let inside = clip_z.iter().all(|z| z.low >= 0.0 && z.high <= 1.0);
            let clip = if inside && draw.polygon_mode == PolygonMode::Fill {
                // Nothing is clipped at any sample.
                Depth::flat(&clip_z)
            } else {
                Depth::over(boxes, clip_z, sub_texels, error).between(&clip_z)
            };
            let mut depths = [window, clip];
            if draw.polygon_mode == PolygonMode::Line {
                depths.iter_mut().for_each(|depth| depth.reach_out(units));
            }
            let [window, clip] = depths;
            (shape, window, clip)
        }
    };
    let over = Over {
        context,
        draw,
        outline: matches!(shape, Shape::Outline(_)),
        indices,
        boxes,
    };
    ShapeData {
        uv: draw.shader.uses_uv().then(|| over.uv()),
        reciprocal_w: draw.shader.reads_w().then(|| over.reciprocal_w()),
        distances: over.distances(),
        shape,
        window_depth,
        clip_depth,
        bias,
    }
}

/// Returns a point behind the eye, or too far out for the grid, at the position that the division by w gives,
/// if the rules let it be drawn.
fn point_behind(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    i: usize,
) -> Option<ShapeData> {
    let [.., w] = draw.mesh.vertices[i].position;
    let [width, height] = context.size.map(|s| s as f32);
    let [[across], [down], _] = window_position(
        &mut Plain::<1>,
        draw.mesh.vertices[i].position,
        &draw.viewport,
    );
    let near = across.abs() < 4.0 * width && down.abs() < 4.0 * height;
    // Without near and far planes, only the sides of the view volume discard it, and OpenGL leaves that open.
    let clips = context.rules.clips_points.value() && !draw.depth_clamp;
    if clips || w == 0.0 || !near {
        return None;
    }
    let mut parts = snapped(
        context,
        draw,
        vertices,
        PrimitiveVertices::Point(i),
        Grid::Adapter,
    );
    parts.distances.push(ClipDistance::UNKNOWN);
    Some(parts)
}

/// Returns the part of a triangle that clipping leaves if it reaches behind the eye.
fn cut_triangle(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    triangle: [usize; 3],
) -> Option<ShapeData> {
    let cut = ClippedTriangle::new(context, draw, triangle)?;
    let boxes = triangle.map(|i| {
        let uncut = !is_cut(context, draw, &[i]);
        uncut.then(|| vertices.get(context, draw, i, Grid::Adapter).snapped)
    });
    let ids = triangle.map(|i| VertexId::new(draw.mesh.vertices[i].position));
    let window_depth = cut.window_depth();
    let biased = Biased {
        z: &[window_depth.hull],
        boxes: &[],
        slope: &|| cut.slope(&window_depth),
    };
    let mut bias = depth_bias(context, draw, &biased);
    if !bias.is(0.0) && !context.rules.bias_clamps_fragments.value() {
        bias = clamped_at_vertices(bias, &[window_depth.hull]);
    }
    let clipping = clipping_distances(draw);
    Some(ShapeData {
        shape: Shape::Triangle(cut.triangle(boxes, ids)),
        clip_depth: cut.clip_depth(),
        bias,
        uv: draw.shader.uses_uv().then(|| cut.uv()),
        reciprocal_w: draw.shader.reads_w().then(|| cut.reciprocal_w()),
        distances: clipping
            .map(|n| cut.distance(triangle.map(|i| distance(draw, i, n))))
            .collect(),
        window_depth,
    })
}

/// Returns the part of a line that clipping leaves if it reaches behind the eye or crosses the near or far
/// plane.
fn cut_line(context: &PassContext<'_>, draw: &Draw, line: [usize; 2]) -> Option<ShapeData> {
    let cut = CutLine::new(context, draw, line)?;
    let units = units_per_texel(context.limits);
    let error = context.rules.float_error.value();
    let between = |values: [f64; 2]| {
        Varying::Linear(Depth::flat(&values.map(Interval::exact)).interpolated(error))
    };
    let uv = |axis: usize| between(line.map(|i| f64::from(draw.mesh.vertices[i].uv[axis])));
    let mut distances: Vec<ClipDistance> = clipping_distances(draw)
        .map(|n| {
            let values = line.map(|i| distance(draw, i, n));
            if may_stay_unclipped(context, values) {
                ClipDistance::UNKNOWN
            } else {
                ClipDistance::between(&values)
            }
        })
        .collect();
    let may_be_missing = cut.may_be_clipped || may_be_lost_behind(context, draw, line);
    distances.extend(may_be_missing.then_some(ClipDistance::UNKNOWN));
    Some(ShapeData {
        shape: Shape::Line(cut.ends),
        window_depth: Depth::along(cut.ends, cut.window_z, units, error),
        // The near and far planes have already clipped the line.
        clip_depth: Depth::flat(&[Interval::exact(0.5)]),
        bias: Interval::exact(0.0),
        uv: draw.shader.uses_uv().then(|| [uv(0), uv(1)]),
        reciprocal_w: draw
            .shader
            .reads_w()
            .then(|| Varying::Linear(Depth::along(cut.ends, cut.reciprocal_w, units, error))),
        distances,
    })
}

/// Begins the hash of the inputs of depth with the inputs that all primitives of a draw share.
fn draw_geometry(draw: &Draw) -> DefaultHasher {
    let mut hasher = DefaultHasher::new();
    let viewport = &draw.viewport;
    viewport.rect.map(f32::to_bits).hash(&mut hasher);
    viewport.depth.map(f32::to_bits).hash(&mut hasher);
    let bias = draw.depth_bias;
    (bias.constant, bias.slope.to_bits(), bias.clamp.to_bits()).hash(&mut hasher);
    (draw.topology, draw.polygon_mode, draw.depth_clamp).hash(&mut hasher);
    draw.tessellation.hash(&mut hasher);
    hasher
}

/// Returns the hash of a primitive's vertices in order and of all other inputs of its depth.
fn geometry(draw: &Draw, indices: PrimitiveVertices, mut hasher: DefaultHasher) -> NonZeroU64 {
    let corners = match indices {
        PrimitiveVertices::Point(i) => [i, i, i],
        PrimitiveVertices::Line([a, b]) => [a, b, a],
        PrimitiveVertices::Triangle(triangle) => triangle,
    };
    for i in corners {
        let position = draw.mesh.vertices[i].position;
        position.map(f32::to_bits).hash(&mut hasher);
    }
    NonZeroU64::new(hasher.finish()).unwrap_or(NonZeroU64::MIN)
}

/// Values over a primitive in front of the eye.
struct Over<'a> {
    context: &'a PassContext<'a>,
    draw: &'a Draw,
    /// True if only the edges of a triangle are drawn.
    outline: bool,
    indices: PrimitiveVertices,
    /// The snapped vertices; the first ones are repeated if there are fewer than three.
    boxes: [SnapBox; 3],
}

impl Over<'_> {
    fn w(&self, i: usize) -> f64 {
        f64::from(self.draw.mesh.vertices[i].position[3])
    }

    fn units(&self) -> i64 {
        units_per_texel(self.context.limits)
    }

    /// Returns the texture coordinates.
    fn uv(&self) -> [Varying; 2] {
        [0, 1].map(|axis| self.varying(|i| f64::from(self.draw.mesh.vertices[i].uv[axis])))
    }

    fn varying(&self, value: impl Fn(usize) -> f64) -> Varying {
        let error = self.context.rules.float_error.value();
        let perspective = self.draw.shader.interpolation() == Interpolation::Perspective;
        let w = |i: usize| self.w(i);
        match self.indices {
            PrimitiveVertices::Triangle(corners)
                if perspective && corners.iter().any(|i| w(*i) != w(corners[0])) =>
            {
                let values = corners.map(&value);
                let flat = values[0] == values[1] && values[1] == values[2];
                let (least, most) = area(self.boxes);
                if self.outline || flat || (least <= 0 && most >= 0) {
                    let exact = values.map(Interval::exact);
                    return Varying::Linear(Depth::flat(&exact).interpolated(error));
                }
                let (w, step) = (corners.map(w), self.context.step());
                Varying::Perspective(Perspective::over(self.boxes, w, values, step, error))
            }
            PrimitiveVertices::Line([a, b]) if perspective && w(a) != w(b) => {
                let values = [a, b].map(|i| Interval::exact(value(i)));
                Varying::Linear(Depth::flat(&values).interpolated(error))
            }
            _ => Varying::Linear(self.linear(value)),
        }
    }

    /// Returns a value that is linear in the window.
    fn linear(&self, value: impl Fn(usize) -> f64) -> Depth {
        let units = self.units();
        let error = self.context.rules.float_error.value();
        match self.indices {
            PrimitiveVertices::Triangle(corners) => {
                let values = corners.map(|i| Interval::exact(value(i)));
                let sub_texels = self.context.sub_texels();
                let mut plane = Depth::over(self.boxes, values, sub_texels, error);
                if self.outline {
                    plane.reach_out(units);
                }
                plane
            }
            PrimitiveVertices::Line(ends) => {
                let [a, b, _] = self.boxes;
                let values = ends.map(|i| Interval::exact(value(i)));
                Depth::along([a, b], values, units, error)
            }
            PrimitiveVertices::Point(i) => Depth::flat(&[Interval::exact(value(i))]),
        }
    }

    /// Returns 1 over w, which is linear in the window.
    fn reciprocal_w(&self) -> Varying {
        let error = self.context.rules.float_error.value();
        Varying::Linear(self.linear(|i| 1.0 / self.w(i)).interpolated(error))
    }

    /// Returns the enabled clip distances.
    fn distances(&self) -> Vec<ClipDistance> {
        let error = self.context.rules.float_error.value();
        let [a, b, _] = self.boxes;
        clipping_distances(self.draw)
            .map(|n| {
                let value = |i: usize| distance(self.draw, i, n);
                let over_w = |i: usize| value(i) / self.w(i);
                match self.indices {
                    PrimitiveVertices::Triangle(corners) if !self.outline => {
                        let sub_texels = self.context.sub_texels();
                        ClipDistance::over(self.boxes, corners.map(over_w), sub_texels, error)
                    }
                    PrimitiveVertices::Line(ends)
                        if may_stay_unclipped(self.context, ends.map(value)) =>
                    {
                        ClipDistance::UNKNOWN
                    }
                    PrimitiveVertices::Line(ends) if self.w(ends[0]) == self.w(ends[1]) => {
                        ClipDistance::along([a, b], ends.map(value), self.units())
                    }
                    // Along a line in perspective, clip distances are not linear in the picture.
                    PrimitiveVertices::Triangle(corners) => {
                        ClipDistance::between(&corners.map(value))
                    }
                    PrimitiveVertices::Line(ends) => ClipDistance::between(&ends.map(value)),
                    PrimitiveVertices::Point(vertex) => ClipDistance::between(&[value(vertex)]),
                }
            })
            .collect()
    }
}

/// Returns the indices of the enabled clip distances.
fn clipping_distances(draw: &Draw) -> impl Iterator<Item = usize> {
    let clipping = draw.clipping_distances();
    (0..draw.shader.clip_distances() as usize).filter(move |n| clipping & (1 << n) != 0)
}

/// Returns true if a line with these clip distances at its ends can legally continue beyond a clipped end.
fn may_stay_unclipped(context: &PassContext<'_>, distances: [f64; 2]) -> bool {
    let is_clipped = distances.iter().any(|distance| *distance < 0.0);
    is_clipped && !context.rules.clips_lines_by_distance.value()
}

/// Returns true if a line can legally be missing because an end is behind the eye.
fn may_be_lost_behind(context: &PassContext<'_>, draw: &Draw, line: [usize; 2]) -> bool {
    let is_behind = |i: usize| draw.mesh.vertices[i].position[3] <= 0.0;
    line.into_iter().any(is_behind) && !context.rules.keeps_lines_that_end_behind.value()
}

/// Returns a clip distance of a vertex.
fn distance(draw: &Draw, vertex: usize, n: usize) -> f64 {
    f64::from(shader::clip_distances(draw.shader, &draw.mesh.vertices[vertex])[n])
}
