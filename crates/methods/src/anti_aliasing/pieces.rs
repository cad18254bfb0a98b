//! Convex pieces, each the intersection of half planes.

use crate::polygon::Polygon;

/// A linear function of a point.
#[derive(Clone, Copy, Debug)]
struct LinearFunction {
    normal: [f64; 2],
    offset: f64,
}

impl LinearFunction {
    fn at(&self, point: [f64; 2]) -> f64 {
        point[0] * self.normal[0] + point[1] * self.normal[1] + self.offset
    }

    fn plus(&self, constant: f64) -> Self {
        Self {
            offset: self.offset + constant,
            ..*self
        }
    }

    fn minus(&self, other: &Self) -> Self {
        Self {
            normal: [0, 1].map(|i| self.normal[i] - other.normal[i]),
            offset: self.offset - other.offset,
        }
    }
}

/// A directed line: the distance of a point from it is positive inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectedLine {
    /// The distance in texels; the normal is a unit vector that points inside.
    signed_distance: LinearFunction,
    /// True if the line ends a wire segment where the next one begins.
    ends_segment: bool,
}

impl DirectedLine {
    /// Creates the line through a point, with the inside in the normal's direction.
    pub(super) fn new(point: [f64; 2], [x, y]: [f64; 2]) -> Self {
        let length = x.hypot(y);
        let normal = [x / length, y / length];
        let offset = -(point[0] * normal[0] + point[1] * normal[1]);
        Self {
            signed_distance: LinearFunction { normal, offset },
            ends_segment: false,
        }
    }

    /// Returns the line, marked as the end of a wire segment.
    pub(super) fn marked_as_end(self) -> Self {
        Self {
            ends_segment: true,
            ..self
        }
    }

    /// Returns the line with inside and outside exchanged.
    pub(super) fn reversed(self) -> Self {
        let LinearFunction { normal, offset } = self.signed_distance;
        Self {
            signed_distance: LinearFunction {
                normal: normal.map(|v| -v),
                offset: -offset,
            },
            ..self
        }
    }

    /// Returns the distance of a point from the line, in texels; positive inside.
    pub(super) fn distance(&self, point: [f64; 2]) -> f64 {
        self.signed_distance.at(point)
    }
}

/// A convex piece of one colour.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Left, top, right and bottom of the rectangle that clips the piece, on texel borders.
    pub(super) within: [f64; 4],
    /// The lines that bound the piece.
    pub(super) lines: Vec<DirectedLine>,
    /// The piece's colour.
    pub(super) color: [f64; 4],
}

/// The depth of all pieces. They do not overlap, so it decides nothing.
pub(super) const DEPTH: f64 = 0.5;

/// The distance outside an edge up to which texels are drawn, in texels.
const MARGIN: f64 = 1.0;

impl Piece {
    /// Returns the piece clipped to its rectangle; `None` if nothing is left.
    pub(super) fn polygon(&self) -> Option<Polygon> {
        let distances: Vec<_> = self.lines.iter().map(|l| l.signed_distance).collect();
        let polygon = self.to_polygon(self.clipped(&distances), |_| 0.0)?;
        Some(Polygon {
            uv: Vec::new(),
            ..polygon
        })
    }

    /// Returns one polygon per smoothed edge. It contains the points nearest to that edge, up to [`MARGIN`]
    /// outside. Texture coordinates hold the distance from the edge. Ends of wire segments are smoothed only
    /// if `overlap` is set.
    pub(super) fn smooth(&self, overlap: bool) -> Vec<Polygon> {
        let (smooth, hard): (Vec<DirectedLine>, Vec<DirectedLine>) =
            self.lines.iter().partition(|l| overlap || !l.ends_segment);
        let edges: Vec<_> = smooth.iter().map(|l| l.signed_distance).collect();
        let hard_distances = hard.iter().map(|l| l.signed_distance);
        let part = |edge: &DirectedLine| {
            let inside = edges.iter().map(|e| e.plus(MARGIN));
            let nearer = edges.iter().map(|e| e.minus(&edge.signed_distance));
            let functions: Vec<_> = inside.chain(nearer).chain(hard_distances.clone()).collect();
            self.to_polygon(self.clipped(&functions), |point| edge.distance(point))
        };
        smooth.iter().filter_map(part).collect()
    }

    /// Returns the polygon with these corners, unless it has too few. `u` gives the texture coordinate.
    fn to_polygon(&self, corners: Vec<[f64; 2]>, u: impl Fn([f64; 2]) -> f64) -> Option<Polygon> {
        (corners.len() > 2).then(|| Polygon {
            uv: corners.iter().map(|c| [u(*c), 0.0]).collect(),
            corners: corners.into_iter().map(|[x, y]| [x, y, DEPTH]).collect(),
            color: self.color,
            w: Vec::new(),
        })
    }

    /// Returns the corners of the rectangle's part in which all these functions are at least 0
    /// (Sutherland and Hodgman 1974).
    fn clipped(&self, functions: &[LinearFunction]) -> Vec<[f64; 2]> {
        let [left, top, right, bottom] = self.within;
        let mut corners = vec![[left, top], [left, bottom], [right, bottom], [right, top]];
        for function in functions {
            let mut clipped = Vec::new();
            for (i, from) in corners.iter().enumerate() {
                let to = &corners[(i + 1) % corners.len()];
                let (from_value, to_value) = (function.at(*from), function.at(*to));
                if from_value >= 0.0 {
                    clipped.push(*from);
                }
                if from_value * to_value < 0.0 {
                    let t = from_value / (from_value - to_value);
                    clipped.push([0, 1].map(|i| from[i] + (to[i] - from[i]) * t));
                }
            }
            corners = clipped;
        }
        corners
    }
}
