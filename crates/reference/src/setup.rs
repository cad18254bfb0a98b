//! Primitive setup, once per draw: snapped positions and depths.

use crate::bias::{clamped_at_vertices, depth_bias};
use crate::context::PassContext;
use crate::depth::Depth;
use crate::distance::Distance;
use crate::interval::Interval;
use crate::judging::{Judging, Range};
use crate::primitive::{Shape, SnappedPrimitive, Triangle, VertexId};
use crate::rules::Snap;
use crate::snap::{SnapBox, units_per_texel};
use crate::texels::Lattice;
use etalon_pipeline::{Arithmetic, Plain, Point, shader, window_position};
use etalon_scene::{Draw, PolygonMode, PrimitiveVertices};
use smallvec::{SmallVec, smallvec};
use std::hash::{DefaultHasher, Hash, Hasher};

#[derive(Clone, Copy)]
struct Vertex {
    snapped: SnapBox,
    window_z: Interval,
    clip_z: Interval,
    id: VertexId,
}

/// What the primitives of one draw share.
struct Vertices {
    /// The vertices that were set up for a primitive before.
    known: Vec<Option<Vertex>>,
    geometry: DefaultHasher,
}

/// Returns a draw's primitives in drawing order, without those that are far from all judged texels.
pub(crate) fn draw(context: &PassContext<'_>, draw: &Draw) -> Vec<SnappedPrimitive> {
    let mut primitives = Vec::new();
    if draw.rasterizer_discard {
        return primitives;
    }
    let provoking = draw.provoking.map(|_| draw.provoking_vertices());
    let mut vertices = Vertices {
        known: vec![None; draw.mesh.vertices.len()],
        geometry: draw_geometry(draw),
    };
    for (index, one) in draw.primitives().into_iter().enumerate() {
        if is_far(context, draw, one) {
            continue;
        }
        // Without a convention, the flat colour may be that of any vertex.
        let own: SmallVec<[usize; 3]> = match (&provoking, one) {
            (Some(all), _) => smallvec![all[index]],
            (None, PrimitiveVertices::Point(i)) => smallvec![i],
            (None, PrimitiveVertices::Line(line)) => SmallVec::from_slice(&line),
            (None, PrimitiveVertices::Triangle(triangle)) => SmallVec::from_slice(&triangle),
        };
        let color = std::array::from_fn(|c| {
            let value = |i: &usize| Interval::exact(f64::from(draw.mesh.vertices[*i].color[c]));
            let hull = own.iter().map(value).reduce(Interval::hull);
            hull.unwrap_or(Interval::exact(0.0))
        });
        primitives.push(primitive(
            context,
            draw,
            &mut vertices,
            one,
            color,
            index as u32,
        ));
    }
    primitives
}

/// True if no judged texel is near a primitive, by a rough estimate: it is the whole cost of most of a
/// million small triangles.
fn is_far(context: &PassContext<'_>, draw: &Draw, one: PrimitiveVertices) -> bool {
    if context.lattice == Lattice::ALL {
        return false;
    }
    let own: &[usize] = match &one {
        PrimitiveVertices::Point(i) => &[*i],
        PrimitiveVertices::Line(line) => line,
        PrimitiveVertices::Triangle(triangle) => triangle,
    };
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for i in own {
        let position = draw.mesh.vertices[*i].position;
        let [[x], [y], _] = window_position(&mut Plain::<1>, position, &draw.viewport);
        for (axis, v) in [x, y].into_iter().enumerate() {
            if !v.is_finite() {
                return false;
            }
            // More than the rules let a position be off or a line reach beyond its ends.
            let slack = 4.0 + v.abs() / 1024.0;
            low[axis] = low[axis].min(v - slack);
            high[axis] = high[axis].max(v + slack);
        }
    }
    let [width, height] = context.size;
    // `as` saturates.
    let within = |v: f32, most: u32| (v as u32).min(most);
    !context.lattice.meets([
        within(low[0].floor(), width),
        within(low[1].floor(), height),
        within(high[0].ceil(), width),
        within(high[1].ceil(), height),
    ])
}

