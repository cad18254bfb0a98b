//! Triangles in homogeneous window coordinates: what the perspective division leaves of a triangle that
//! reaches behind the eye, without clipping (Olano, Greer 1997, Triangle Scan Conversion using 2D Homogeneous
//! Coordinates).
//!
//! A window point is in the part of a triangle in front of the eye if its three weights are not negative. The
//! sum of the weights times the vertices' values is the value over w, which is linear in the window; the sum
//! of the weights alone is 1 over w.

use crate::coverage::Point;
use crate::depth::DepthPlane;
use etalon_scene::Viewport;

/// A clip-space position in homogeneous window coordinates: x and y in sub-texel units, times w, and w.
pub type WindowVertex = [f64; 3];

/// Returns the homogeneous window coordinates of a clip-space position, with `units` units per texel.
pub fn window_vertex(position: [f32; 4], viewport: &Viewport, units: f64) -> WindowVertex {
    let [x, y, _, w] = position.map(f64::from);
    let [left, top, width, height] = viewport.rect.map(|v| f64::from(v) * units);
    [
        x * width / 2.0 + w * (left + width / 2.0),
        w * (top + height / 2.0) - y * height / 2.0,
        w,
    ]
}

/// The farthest that a snapped vertex can be from the corner of the picture, in units: products of two
/// differences fit into an integer.
pub const FARTHEST: f64 = (1_u64 << 28) as f64;

/// Returns true if the perspective division or the grid cannot place a vertex: it is behind the eye, or too
/// far out.
pub fn is_cut([x, y, w]: WindowVertex) -> bool {
    let far = |v: f64| {
        let quotient = v / w;
        quotient.is_nan() || quotient.abs() > FARTHEST
    };
    w <= 0.0 || far(x) || far(y)
}

/// Returns the line through two points of the window. It is 0 on the line, and elsewhere has the sign of
/// [`crate::edge_value`] if both points are in front of the eye. Exchanging the points negates it, bit for
/// bit.
pub fn line_through([ax, ay, aw]: WindowVertex, [bx, by, bw]: WindowVertex) -> DepthPlane {
    DepthPlane::of(ax * by - ay * bx, ay * bw - aw * by, aw * bx - ax * bw)
}

/// A triangle in homogeneous window coordinates.
#[derive(Clone, Copy, Debug)]
pub struct HomogeneousTriangle {
    /// The vertices.
    pub vertices: [WindowVertex; 3],
    /// The determinant of the vertices: positive if a triangle in front of the eye is clockwise on the
    /// screen.
    pub determinant: f64,
}

impl HomogeneousTriangle {
    /// Returns the triangle of three vertices.
    pub fn new(vertices: [WindowVertex; 3]) -> Self {
        let [[ax, ay, aw], [bx, by, bw], [cx, cy, cw]] = vertices;
        let determinant =
            ax * (by * cw - bw * cy) + ay * (bw * cx - bx * cw) + aw * (bx * cy - by * cx);
        Self {
            vertices,
            determinant,
        }
    }

    /// Returns the line of the edge from a vertex to the next one.
    pub fn edge(&self, i: usize) -> DepthPlane {
        line_through(self.vertices[i], self.vertices[(i + 1) % 3])
    }

    /// Returns the plane of a value over w, from the values of the vertices; flat if the triangle has no area.
    pub fn over_w(&self, values: [f64; 3]) -> DepthPlane {
        let mut sum = [0.0; 3];
        for (i, value) in values.into_iter().enumerate() {
            // The edge opposite the vertex.
            let edge = self.edge((i + 1) % 3).parts();
            for (sum, part) in sum.iter_mut().zip(edge) {
                *sum += part * value;
            }
        }
        let scaled = sum.map(|part| {
            if self.determinant == 0.0 {
                0.0
            } else {
                part / self.determinant
            }
        });
        let [value, dx, dy] = scaled;
        DepthPlane::of(value, dx, dy)
    }

    /// Returns the corners of the part on which all of some linear functions are non-negative, as shares of
    /// the three vertices. Each function is given by its values at the vertices.
    pub fn clipped(functions: impl IntoIterator<Item = [f64; 3]>) -> Vec<[f64; 3]> {
        let mut corners = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for function in functions {
            let value = |share: &[f64; 3]| dot(*share, function);
            let mut kept = Vec::with_capacity(corners.len() + 1);
            for (i, corner) in corners.iter().enumerate() {
                let next = &corners[(i + 1) % corners.len()];
                let (here, there) = (value(corner), value(next));
                if here >= 0.0 {
                    kept.push(*corner);
                }
                if (here < 0.0) != (there < 0.0) {
                    let t = here / (here - there);
                    kept.push([0, 1, 2].map(|k| corner[k] + (next[k] - corner[k]) * t));
                }
            }
            corners = kept;
        }
        corners
    }
}

/// Returns the part of a segment on which all of some linear functions are non-negative, as shares of its
/// second end; `None` if there is no such part. Each function is given by its values at the ends.
pub fn clipped_segment(functions: impl IntoIterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for [a, b] in functions {
        match (a < 0.0, b < 0.0) {
            (true, true) => return None,
            (true, false) => from = from.max(a / (a - b)),
            (false, true) => to = to.min(a / (a - b)),
            (false, false) => {}
        }
    }
    (from <= to).then_some([from, to])
}

