//! Depth over primitives: what snapping leaves of it, and what a bias adds.

use crate::interval::Interval;
use crate::setup::{Context, SnapBox, area, units_per_texel};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{DepthPlane, Point, slope};
use etalon_scene::Draw;

/// A depth over a primitive.
#[derive(Clone, Debug)]
pub(crate) struct Depth {
    /// The planes that legal snapping can lay through the vertices, by their extremes; none where
    /// the depth is the same everywhere or nothing is known but the vertices' depths.
    planes: Vec<DepthPlane>,
    /// How far a depth can lie off its plane.
    pub(crate) error: f64,
    /// Between the vertices' depths nothing leaves.
    pub(crate) hull: Interval,
}

impl Depth {
    pub(crate) fn flat(z: &[Interval]) -> Self {
        let hull = z.iter().copied().reduce(Interval::hull);
        Self {
            planes: Vec::new(),
            error: 0.0,
            hull: hull.unwrap_or(Interval::exact(0.0)),
        }
    }

    /// Over a line: its own rectangle and the texels at its ends reach beyond the vertices.
    pub(crate) fn along(ends: [SnapBox; 2], z: [Interval; 2], units: i64) -> Self {
        let mut depth = Self::flat(&z);
        if z[0] == z[1] {
            return depth;
        }
        let length = |low: Point, high: Point| {
            let (x, y) = ((high.x - low.x) as f64, (high.y - low.y) as f64);
            x.hypot(y)
        };
        let length = length(ends[0].low, ends[1].low).max(1.0);
        let own = depth.hull.high - depth.hull.low;
        depth.hull = depth.hull.widen(own * 2.0 * units as f64 / length);
        depth
    }

    pub(crate) fn over(
        vertices: [SnapBox; 3],
        z: [Interval; 3],
        grid: i64,
        float_error: f64,
    ) -> Self {
        let mut depth = Self::flat(&z);
        if z[0] == z[1] && z[1] == z[2] {
            return depth;
        }
        let middle = z.map(|z| (z.low + z.high) / 2.0);
        let (least, most) = area(vertices);
        if least <= 0 && most >= 0 {
            return depth;
        }
        depth.planes = planes(vertices, middle).collect();
        // Positions may be interpolated before or after snapping: one step of the grid.
        let own = z.iter().map(|z| z.high - z.low).fold(0.0, f64::max);
        let largest = z.iter().map(|z| z.high.abs()).fold(0.0, f64::max);
        depth.error = depth.steepest() * grid as f64 + own + largest * float_error;
        depth
    }

    /// The most that the depth can grow over one unit to the side and one down.
    pub(crate) fn steepest(&self) -> f64 {
        let all = self.planes.iter();
        let largest = all.fold((0.0, 0.0), |(x, y): (f64, f64), p| {
            (x.max(p.dx.abs()), y.max(p.dy.abs()))
        });
        largest.0 + largest.1
    }

    /// Over the edges of a triangle, which reach beyond it as lines do.
    pub(crate) fn reach_out(&mut self, units: i64) {
        let far = self.steepest() * 2.0 * units as f64;
        self.error += far;
        self.hull = self.hull.widen(far);
    }

    /// The hull over the texel that holds a point, inside of the primitive or not.
    pub(crate) fn over_texel(&self, point: Point, units: i64) -> Interval {
        let corner = |v: i64| v.div_euclid(units) * units;
        let (x, y) = (corner(point.x), corner(point.y));
        let corners = [(0, 0), (units, 0), (0, units), (units, units)];
        let depths = corners.map(|(dx, dy)| {
            self.beyond(Point {
                x: x + dx,
                y: y + dy,
            })
        });
        depths[1..]
            .iter()
            .fold(depths[0], |all, one| all.hull(*one))
    }

    pub(crate) fn at(&self, point: Point) -> Interval {
        self.beyond(point).clamp(self.hull.low, self.hull.high)
    }

