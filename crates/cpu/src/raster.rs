//! Rasterization of primitives to spans.

use crate::cut::{self, CutTriangle};
use crate::lanes::{LANES, Mask};
use crate::linear::{CENTER, UNITS, position};
use crate::memory::Memory;
use crate::planes::{PlaneVertex, Planes, clipping, depth_bias};
use crate::span::{Span, SpanState};
use crate::steps::Steps;
use etalon_frame::{ChannelEncoding, standard_sample_positions};
use etalon_pipeline::{
    Plain, Point, SnappedTriangle, front_facing, is_beyond, is_culled, signed_area, window_position,
};
use etalon_scene::{Draw, Interpolation, Pass, PolygonMode, PrimitiveVertices, Scene};

/// The supported sample counts.
pub(crate) const SAMPLES: [u32; 5] = [1, 2, 4, 8, 16];

/// The largest number of samples of a texel.
const MOST_SAMPLES: usize = SAMPLES[SAMPLES.len() - 1] as usize;

/// The left, top, right and bottom edges of the texels that a draw can write; right and bottom are exclusive.
pub(crate) type DrawBounds = [usize; 4];

/// Draws to the pass's attachments.
pub(crate) fn draw<S: Steps>(
    scene: &Scene,
    pass: &Pass,
    draw: &Draw,
    memory: &mut Memory<'_>,
    steps: &S,
) {
    if draw.rasterizer_discard {
        return;
    }
    let size = scene.pass_size(pass);
    let standard = standard_sample_positions(scene.pass_samples(pass));
    let points = |positions: Vec<[u16; 2]>| -> Vec<Point> {
        let point = |[x, y]: [u16; 2]| Point {
            x: i64::from(x) * UNITS / 256,
            y: i64::from(y) * UNITS / 256,
        };
        positions.into_iter().map(point).collect()
    };
    let shading = steps.sample_positions(standard);
    let covered = points(steps.coverage_positions(shading.clone()));
    let samples = points(shading);
    let vertices: Vec<PlaneVertex> = draw
        .mesh
        .vertices
        .iter()
        .map(|v| vertex(draw, v, steps))
        .collect();
    let mut state = SpanState::new(scene, pass, draw, &samples, memory, steps);
    let raster = Raster {
        draw,
        steps,
        samples: &covered,
        bounds: bounds(draw, size),
        encoding: state.depth_encoding(),
        interpolation: steps.interpolation(draw.shader, &draw.multisample).0,
    };
    let provoking = draw.provoking_vertices();
    for (primitive, provoking) in draw.primitives().into_iter().zip(provoking) {
        if is_beyond(draw, primitive) {
            continue;
        }
        // The colour is flat, so the provoking vertex gives it.
        let color = vertices[provoking].color;
        let vertex = |i: usize| PlaneVertex {
            color,
            ..vertices[i]
        };
        match primitive {
            PrimitiveVertices::Point(i) => raster.point(vertices[i], &mut state),
            PrimitiveVertices::Line(ends) => raster.line(ends.map(vertex), &mut state),
            PrimitiveVertices::Triangle(corners) => {
                raster.triangle(corners.map(vertex), &mut state);
            }
        }
    }
}

/// Returns a vertex in window coordinates.
fn vertex(draw: &Draw, v: &etalon_scene::Vertex, steps: &impl Steps) -> PlaneVertex {
    let [[x], [y], [z]] = window_position(&mut Plain::<1>, v.position, &draw.viewport);
    let clip_z = v.position[2] / v.position[3];
    PlaneVertex {
        position: v.position,
        at: Point {
            x: steps.snap(x),
            y: steps.snap(y),
        },
        z: steps.window_depth(z, clip_z, draw.viewport.depth),
        clip_z,
        color: v.color,
        uv: v.uv,
        distances: clipping(draw, v),
    }
}