fn primitive(
    context: &PassContext<'_>,
    draw: &Draw,
    vertices: &mut Vertices,
    one: PrimitiveVertices,
    color: [Interval; 4],
    index: u32,
) -> SnappedPrimitive {
    let mut of = |i: usize| {
        let position = draw.mesh.vertices[i].position;
        *vertices.known[i].get_or_insert_with(|| vertex(context, draw, position))
    };
    let units = units_per_texel(context.limits);
    let grid = units >> context.limits.sub_pixel_bits;
    let error = context.rules.float_error.value();
    let mut bias = Interval::exact(0.0);
    let (shape, window_depth, clip_depth) = match one {
        PrimitiveVertices::Point(i) => {
            let v = of(i);
            (
                Shape::Point(v.snapped),
                Depth::flat(&[v.window_z]),
                Depth::flat(&[v.clip_z]),
            )
        }
        PrimitiveVertices::Line(line) => {
            let v = line.map(of);
            (
                Shape::Line(v.map(|v| v.snapped)),
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.window_z), units, error),
                // Vertices decide whether anything is clipped.
                Depth::along(v.map(|v| v.snapped), v.map(|v| v.clip_z), units, 0.0),
            )
        }
        PrimitiveVertices::Triangle(triangle) => {
            let v = triangle.map(of);
            let boxes = v.map(|v| v.snapped);
            let triangle = Triangle::new(boxes, v.map(|v| v.id), units);
            let window = Depth::over(boxes, v.map(|v| v.window_z), [units, grid], error);
            let z = v.map(|v| v.window_z);
            bias = depth_bias(context, draw, boxes, z);
            if !bias.is(0.0) && !context.rules.bias_clamps_fragments.value() {
                bias = clamped_at_vertices(bias, z);
            }
            let shape = match draw.polygon_mode {
                PolygonMode::Fill => Shape::Triangle(triangle),
                PolygonMode::Line => Shape::Outline(triangle),
            };
            // Vertices decide whether anything is clipped.
            let clip_z = v.map(|v| v.clip_z);
            let inside = clip_z.iter().all(|z| z.low >= 0.0 && z.high <= 1.0);
            let clip = match inside && draw.polygon_mode == PolygonMode::Fill {
                // Nothing is clipped, wherever the sample lies.
                true => Depth::flat(&clip_z),
                false => Depth::over(boxes, clip_z, [units, grid], error).between(&clip_z),
            };
            let mut depths = [window, clip];
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
    SnappedPrimitive {
        uv: texture_coordinates(context, draw, &shape, one).map(Box::new),
        distances: distances(context, draw, &shape, one),
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
        geometry: match (context.depth, draw.depth) {
            (Some(_), Some(_)) => Some(geometry(draw, one, vertices.geometry.clone())),
            _ => None,
        },
        index,
    }
}

/// Begins a number for the inputs of depth that all primitives of a draw share.
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

/// Returns a number for the vertices of a primitive in order and all other inputs of its depth.
fn geometry(draw: &Draw, one: PrimitiveVertices, mut hasher: DefaultHasher) -> u64 {
    let own = match one {
        PrimitiveVertices::Point(i) => [i, i, i],
        PrimitiveVertices::Line([a, b]) => [a, b, a],
        PrimitiveVertices::Triangle(triangle) => triangle,
    };
    for i in own {
        let position = draw.mesh.vertices[i].position;
        position.map(f32::to_bits).hash(&mut hasher);
    }
    hasher.finish()
}