    /// The depth at a point that need not lie inside.
    pub(crate) fn beyond(&self, point: Point) -> Interval {
        let all = self.planes.iter().map(|p| Interval::exact(p.at(point)));
        all.reduce(Interval::hull)
            .map_or(self.hull, |depth| depth.widen(self.error))
    }
}

/// The planes through all corners of the snapped positions: one where they are exact. What a
/// plane's growth can be is a quotient of functions linear in every coordinate alone, so its
/// extremes stand at corners.
fn planes(boxes: [SnapBox; 3], z: [f64; 3]) -> impl Iterator<Item = DepthPlane> {
    let corners = |b: SnapBox| {
        let all = b.corners();
        all.into_iter().take(if b.is_exact() { 1 } else { 4 })
    };
    corners(boxes[0]).flat_map(move |a| {
        corners(boxes[1])
            .flat_map(move |b| corners(boxes[2]).map(move |c| DepthPlane::new([a, b, c], z)))
    })
}

/// Everything that the rules let a depth bias add (Vulkan, Depth Bias; OpenGL 4.6, 14.6.5).
pub(crate) fn depth_bias(
    context: &Context<'_>,
    draw: &Draw,
    boxes: [SnapBox; 3],
    z: [Interval; 3],
) -> Interval {
    let state = draw.depth_bias;
    let (Some(encoding), true) = (context.depth, state.constant != 0 || state.slope != 0.0) else {
        return Interval::exact(0.0);
    };
    let rules = context.rules.depth_bias_unit.value;
    let unit = match encoding {
        ChannelEncoding::Unorm(bits) => {
            let least = 2_f64.powi(-i32::from(bits));
            let (low, high) = match bits {
                16 => rules.unorm16,
                _ => rules.unorm,
            };
            Interval {
                low: least * low,
                high: least * high,
            }
        }
        _ => {
            let exponent = |v: f64| v.max(f64::from(f32::MIN_POSITIVE)).log2().floor() as i32;
            // What near and far planes clip away may count or not.
            let inside = f64::from(draw.viewport.depth[0].min(draw.viewport.depth[1]));
            let low = z.iter().map(|z| z.low).fold(0.0, f64::max);
            let low = if low > 1.0 { inside } else { low };
            let high = z.iter().map(|z| z.high).fold(0.0, f64::max);
            Interval {
                low: 2_f64.powi(exponent(low) - 23) * rules.float.0,
                high: 2_f64.powi(exponent(high) - 23) * rules.float.1,
            }
        }
    };
    let by_constant = unit.corners(Interval::exact(f64::from(state.constant)), |a, b| a * b);
    let by_slope =
        slopes(context, boxes, z).corners(Interval::exact(f64::from(state.slope)), |a, b| a * b);
    let sum = by_constant
        .corners(by_slope, |a, b| a + b)
        .widen_relative(context.rules.float_error.value);
    let clamp = f64::from(state.clamp);
    if clamp > 0.0 {
        sum.map_increasing(|v| v.min(clamp))
    } else if clamp < 0.0 {
        sum.map_increasing(|v| v.max(clamp))
    } else {
        sum
    }
}

/// The least and greatest slope per texel over all snapped positions.
fn slopes(context: &Context<'_>, boxes: [SnapBox; 3], z: [Interval; 3]) -> Interval {
    let units = units_per_texel(context.limits) as f64;
    let middle = z.map(|z| (z.low + z.high) / 2.0);
    if z[0] == z[1] && z[1] == z[2] {
        return Interval::exact(0.0);
    }
    let (least, most) = area(boxes);
    if least <= 0 && most >= 0 {
        return Interval {
            low: 0.0,
            high: f64::from(f32::MAX),
        };
    }
    let slopes = planes(boxes, middle)
        .map(|plane| {
            let (low, high) = slope(plane.dx * units, plane.dy * units);
            Interval { low, high }
        })
        .reduce(Interval::hull)
        .unwrap_or(Interval::exact(0.0));
    // Positions may be taken before or after snapping, and depths carry their own error.
    slopes.widen_relative(0.01 + context.rules.float_error.value * 100.0)
}
