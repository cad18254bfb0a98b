//! Primitives, once per scene: snapped positions, facing, depth, and which rows they can reach.

use crate::interval::Interval;
use crate::judging::{Judging, Range};
use crate::rules::{Rules, Snap};
use etalon_case::scene::Draw;
use etalon_frame::Limits;
use etalon_pipeline::{Point, edge_value, signed_area, window_position};

/// All positions that legal snapping can give one vertex: x and y each from low to high, in units
/// of [`units_per_texel`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct SnapBox {
    pub(crate) low: Point,
    pub(crate) high: Point,
}

impl SnapBox {
    fn corners(self) -> [Point; 4] {
        let point = |x, y| Point { x, y };
        [
            self.low,
            point(self.high.x, self.low.y),
            point(self.low.x, self.high.y),
            self.high,
        ]
    }

    fn is_exact(self) -> bool {
        self.low == self.high
    }
}

/// Sub-texel units: fine enough for the adapter's grid and for sample positions in 1/256 texel.
pub(crate) fn units_per_texel(limits: &Limits) -> i64 {
    1 << limits.sub_pixel_bits.max(8)
}

/// A triangle ready to be judged.
#[derive(Clone, Debug)]
pub(crate) struct Primitive {
    /// Vertices in their own order.
    pub(crate) vertices: [SnapBox; 3],
    /// Which positions coincide: equal numbers, equal places in clip space.
    pub(crate) ids: [u64; 3],
    /// Least and greatest signed area, y up.
    pub(crate) area: (i64, i64),
    /// Window depth over the whole primitive.
    pub(crate) depth: Range,
    /// The flat vertex colour.
    pub(crate) color: [Range; 4],
    /// Texels it may touch: left, top, right, bottom, the last two excluded.
    pub(crate) bounds: [i64; 4],
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

impl Primitive {
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

/// A draw's primitives and, per row of texels, those that may touch it, in drawing order.
#[derive(Clone, Debug)]
pub(crate) struct DrawSetup {
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) rows: Vec<Vec<u32>>,
}

pub(crate) fn draw(rules: &Rules, limits: &Limits, draw: &Draw, size: [u32; 2]) -> DrawSetup {
    let vertices: Vec<(SnapBox, Range)> = draw
        .mesh
        .vertices
        .iter()
        .map(|v| vertex(rules, limits, v.position, size))
        .collect();
    let id = |i: usize| {
        let [x, y, ..] = draw.mesh.vertices[i].position.map(f32::to_bits);
        u64::from(x) << 32 | u64::from(y)
    };
    let units = units_per_texel(limits);
    let mut rows = vec![Vec::new(); size[1] as usize];
    let mut primitives = Vec::new();
    for triangle in draw.mesh.triangles(draw.topology) {
        let boxes = triangle.map(|i| vertices[i].0);
        let depth = triangle
            .map(|i| vertices[i].1)
            .into_iter()
            .reduce(|a, b| Range::same(a.float.hull(b.float)))
            .unwrap_or(Range::exact(0.0));
        let color = std::array::from_fn(|c| {
            let values = triangle.map(|i| f64::from(draw.mesh.vertices[i].color[c]));
            let hull = values
                .into_iter()
                .map(Interval::exact)
                .reduce(Interval::hull)
                .unwrap_or(Interval::exact(0.0));
            Range::same(hull)
        });
        let least = |f: fn(Point) -> i64| boxes.iter().map(|b| f(b.low)).min().unwrap_or(0);
        let most = |f: fn(Point) -> i64| boxes.iter().map(|b| f(b.high)).max().unwrap_or(0);
        let bounds = [
            least(|p| p.x).div_euclid(units),
            least(|p| p.y).div_euclid(units),
            most(|p| p.x).div_euclid(units) + 1,
            most(|p| p.y).div_euclid(units) + 1,
        ];
        let first = bounds[1].clamp(0, i64::from(size[1])) as usize;
        let last = bounds[3].clamp(0, i64::from(size[1])) as usize;
        for row in &mut rows[first..last.max(first)] {
            row.push(primitives.len() as u32);
        }
        primitives.push(Primitive {
            vertices: boxes,
            ids: triangle.map(id),
            area: area(boxes),
            depth,
            color,
            bounds,
        });
    }
    DrawSetup { primitives, rows }
}

fn area(boxes: [SnapBox; 3]) -> (i64, i64) {
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

fn vertex(rules: &Rules, limits: &Limits, position: [f32; 4], size: [u32; 2]) -> (SnapBox, Range) {
    let window = window_position(&mut Judging::new(rules), position, size);
    let grid = f64::from(1_u32 << limits.sub_pixel_bits);
    let step = units_per_texel(limits) >> limits.sub_pixel_bits;
    let snap = |range: Range| -> (i64, i64) {
        let Interval { low, high } = range.hull();
        let (low, high) = match rules.snap.value {
            Snap::EitherSide => ((low * grid).floor(), (high * grid).ceil()),
            Snap::Nearest => ((low * grid + 0.5).floor(), (high * grid + 0.5).floor()),
        };
        (low as i64 * step, high as i64 * step)
    };
    let (x, y) = (snap(window[0]), snap(window[1]));
    let snapped = SnapBox {
        low: Point { x: x.0, y: y.0 },
        high: Point { x: x.1, y: y.1 },
    };
    (snapped, window[2])
}
