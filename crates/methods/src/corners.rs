//! Corners of polygons and their area, for tests.

use crate::polygon::Polygon;
use glam::DVec3;

/// Returns the signed area of a polygon over x and y.
pub(crate) fn area(corners: &[DVec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let twice = corners.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y);
    twice.sum::<f64>() / 2.0
}

/// Returns the corners as vectors.
pub(crate) fn corners(polygon: &Polygon) -> Vec<DVec3> {
    polygon.corners.iter().map(|c| DVec3::from(*c)).collect()
}