/// Data that the primitives of a draw share.
struct Raster<'a, S> {
    draw: &'a Draw,
    steps: &'a S,
    samples: &'a [Point],
    bounds: DrawBounds,
    encoding: Option<ChannelEncoding>,
    interpolation: Interpolation,
}

impl<S: Steps> Raster<'_, S> {
    fn point(&self, vertex: PlaneVertex, state: &mut SpanState<'_, S>) {
        if cut::is_cut(self.draw, &vertex) || cut::is_beside(&[vertex]) {
            return;
        }
        let planes = self.flat_planes([vertex; 3]);
        let front = self.steps.lines_face_front();
        point(vertex, front, &planes, self.samples, self.bounds, state);
    }

    fn line(&self, ends: [PlaneVertex; 2], state: &mut SpanState<'_, S>) {
        if cut::is_beside(&ends) {
            return;
        }
        if let Some([a, b]) = cut::line(self.draw, ends) {
            let planes = self.flat_planes([a, b, a]);
            let front = self.steps.lines_face_front();
            let samples = self.samples.len();
            line([a, b], front, &planes, samples, self.bounds, state);
        }
    }

    /// Returns the planes of a point or line. Its depth bias is 0 unless a bug biases lines.
    fn flat_planes(&self, corners: [PlaneVertex; 3]) -> Planes {
        let points = corners.map(|v| v.at);
        let bias = if self.steps.biases_lines() {
            self.bias(points, &corners)
        } else {
            0.0
        };
        Planes::new(self.draw, self.interpolation, points, corners, bias, true)
    }

    fn bias(&self, points: [Point; 3], corners: &[PlaneVertex; 3]) -> f64 {
        let z = corners.each_ref().map(|v| v.z);
        depth_bias(self.draw, points, z, self.encoding, self.steps)
    }

    fn triangle(&self, corners: [PlaneVertex; 3], state: &mut SpanState<'_, S>) {
        let Self { draw, bounds, .. } = *self;
        let outlined = draw.polygon_mode == PolygonMode::Line;
        if !outlined && let Some(cut) = CutTriangle::new(draw, corners) {
            let front = cut.is_front(draw);
            if !is_culled(draw.cull, front) {
                let planes = cut.planes(draw, self.interpolation, self.encoding, self.steps);
                fill_cut(&cut, front, &planes, self.samples, bounds, state);
            }
            return;
        }
        let points = corners.map(|v| v.at);
        let front = front_facing(signed_area(points), draw.front_face);
        if is_culled(draw.cull, front) {
            return;
        }
        let owns = |from, to| self.steps.owns_edge(from, to);
        let Some(snapped) = SnappedTriangle::owning(points, owns) else {
            return;
        };
        let bias = self.bias(points, &corners);
        let planes = Planes::new(draw, self.interpolation, points, corners, bias, outlined);
        if outlined {
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let ends = [corners[i], corners[j]];
                line(ends, front, &planes, self.samples.len(), bounds, state);
            }
        } else {
            let inside = Inside {
                triangle: &snapped,
                front,
                color: corners[0].color,
            };
            fill(&inside, &planes, self.samples, bounds, state);
        }
    }
}

/// Returns the intersection of scissor rectangle, attachments, and the viewport extended by a texel.
pub(crate) fn bounds(draw: &Draw, size: [u32; 2]) -> DrawBounds {
    let [x, y, w, h] = draw.viewport.area();
    let [sx, sy, sw, sh] = draw.scissor.unwrap_or([0, 0, size[0], size[1]]);
    let axis = |start: f32, length: f32, s: u32, l: u32, size: u32| {
        let low = ((start - 1.0).max(0.0).floor() as u32).max(s);
        let high = ((start + length + 1.0).max(0.0).ceil() as u32)
            .min(s.saturating_add(l))
            .min(size);
        (low as usize, high.max(low) as usize)
    };
    let (left, right) = axis(x, w, sx, sw, size[0]);
    let (top, bottom) = axis(y, h, sy, sh, size[1]);
    [left, top, right, bottom]
}

