//! Convex pieces, each the intersection of half planes.

use crate::polygon::Polygon;

/// A directed line: the distance of a point from it is positive inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectedLine {
    /// The unit vector that points inside, in texels.
    normal: [f64; 2],
    /// The distance of the picture's corner from the line.
    offset: f64,
    /// True if the line ends a wire segment where the next one begins.
    end: bool,
}

impl DirectedLine {
    /// Creates the line through a point, with the inside in the normal's direction.
    pub(super) fn new(point: [f64; 2], [x, y]: [f64; 2]) -> Self {
        let length = x.hypot(y);
        let normal = [x / length, y / length];
        Self {
            normal,
            offset: -(point[0] * normal[0] + point[1] * normal[1]),
            end: false,
        }
    }

    /// Returns the line, marked as the end of a wire segment.
    pub(super) fn ending(self) -> Self {
        Self { end: true, ..self }
    }

    /// Returns the line with inside and outside exchanged.
    pub(super) fn reversed(self) -> Self {
        Self {
            normal: self.normal.map(|v| -v),
            offset: -self.offset,
            ..self
        }
    }

    /// Returns the distance of a point from the line, in texels; positive inside.
    pub(super) fn distance(&self, point: [f64; 2]) -> f64 {
        point[0] * self.normal[0] + point[1] * self.normal[1] + self.offset
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

/// The depth of everything: no piece hides another.
pub(super) const DEPTH: f64 = 0.5;

/// The distance outside an edge up to which texels are drawn, in texels.
const MARGIN: f64 = 1.0;

impl Piece {
    /// Returns the piece clipped to its rectangle; `None` if nothing is left.
    pub(super) fn polygon(&self) -> Option<Polygon> {
        let corners = self.clipped(|point| self.lines.iter().map(|l| l.distance(point)).collect());
        self.drawn(corners, |_| 1.0)
    }

    /// Splits the piece into one part per smoothed edge: the points that are nearer to it than to the other
    /// smoothed edges, up to a texel beyond the edge. Texture coordinates hold the distance from the edge.
    /// Ends of wire segments are smoothed only if `overlap` is set.
    pub(super) fn smooth(&self, overlap: bool) -> Vec<Polygon> {
        let (smooth, hard): (Vec<DirectedLine>, Vec<DirectedLine>) =
            self.lines.iter().partition(|l| overlap || !l.end);
        let part = |edge: &DirectedLine| {
            let corners = self.clipped(|point| {
                let edge_distance = edge.distance(point);
                let distances = smooth.iter().map(|l| l.distance(point));
                let inside = distances.clone().map(|d| d + MARGIN);
                let nearer = distances.map(|d| d - edge_distance);
                let kept = hard.iter().map(|l| l.distance(point));
                inside.chain(nearer).chain(kept).collect()
            });
            self.drawn(corners, |point| edge.distance(point))
        };
        smooth.iter().filter_map(part).collect()
    }

    fn drawn(&self, corners: Vec<[f64; 2]>, u: impl Fn([f64; 2]) -> f64) -> Option<Polygon> {
        (corners.len() > 2).then(|| Polygon {
            uv: corners.iter().map(|c| [u(*c), 0.0]).collect(),
            corners: corners.into_iter().map(|[x, y]| [x, y, DEPTH]).collect(),
            color: self.color,
            w: Vec::new(),
        })
    }

    /// Returns the corners of the rectangle's part in which all these linear functions are at least 0
    /// (Sutherland and Hodgman 1974).
    fn clipped(&self, functions: impl Fn([f64; 2]) -> Vec<f64>) -> Vec<[f64; 2]> {
        let [left, top, right, bottom] = self.within;
        let mut corners = vec![[left, top], [left, bottom], [right, bottom], [right, top]];
        for i in 0..functions([left, top]).len() {
            let values: Vec<f64> = corners.iter().map(|c| functions(*c)[i]).collect();
            let mut kept = Vec::new();
            for (j, p) in corners.iter().enumerate() {
                let next = (j + 1) % corners.len();
                let (q, here, there) = (corners[next], values[j], values[next]);
                if here >= 0.0 {
                    kept.push(*p);
                }
                if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                    let t = here / (here - there);
                    kept.push([p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t]);
                }
            }
            corners = kept;
        }
        corners
    }
}