/// Returns the texture coordinates over a primitive.
fn texture_coordinates(
    context: &PassContext<'_>,
    draw: &Draw,
    shape: &Shape,
    one: PrimitiveVertices,
) -> Option<[Depth; 2]> {
    if !draw.shader.uses_uv() {
        return None;
    }
    let units = units_per_texel(context.limits);
    let grid = units >> context.limits.sub_pixel_bits;
    let error = context.rules.float_error.value();
    let value = |i: usize, axis: usize| Interval::exact(f64::from(draw.mesh.vertices[i].uv[axis]));
    let w = |i: usize| draw.mesh.vertices[i].position[3];
    Some([0, 1].map(|axis| match (shape, one) {
        // Under a perspective coordinates are not linear in the picture, and all between the vertices'.
        (_, PrimitiveVertices::Triangle([a, b, c])) if w(a) != w(b) || w(b) != w(c) => {
            Depth::flat(&[a, b, c].map(|i| value(i, axis))).interpolated(error)
        }
        (_, PrimitiveVertices::Line([a, b])) if w(a) != w(b) => {
            Depth::flat(&[a, b].map(|i| value(i, axis))).interpolated(error)
        }
        (Shape::Triangle(triangle), PrimitiveVertices::Triangle(own)) => Depth::over(
            triangle.vertices,
            own.map(|i| value(i, axis)),
            [units, grid],
            error,
        ),
        (Shape::Outline(triangle), PrimitiveVertices::Triangle(own)) => {
            let values = own.map(|i| value(i, axis));
            let mut plane = Depth::over(triangle.vertices, values, [units, grid], error);
            plane.reach_out(units);
            plane
        }
        (Shape::Line(ends), PrimitiveVertices::Line(own)) => {
            Depth::along(*ends, own.map(|i| value(i, axis)), units, error)
        }
        (_, PrimitiveVertices::Point(i)) => Depth::flat(&[value(i, axis)]),
        (_, PrimitiveVertices::Line(own)) => Depth::flat(&own.map(|i| value(i, axis))),
        (_, PrimitiveVertices::Triangle(own)) => Depth::flat(&own.map(|i| value(i, axis))),
    }))
}

/// Returns the clip distances over a primitive, those that clip.
fn distances(
    context: &PassContext<'_>,
    draw: &Draw,
    shape: &Shape,
    one: PrimitiveVertices,
) -> Vec<Distance> {
    let clipping = draw.clipping_distances();
    if clipping == 0 {
        return Vec::new();
    }
    let units = units_per_texel(context.limits);
    let grid = units >> context.limits.sub_pixel_bits;
    let error = context.rules.float_error.value();
    let of = |i: usize| shader::clip_distances(draw.shader, &draw.mesh.vertices[i]);
    let w = |i: usize| draw.mesh.vertices[i].position[3];
    let numbers = (0..draw.shader.clip_distances() as usize).filter(|n| clipping & (1 << n) != 0);
    numbers
        .map(|n| {
            let value = |i: usize| of(i)[n];
            match (shape, one) {
                (Shape::Triangle(triangle), PrimitiveVertices::Triangle(own))
                    if w(own[0]) == w(own[1]) && w(own[1]) == w(own[2]) =>
                {
                    Distance::over(triangle.vertices, own.map(value), [units, grid], error)
                }
                (Shape::Line(ends), PrimitiveVertices::Line(own)) if w(own[0]) == w(own[1]) => {
                    Distance::along(*ends, own.map(value), units)
                }
                // Under a perspective they are not linear in the picture.
                (_, PrimitiveVertices::Triangle(own)) => Distance::between(&own.map(value)),
                (_, PrimitiveVertices::Line(own)) => Distance::between(&own.map(value)),
                (_, PrimitiveVertices::Point(own)) => Distance::between(&[value(own)]),
            }
        })
        .collect()
}

fn vertex(context: &PassContext<'_>, draw: &Draw, position: [f32; 4]) -> Vertex {
    let mut judging = Judging::new(context.rules);
    let window = window_position(&mut judging, position, &draw.viewport);
    let clip = judging.constant(position[2] / position[3]);
    let limits = context.limits;
    let grid = f64::from(1_u32 << limits.sub_pixel_bits);
    let step = units_per_texel(limits) >> limits.sub_pixel_bits;
    let snap = |range: Range| -> (i64, i64) {
        let Interval { low, high } = range.hull();
        let (low, high) = match context.rules.snap.value() {
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
        id: VertexId::new(position),
    }
}