/// A triangle to fill, and its flat values.
struct Inside<'a> {
    triangle: &'a SnappedTriangle,
    front: bool,
    color: [f32; 4],
}

/// Runs the spans of a triangle.
fn fill<S: Steps>(
    inside: &Inside<'_>,
    planes: &Planes,
    samples: &[Point],
    bounds: DrawBounds,
    state: &mut SpanState<'_, S>,
) {
    let triangle = inside.triangle;
    let vertices = triangle.vertices();
    let bound = |f: fn(&Point) -> i64, low: usize, high: usize| {
        let values = vertices.each_ref().map(f);
        let least = values.into_iter().min().unwrap_or(0).div_euclid(UNITS);
        let most = values.into_iter().max().unwrap_or(0).div_euclid(UNITS) + 1;
        let inside = |v: i64| v.clamp(low as i64, high as i64) as usize;
        (inside(least), inside(most))
    };
    let (left, right) = bound(|p| p.x, bounds[0], bounds[2]);
    let (top, bottom) = bound(|p| p.y, bounds[1], bounds[3]);
    // Enough masks for any sample count.
    let mut all_masks = [[false; LANES]; MOST_SAMPLES];
    let masks = &mut all_masks[..samples.len().min(MOST_SAMPLES)];
    for y in top..bottom {
        for x in (left / LANES * LANES..right).step_by(LANES) {
            let mut any = false;
            for (mask, sample) in masks.iter_mut().zip(samples) {
                let edges = triangle.edges_at(position(x, y, *sample));
                // An edge function is linear, so if both ends have the same sign, the whole span does.
                let last = |(value, dx): &(i64, i64)| value + dx * (LANES as i64 - 1) * UNITS;
                if edges.iter().any(|edge| edge.0 < 0 && last(edge) < 0) {
                    *mask = [false; LANES];
                    continue;
                }
                let whole = edges.iter().all(|edge| edge.0 >= 0 && last(edge) >= 0);
                *mask = std::array::from_fn(|lane| x + lane >= left && x + lane < right);
                if !whole {
                    for (lane, covered) in mask.iter_mut().enumerate() {
                        let step = lane as i64 * UNITS;
                        *covered &= edges.iter().all(|(value, dx)| value + dx * step >= 0);
                    }
                }
                planes.clip(mask, x, y, *sample);
                any |= mask.contains(&true);
            }
            if any {
                state.run(&Span {
                    x,
                    y,
                    masks,
                    front: inside.front,
                    color: inside.color,
                    depth: &|sample| planes.at(x, y, samples[sample]),
                    uv: planes.uv,
                    reciprocal_w: planes.reciprocal_w,
                });
            }
        }
    }
}

/// Runs the spans of a cut triangle.
fn fill_cut<S: Steps>(
    cut: &CutTriangle,
    front: bool,
    planes: &Planes,
    samples: &[Point],
    [left, top, right, bottom]: DrawBounds,
    state: &mut SpanState<'_, S>,
) {
    let mut all_masks = [[false; LANES]; MOST_SAMPLES];
    let masks = &mut all_masks[..samples.len().min(MOST_SAMPLES)];
    for y in top..bottom {
        for x in (left / LANES * LANES..right).step_by(LANES) {
            let mut any = false;
            for (mask, sample) in masks.iter_mut().zip(samples) {
                *mask = std::array::from_fn(|lane| {
                    let x = x + lane;
                    x >= left && x < right && cut.covers(position(x, y, *sample))
                });
                planes.clip(mask, x, y, *sample);
                any |= mask.contains(&true);
            }
            if any {
                state.run(&Span {
                    x,
                    y,
                    masks,
                    front,
                    color: cut.color(),
                    depth: &|sample| planes.at(x, y, samples[sample]),
                    uv: planes.uv,
                    reciprocal_w: planes.reciprocal_w,
                });
            }
        }
    }
}

