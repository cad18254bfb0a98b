//! Depth over a triangle: its plane, and the slope that a depth bias scales.

use crate::coverage::{Point, signed_area};

/// Window depth as a linear function of window position, from the vertices' depths and snapped
/// positions. Units are those of [`Point`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthPlane {
    origin: [f64; 2],
    z: f64,
    /// Growth per unit to the right.
    pub dx: f64,
    /// Growth per unit down.
    pub dy: f64,
}

impl DepthPlane {
    /// Returns the plane of a value at the top left corner and its growth per unit.
    pub fn of(z: f64, dx: f64, dy: f64) -> Self {
        let origin = [0.0; 2];
        Self { origin, z, dx, dy }
    }

    /// Returns the value at the top left corner and the growth per unit to the right and down.
    pub fn parts(&self) -> [f64; 3] {
        [self.at(Point::default()), self.dx, self.dy]
    }

    /// Returns the plane through three vertices; flat if they span no area.
    pub fn new(points: [Point; 3], z: [f64; 3]) -> Self {
        let [a, b, c] = points;
        // With y down the determinant is the negated signed area.
        let determinant = -signed_area(points) as f64;
        let (bx, by) = ((b.x - a.x) as f64, (b.y - a.y) as f64);
        let (cx, cy) = ((c.x - a.x) as f64, (c.y - a.y) as f64);
        let (d1, d2) = (z[1] - z[0], z[2] - z[0]);
        let per = |numerator: f64| {
            if determinant == 0.0 {
                0.0
            } else {
                numerator / determinant
            }
        };
        Self {
            origin: [a.x, a.y].map(|v| v as f64),
            z: z[0],
            dx: per(d1 * cy - d2 * by),
            dy: per(d2 * bx - d1 * cx),
        }
    }

    /// Returns the plane that is linear along a line and constant across it; flat if the line has no length.
    pub fn along([a, b]: [Point; 2], z: [f64; 2]) -> Self {
        let (x, y) = ((b.x - a.x) as f64, (b.y - a.y) as f64);
        let square = x * x + y * y;
        let growth = if square == 0.0 {
            0.0
        } else {
            (z[1] - z[0]) / square
        };
        Self {
            origin: [a.x, a.y].map(|v| v as f64),
            z: z[0],
            dx: growth * x,
            dy: growth * y,
        }
    }

    /// Returns the depth at a point.
    pub fn at(&self, point: Point) -> f64 {
        let [x, y] = self.origin;
        let dx = (point.x as f64 - x) * self.dx;
        let dy = (point.y as f64 - y) * self.dy;
        self.z + dx + dy
    }
}

/// Returns the least and the greatest value that specifications allow for the maximum slope of a plane, from
/// its growth per texel: the larger of the two growths, and the root of their squares (Vulkan, Depth Bias;
/// OpenGL 4.6, 14.6.5).
pub fn slope(dx: f64, dy: f64) -> (f64, f64) {
    (dx.abs().max(dy.abs()), dx.hypot(dy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_goes_through_its_vertices() {
        let point = |x, y| Point { x, y };
        let points = [point(3, 5), point(90, 7), point(20, 70)];
        let z = [0.25, 0.5, 0.125];
        let plane = DepthPlane::new(points, z);
        for (point, z) in points.into_iter().zip(z) {
            assert!((plane.at(point) - z).abs() < 1e-12);
        }
        assert_eq!(slope(3.0, -4.0), (4.0, 5.0));
    }

    #[test]
    fn a_line_has_the_values_of_its_ends() {
        let [a, b] = [(3, 1), (7, 4)].map(|(x, y)| Point { x, y });
        let line = DepthPlane::along([a, b], [-1.0, 4.0]);
        assert!((line.at(a) + 1.0).abs() < 1e-12 && (line.at(b) - 4.0).abs() < 1e-12);
        // Across, nothing changes.
        let beside = Point {
            x: a.x - 3,
            y: a.y + 4,
        };
        assert!((line.at(beside) + 1.0).abs() < 1e-12);
        assert_eq!(DepthPlane::along([a, a], [2.0, 3.0]).at(b), 2.0);
    }
}
