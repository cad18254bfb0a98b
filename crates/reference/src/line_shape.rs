//! The rectangle and the parallelogram of a line that is one texel wide (Vulkan, Basic Line Segment Rasterization).

use crate::snap::SnapBox;
use etalon_pipeline::Point;

/// Lines that are shorter than this many texels are not judged by their shape: the direction of a short line depends on
/// how its ends are snapped.
const LEAST_LENGTH: f64 = 3.0;

/// Returns whether a sample is certainly in the shape of a line, and whether it can be. The line's ends can be anywhere
/// in their boxes, its shape can be the rectangle or the parallelogram, and the shape's corners are snapped to a grid
/// with this step, in sub-texel units.
pub(crate) fn shape_holds(ends: [SnapBox; 2], at: Point, units: i64, step: f64) -> (bool, bool) {
    let middle = |v: SnapBox| {
        [
            (v.low.x + v.high.x) as f64 / 2.0,
            (v.low.y + v.high.y) as f64 / 2.0,
        ]
    };
    let reach = |v: SnapBox| ((v.high.x - v.low.x) as f64).hypot((v.high.y - v.low.y) as f64) / 2.0;
    let [a, b] = ends.map(middle);
    let unit = units as f64;
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let length = dx.hypot(dy);
    if length < LEAST_LENGTH * unit {
        return (false, true);
    }
    let moved = reach(ends[0]).max(reach(ends[1]));
    // A corner moves with its end, by the rotation about it, and by a step along each axis.
    let slack = moved + unit * moved / length + 1.5 * step;
    let [px, py] = [at.x as f64 - a[0], at.y as f64 - a[1]];
    let across = (dx * py - dy * px).abs() / length;
    let along = (dx * px + dy * py) / length;
    // The least distance to a side, negative outside.
    let rectangle = (unit / 2.0 - across).min(along).min(length - along);
    let parallelogram = |d: f64, p: f64| {
        let along = if d > 0.0 { p } else { -p };
        (unit / 2.0 * d.abs() / length - across)
            .min(along)
            .min(d.abs() - along)
    };
    // The larger difference is that of the major axis; either can be if they are nearly equal.
    let depths = [
        Some(rectangle),
        (dx.abs() >= dy.abs() - 2.0 * slack).then(|| parallelogram(dx, px)),
        (dy.abs() >= dx.abs() - 2.0 * slack).then(|| parallelogram(dy, py)),
    ];
    let mut each = depths.iter().flatten();
    let is_inside = each.all(|depth| *depth > slack);
    let can_be_inside = depths.iter().flatten().any(|depth| *depth >= -slack);
    (is_inside, can_be_inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the result for a line from (0.5, 0.5) to (8.5, 4.5) without open ends.
    fn holds(x: f64, y: f64) -> (bool, bool) {
        let point = |x: f64, y: f64| Point {
            x: (x * 256.0) as i64,
            y: (y * 256.0) as i64,
        };
        let end = |x, y| SnapBox {
            low: point(x, y),
            high: point(x, y),
        };
        shape_holds([end(0.5, 0.5), end(8.5, 4.5)], point(x, y), 256, 1.0)
    }

    #[test]
    fn a_sample_in_one_of_the_shapes_alone_is_open() {
        assert_eq!(holds(4.5, 2.5), (true, true));
        // The parallelogram reaches half a texel up and down, the rectangle 0.56.
        assert_eq!(holds(4.5, 2.5 + 0.48), (true, true));
        assert_eq!(holds(4.5, 2.5 + 0.53), (false, true));
        assert_eq!(holds(4.5, 2.5 + 0.58), (false, false));
    }

    #[test]
    fn a_sample_beyond_an_end_is_outside() {
        assert_eq!(holds(9.5, 5.0), (false, false));
        assert_eq!(holds(0.1, 0.2), (false, false));
        assert_eq!(holds(0.6, 0.55), (true, true));
    }
}
