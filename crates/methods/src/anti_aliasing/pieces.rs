//! Convex pieces as what lies on one side of several lines.

use crate::polygon::Polygon;

/// A line, by the distance from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Of x and y in texels, of unit length: to the inside.
    normal: [f64; 2],
    /// The distance of the picture's corner.
    offset: f64,
    /// True if it is the end of a line segment where the next one begins.
    end: bool,
}

impl Line {
    /// The line through a point, with the inside in the normal's direction.
    pub(super) fn new(point: [f64; 2], [x, y]: [f64; 2]) -> Self {
        let length = x.hypot(y);
        let normal = [x / length, y / length];
        Self {
            normal,
            offset: -(point[0] * normal[0] + point[1] * normal[1]),
            end: false,
        }
    }

    /// The line as the end of a line segment.
    pub(super) fn ending(self) -> Self {
        Self { end: true, ..self }
    }

    /// The line with the other side as inside.
    pub(super) fn reversed(self) -> Self {
        Self {
            normal: self.normal.map(|v| -v),
            offset: -self.offset,
            ..self
        }
    }

    /// Returns the distance of a point to the inside, in texels.
    pub(super) fn distance(&self, point: [f64; 2]) -> f64 {
        point[0] * self.normal[0] + point[1] * self.normal[1] + self.offset
    }
}

/// A convex piece of one colour.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Left, top, right and bottom of where it may lie, on texel borders.
    pub(super) within: [f64; 4],
    /// It lies inside all of them.
    pub(super) lines: Vec<Line>,
    /// Its colour.
    pub(super) color: [f64; 4],
}

/// The depth of everything: nothing is in front of anything.
pub(super) const DEPTH: f64 = 0.5;

/// The distance outside of an edge up to which texels are drawn.
const MARGIN: f64 = 1.0;

impl Piece {
    /// The piece as it is; `None` where nothing of it lies in its rectangle.
    pub(super) fn polygon(&self) -> Option<Polygon> {
        let corners = self.clipped(|point| self.lines.iter().map(|l| l.distance(point)).collect());
        self.drawn(corners, |_| 1.0)
    }

    /// The piece in parts, one for each edge that is smoothed, of what is nearer to it than to the
    /// others, a texel beyond the edges included. Texture coordinates hold the distance from it.
    /// Unless `overlap` is set, the ends of line segments are none of these edges.
    pub(super) fn smooth(&self, overlap: bool) -> Vec<Polygon> {
        let (smooth, hard): (Vec<Line>, Vec<Line>) =
            self.lines.iter().partition(|l| overlap || !l.end);
        let part = |edge: &Line| {
            let corners = self.clipped(|point| {
                let own = edge.distance(point);
                let all = smooth.iter().map(|l| l.distance(point));
                let inside = all.clone().map(|d| d + MARGIN);
                let nearer = all.map(|d| d - own);
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

    /// The corners of the rectangle's part in which all of these linear functions are at least 0
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
