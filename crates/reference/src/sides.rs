//! The sides of a triangle's edges on which a sample is.

use crate::primitive::{EdgeSide, Triangle};
use crate::rules::Rules;
use crate::sample::Sample;
use etalon_pipeline::Point;

/// Returns the sides of a triangle's edges on which a sample at a point is.
pub(crate) fn sides(
    rules: &Rules,
    triangle: &Triangle,
    at: Sample,
    point: Point,
    units: i64,
) -> [EdgeSide; 3] {
    if at.samples == 1 || rules.covers_at_positions.value() {
        return [0, 1, 2].map(|i| triangle.side(i, point));
    }
    // The sample's position in the texel is open: it is certainly on one side only if the whole texel is.
    let corner = |dx: i64, dy: i64| Point {
        x: (i64::from(at.x) + dx) * units,
        y: (i64::from(at.y) + dy) * units,
    };
    let corners = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
    [0, 1, 2].map(|i| {
        let [first, others @ ..] = corners.map(|corner| triangle.side(i, corner));
        match first {
            EdgeSide::Positive | EdgeSide::Negative if others.iter().all(|o| *o == first) => first,
            _ => EdgeSide::Unknown,
        }
    })
}