/// Returns the sum of three values weighted by their shares.
pub fn dot(shares: [f64; 3], values: [f64; 3]) -> f64 {
    shares[0] * values[0] + shares[1] * values[1] + shares[2] * values[2]
}

/// An edge of a triangle that reaches behind the eye. Points on it belong to the triangle on one of its
/// sides.
#[derive(Clone, Copy, Debug)]
pub struct CutEdge {
    line: DepthPlane,
    holds_edge: bool,
}

impl CutEdge {
    /// Returns an edge of a triangle whose inside is where the line is positive, or otherwise negative.
    pub fn new(line: DepthPlane, positive_inside: bool) -> Self {
        let sign = if positive_inside { 1.0 } else { -1.0 };
        let [value, dx, dy] = line.parts().map(|part| part * sign);
        Self {
            line: DepthPlane::of(value, dx, dy),
            holds_edge: dy > 0.0 || (dy == 0.0 && dx > 0.0),
        }
    }

    /// Returns true if a point is on the inner side.
    pub fn holds(&self, at: Point) -> bool {
        let value = self.line.at(at);
        value > 0.0 || (value == 0.0 && self.holds_edge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::{edge_value, signed_area};

    fn at(x: i64, y: i64) -> Point {
        Point { x, y }
    }

    /// Returns a triangle with vertices at window positions, each times its w.
    fn vertices(places: [(f64, f64, f64); 3]) -> HomogeneousTriangle {
        HomogeneousTriangle::new(places.map(|(x, y, w)| [x * w, y * w, w]))
    }

    #[test]
    fn only_points_in_front_of_the_eye_have_a_place_on_the_grid() {
        assert!(!is_cut([3.0, -5.0, 1.0]) && !is_cut([FARTHEST, 0.0, 1.0]));
        assert!(is_cut([0.0, 0.0, 0.0]) && is_cut([3.0, 5.0, -1.0]));
        assert!(is_cut([FARTHEST, 0.0, 0.5]) && is_cut([0.0, -FARTHEST, 0.5]));
    }

    #[test]
    fn a_triangle_in_front_of_the_eye_has_its_plain_edges_and_planes() {
        let points = [at(3, 5), at(90, 7), at(20, 70)];
        let places = points.map(|p| (p.x as f64, p.y as f64, 1.0));
        let triangle = vertices(places);
        assert_eq!(triangle.determinant, -signed_area(points) as f64);
        let sample = at(30, 20);
        for i in 0..3 {
            let edge = edge_value(points[i], points[(i + 1) % 3], sample);
            assert_eq!(triangle.edge(i).at(sample), edge as f64);
        }
        let plane = triangle.over_w([1.0, 2.0, 3.0]);
        for (point, value) in points.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((plane.at(point) - value).abs() < 1e-12);
        }
    }

    #[test]
    fn the_quotient_of_two_planes_is_the_interpolated_value() {
        let triangle = vertices([(0.0, 0.0, 1.0), (64.0, 0.0, 4.0), (0.0, 64.0, 2.0)]);
        let (value, reciprocal_w) = (triangle.over_w([8.0, 2.0, 4.0]), triangle.over_w([1.0; 3]));
        // Halfway in the window is a fifth of the way in space.
        let middle = at(32, 0);
        let quotient = value.at(middle) / reciprocal_w.at(middle);
        assert!((quotient - (8.0 * 0.8 + 2.0 * 0.2)).abs() < 1e-12);
        assert!((reciprocal_w.at(at(64, 0)) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn a_triangle_with_a_vertex_behind_the_eye_is_open_on_one_side() {
        // The third vertex is behind the eye and projects to below the first two; the part in front of the
        // eye is above them.
        let triangle = vertices([(0.0, 0.0, 1.0), (64.0, 0.0, 1.0), (32.0, 64.0, -1.0)]);
        let inside = |x, y| {
            (0..3)
                .all(|i| CutEdge::new(triangle.edge(i), triangle.determinant > 0.0).holds(at(x, y)))
        };
        assert!(inside(32, -10) && inside(-10, -1000) && inside(70, -1000));
        assert!(!inside(32, 10) && !inside(-40, -10) && !inside(32, 70));
    }

    #[test]
    fn clipping_keeps_the_part_where_the_distance_is_not_negative() {
        assert_eq!(HomogeneousTriangle::clipped([[1.0; 3]]).len(), 3);
        assert!(HomogeneousTriangle::clipped([[-1.0; 3]]).is_empty());
        let half = HomogeneousTriangle::clipped([[1.0, -1.0, 1.0]]);
        assert_eq!(half.len(), 4);
        assert!(half.iter().all(|s| s[0] - s[1] + s[2] >= -1e-12));
        assert_eq!(
            clipped_segment([[-1.0, 3.0], [1.0, 1.0]]),
            Some([0.25, 1.0])
        );
        assert_eq!(clipped_segment([[-1.0, -3.0]]), None);
        assert_eq!(clipped_segment([[1.0, -1.0], [-3.0, 1.0]]), None);
    }
}
