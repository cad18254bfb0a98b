//! Depth bias: the interval of biases that the rules allow.

use crate::context::PassContext;
use crate::depth::planes;
use crate::interval::Interval;
use crate::snap::{SnapBox, area, units_per_texel};
use etalon_frame::ChannelEncoding;
use etalon_scene::Draw;

/// A polygon that may be biased.
pub(crate) struct Biased<'a> {
    /// The depths of the polygon's vertices; for a cut polygon, all depths that it has.
    pub(crate) z: &'a [Interval],
    /// The primitive's snapped vertices; empty if the primitive is cut.
    pub(crate) boxes: &'a [SnapBox],
    /// Returns its least and greatest slope per texel.
    pub(crate) slope: &'a dyn Fn() -> Interval,
}

/// Returns the interval that the rules let a depth bias add (Vulkan, Depth Bias; OpenGL 4.6, 14.6.5).
pub(crate) fn depth_bias(context: &PassContext<'_>, draw: &Draw, polygon: &Biased<'_>) -> Interval {
    let Biased { z, boxes, .. } = *polygon;
    let state = draw.depth_bias;
    let (Some(encoding), true) = (context.depth, state.constant != 0 || state.slope != 0.0) else {
        return Interval::exact(0.0);
    };
    let range = context.rules.depth_bias_unit.value().range(encoding);
    let unit = match encoding {
        ChannelEncoding::Unorm(bits) => {
            let least = 2_f64.powi(-i32::from(bits));
            Interval {
                low: least * range.0,
                high: least * range.1,
            }
        }
        _ => {
            let exponent = |v: f64| v.max(f64::from(f32::MIN_POSITIVE)).log2().floor() as i32;
            // The rules leave open whether vertices beyond the near and far planes count.
            let inside = f64::from(draw.viewport.depth[0].min(draw.viewport.depth[1]));
            let lows = z.iter().map(|z| z.low);
            let low = if boxes.is_empty() || may_be_clipped(context, draw, boxes) {
                // The clipped polygon can have any of these depths, and its greatest depth gives the
                // exponent.
                lows.fold(f64::MAX, f64::min).max(0.0)
            } else {
                lows.fold(0.0, f64::max)
            };
            let low = if low > 1.0 { inside } else { low };
            let high = z.iter().map(|z| z.high).fold(0.0, f64::max);
            let least = 2_f64.powi(exponent(low) - 23);
            let greatest = 2_f64.powi(exponent(high) - 23);
            if greatest < f64::from(f32::MIN_POSITIVE) {
                // No unit of the normal numbers; the rules promise no others. Zero has no exponent at all, but
                // no depth has one above 0.
                Interval {
                    low: 0.0,
                    high: 2_f64.powi(-23) * range.1,
                }
            } else {
                Interval {
                    low: least * range.0,
                    high: greatest * range.1,
                }
            }
        }
    };
    let by_constant = unit
        .may_underflow()
        .times(Interval::exact(f64::from(state.constant)));
    let by_slope = (polygon.slope)().times(Interval::exact(f64::from(state.slope)));
    let sum = by_constant
        .plus(by_slope)
        .widen_relative(context.rules.float_error.value());
    let clamp = f64::from(state.clamp);
    if clamp > 0.0 {
        sum.map_increasing(|v| v.min(clamp))
    } else if clamp < 0.0 {
        sum.map_increasing(|v| v.max(clamp))
    } else {
        sum
    }
}

/// Returns true if a vertex can be snapped outside the viewport, at whose sides the primitive may be clipped.
fn may_be_clipped(context: &PassContext<'_>, draw: &Draw, boxes: &[SnapBox]) -> bool {
    let units = units_per_texel(context.limits) as f64;
    let [left, top, width, height] = draw.viewport.rect.map(f64::from);
    let outside = |low: i64, high: i64, start: f64, length: f64| {
        let ends = [start * units, (start + length) * units];
        let (least, most) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        (high as f64) < least || (low as f64) > most
    };
    boxes
        .iter()
        .any(|b| outside(b.low.x, b.high.x, left, width) || outside(b.low.y, b.high.y, top, height))
}

/// Returns the interval that a bias adds if the biased depths of the vertices may be clamped to 0 to 1 before
/// fragments interpolate them: one end is the room above the farthest depth, the other the room below the
/// nearest. Clipping can make vertices of any depth of the primitive.
pub(crate) fn clamped_at_vertices(bias: Interval, z: &[Interval]) -> Interval {
    let held = |z: f64| z.clamp(0.0, 1.0);
    let farthest = held(z.iter().map(|z| z.high).fold(f64::MIN, f64::max));
    let nearest = held(z.iter().map(|z| z.low).fold(f64::MAX, f64::min));
    bias.hull(Interval {
        low: held(farthest + bias.low) - farthest,
        high: held(nearest + bias.high) - nearest,
    })
}

/// Returns the least and the greatest slope of a plane that grows by `across` and `down` over a texel.
pub(crate) fn slope(context: &PassContext<'_>, across: f64, down: f64) -> Interval {
    let (larger, root) = etalon_pipeline::slope(across, down);
    let has_root = larger < root && context.rules.slope_root.value();
    Interval {
        low: larger,
        high: if has_root { root } else { larger },
    }
}

/// The number of roundings in a slope: differences of positions and depths, products, quotient and root.
const ROUNDINGS: f64 = 8.0;

/// Returns the least and greatest slope per texel over all snapped positions.
pub(crate) fn slopes(context: &PassContext<'_>, boxes: [SnapBox; 3], z: [Interval; 3]) -> Interval {
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
    let error = context.rules.float_error.value() * ROUNDINGS;
    let hull = z[0].hull(z[1]).hull(z[2]);
    // The error of each vertex's depth: half the depth's interval, plus the roundings of the terms that use
    // it.
    let off = z.map(|z| (z.high - z.low) / 2.0 + (hull.high - hull.low) * error);
    let step = context.step() as f64;
    // The plane that is 1 at one vertex and 0 at the others.
    let share = |vertex: usize| {
        let mut depths = [0.0; 3];
        depths[vertex] = 1.0;
        planes(boxes, depths)
    };
    let shares = share(0).zip(share(1)).zip(share(2));
    let slopes = planes(boxes, middle)
        .zip(shares)
        .map(|(plane, ((a, b), c))| {
            let growth = [a, b, c].map(|share| share.dx.hypot(share.dy));
            let by_depths: f64 = growth
                .iter()
                .zip(&off)
                .map(|(growth, off)| growth * off)
                .sum();
            // Positions may be those before or after snapping.
            let by_positions = growth.iter().sum::<f64>() * step;
            let slope = slope(context, plane.dx * units, plane.dy * units);
            slope.widen(by_depths * units + slope.high * by_positions)
        })
        .reduce(Interval::hull)
        .unwrap_or(Interval::exact(0.0));
    slopes.widen_relative(error).clamp(0.0, f64::INFINITY)
}
