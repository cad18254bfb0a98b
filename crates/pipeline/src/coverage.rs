//! Coverage by exact integer edge functions on snapped vertices.
//!
//! Coordinates are in sub-texel units from the top left corner, x to the right and y down.

/// A snapped position in sub-texel units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Point {
    /// To the right.
    pub x: i64,
    /// Down.
    pub y: i64,
}

/// Returns twice the signed area of the triangle `p`, `q`, `s`: positive if they run clockwise on the screen
/// (y down), zero if `s` is on the line through `p` and `q`.
#[inline(always)]
pub fn edge_value(p: Point, q: Point, s: Point) -> i64 {
    (q.x - p.x) * (s.y - p.y) - (q.y - p.y) * (s.x - p.x)
}

/// Returns twice the signed area of a triangle with y up: positive for counter-clockwise.
#[inline(always)]
pub fn signed_area(vertices: [Point; 3]) -> i64 {
    -edge_value(vertices[0], vertices[1], vertices[2])
}

/// Returns true if a sample on the edge from `p` to `q` belongs to the triangle clockwise of it on the
/// screen, because the edge is a top or a left one (Direct3D 11.3 functional specification, 3.4.2.1).
#[inline(always)]
pub fn is_top_left(p: Point, q: Point) -> bool {
    q.y < p.y || (q.y == p.y && q.x > p.x)
}

/// A triangle of positive area, with its vertices in clockwise order on the screen.
#[derive(Clone, Copy, Debug)]
pub struct SnappedTriangle {
    vertices: [Point; 3],
    bias: [i64; 3],
}

impl SnappedTriangle {
    /// Returns the triangle, or `None` if its area is zero.
    pub fn new(vertices: [Point; 3]) -> Option<Self> {
        Self::owning(vertices, is_top_left)
    }

    /// Returns the triangle, or `None` if its area is zero. Samples on an edge belong to the triangle clockwise of
    /// it if `owns` is true of the edge's ends.
    pub fn owning(vertices: [Point; 3], owns: impl Fn(Point, Point) -> bool) -> Option<Self> {
        let [a, b, c] = vertices;
        let vertices = match signed_area(vertices) {
            0 => return None,
            area if area > 0 => [a, c, b],
            _ => [a, b, c],
        };
        let bias = std::array::from_fn(|i| {
            let (p, q) = (vertices[i], vertices[(i + 1) % 3]);
            if owns(p, q) { 0 } else { -1 }
        });
        Some(Self { vertices, bias })
    }

    /// Returns the vertices, clockwise on the screen.
    pub fn vertices(&self) -> [Point; 3] {
        self.vertices
    }

    /// Returns each edge function at a point and its growth per unit to the right. A point is inside if all
    /// three are at least zero: the functions already include the samples on edges.
    #[inline(always)]
    pub fn edges_at(&self, s: Point) -> [(i64, i64); 3] {
        std::array::from_fn(|i| {
            let (p, q) = (self.vertices[i], self.vertices[(i + 1) % 3]);
            (edge_value(p, q, s) + self.bias[i], p.y - q.y)
        })
    }

    /// Returns true if the sample at a point is covered.
    pub fn covers(&self, s: Point) -> bool {
        self.edges_at(s).iter().all(|(value, _)| *value >= 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: i64, y: i64) -> Point {
        Point { x, y }
    }

    #[test]
    fn counter_clockwise_with_y_up_has_positive_area() {
        // Here y is down: (0,0) top left, (0,4) bottom left, (4,4) bottom right.
        assert!(signed_area([point(0, 0), point(0, 4), point(4, 4)]) > 0);
        assert!(SnappedTriangle::new([point(0, 0), point(2, 2), point(4, 4)]).is_none());
    }

    #[test]
    fn two_triangles_of_a_square_share_each_sample_once() {
        let corners = [point(0, 0), point(8, 0), point(8, 8), point(0, 8)];
        let a = SnappedTriangle::new([corners[0], corners[1], corners[2]]).expect("area");
        let b = SnappedTriangle::new([corners[0], corners[2], corners[3]]).expect("area");
        for y in -1..=9 {
            for x in -1..=9 {
                let count = u8::from(a.covers(point(x, y))) + u8::from(b.covers(point(x, y)));
                let inside = (0..8).contains(&x) && (0..8).contains(&y);
                assert_eq!(count, u8::from(inside), "({x}, {y})");
            }
        }
    }
}