/// Runs the texels in which a point covers samples, at most four.
fn point<S: Steps>(
    vertex: PlaneVertex,
    front: bool,
    planes: &Planes,
    samples: &[Point],
    bounds: DrawBounds,
    state: &mut SpanState<'_, S>,
) {
    let half = UNITS / 2;
    let first = |v: i64| (v - half).div_euclid(UNITS);
    for y in first(vertex.at.y)..=first(vertex.at.y) + 1 {
        for x in first(vertex.at.x)..=first(vertex.at.x) + 1 {
            let covered = |sample: &Point| {
                let at = Point {
                    x: x * UNITS + sample.x,
                    y: y * UNITS + sample.y,
                };
                let inside = |c: i64, s: i64| c - half <= s && s < c + half;
                inside(vertex.at.x, at.x) && inside(vertex.at.y, at.y)
            };
            let masks: Vec<bool> = samples.iter().map(covered).collect();
            texel((x, y), &masks, front, vertex.color, planes, bounds, state);
        }
    }
}

/// Runs the texels of the part of a line between the sides of the view volume: one per column, or per row if the line
/// is steep, with all samples of each. The last texel belongs to the next line (the diamond-exit rule, if the line does
/// not pass through corners).
fn line<S: Steps>(
    ends: [PlaneVertex; 2],
    front: bool,
    planes: &Planes,
    samples: usize,
    bounds: DrawBounds,
    state: &mut SpanState<'_, S>,
) {
    let [a, b] = ends;
    let (dx, dy) = (b.at.x - a.at.x, b.at.y - a.at.y);
    let steep = dy.abs() > dx.abs();
    let (from, to, cross_from, cross_to) = if steep {
        (a.at.y, b.at.y, a.at.x, b.at.x)
    } else {
        (a.at.x, b.at.x, a.at.y, b.at.y)
    };
    if from == to {
        return;
    }
    let Some(kept) = cut::between_sides([&a, &b]) else {
        return;
    };
    let [first, last] = kept.map(|share| from + ((to - from) as f64 * share).round() as i64);
    let (low, high) = (first.min(last), first.max(last));
    let center = |cell: i64| cell * UNITS + UNITS / 2;
    let masks = vec![true; samples];
    let first = (low - UNITS / 2).div_euclid(UNITS);
    for cell in first..=high.div_euclid(UNITS) {
        if center(cell) < low || center(cell) >= high {
            continue;
        }
        let along = center(cell) - from;
        let cross = cross_from + (cross_to - cross_from) * along / (to - from);
        let cross = cross.div_euclid(UNITS);
        let position = if steep { (cross, cell) } else { (cell, cross) };
        texel(position, &masks, front, a.color, planes, bounds, state);
    }
}

fn texel<S: Steps>(
    (x, y): (i64, i64),
    samples: &[bool],
    front: bool,
    color: [f32; 4],
    planes: &Planes,
    bounds: DrawBounds,
    state: &mut SpanState<'_, S>,
) {
    let inside = |v: i64, low: usize, high: usize| v >= low as i64 && v < high as i64;
    if !inside(x, bounds[0], bounds[2]) || !inside(y, bounds[1], bounds[3]) {
        return;
    }
    let (x, y) = (x as usize, y as usize);
    let start = x / LANES * LANES;
    let masks: Vec<Mask> = samples
        .iter()
        .map(|covered| {
            let mut mask = std::array::from_fn(|lane| *covered && start + lane == x);
            planes.clip(&mut mask, start, y, CENTER);
            mask
        })
        .collect();
    state.run(&Span {
        x: start,
        y,
        masks: &masks,
        front,
        color,
        depth: &|_| planes.at(start, y, CENTER),
        uv: planes.uv,
        reciprocal_w: planes.reciprocal_w,
    });
}
