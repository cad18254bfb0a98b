//! Convex pieces of the picture, cut along lines.

use smallvec::SmallVec;

/// A point of the picture, in texels from the top left corner.
pub(super) type PicturePoint = [f64; 2];

/// Distances in texels below this are due to rounding, not to geometry.
pub(super) const SLACK: f64 = 1e-11;

/// A convex polygon, as its corners in order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ConvexCell {
    corners: SmallVec<[PicturePoint; 8]>,
}

/// The parts of a cell on the two sides of a line.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "cuts are taken apart at once and never stored: a box would cost more than the space"
)]
pub(super) enum Cut {
    /// No corner is on the negative side.
    Positive,
    /// No corner is on the positive side, and not all are on the line.
    Negative,
    /// The positive and the negative part.
    Both(ConvexCell, ConvexCell),
}

impl ConvexCell {
    /// Returns the rectangle between two corners.
    pub(super) fn rectangle(low: PicturePoint, high: PicturePoint) -> Self {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        Self {
            corners: SmallVec::from_slice(&corners),
        }
    }

    /// Returns the corners in order around the cell.
    pub(super) fn corners(&self) -> &[PicturePoint] {
        &self.corners
    }

    /// Returns the least and the largest value of a linear function in the cell.
    pub(super) fn range(&self, function: impl Fn(PicturePoint) -> f64) -> (f64, f64) {
        let values = self.corners.iter().map(|&corner| function(corner));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    }

    /// Cuts the cell where a linear function is 0; values up to `slack` count as 0.
    pub(super) fn cut(&self, function: impl Fn(PicturePoint) -> f64, slack: f64) -> Cut {
        let snap = |value: f64| if value.abs() <= slack { 0.0 } else { value };
        let values: SmallVec<[f64; 8]> = self.corners.iter().map(|&c| snap(function(c))).collect();
        if values.iter().all(|&v| v >= 0.0) {
            return Cut::Positive;
        }
        if values.iter().all(|&v| v <= 0.0) {
            return Cut::Negative;
        }
        let (mut positive, mut negative) = (SmallVec::new(), SmallVec::new());
        for (i, (&corner, &value)) in self.corners.iter().zip(&values).enumerate() {
            let j = (i + 1) % values.len();
            let (next, after) = (self.corners[j], values[j]);
            if value >= 0.0 {
                positive.push(corner);
            }
            if value <= 0.0 {
                negative.push(corner);
            }
            if value * after < 0.0 {
                let t = value / (value - after);
                let crossing = std::array::from_fn(|c| corner[c] + t * (next[c] - corner[c]));
                positive.push(crossing);
                negative.push(crossing);
            }
        }
        Cut::Both(Self { corners: positive }, Self { corners: negative })
    }

    /// Returns the triangles between the first corner and each side that does not include it.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [PicturePoint; 3]> + '_ {
        let sides = self.corners.windows(2).skip(1);
        sides.map(|side| [self.corners[0], side[0], side[1]])
    }

    /// Returns the area in texels and the centroid.
    pub(super) fn area_and_centroid(&self) -> (f64, PicturePoint) {
        let (mut area, mut moment) = (0.0, [0.0; 2]);
        let origin = self.corners[0];
        for triangle in self.triangles() {
            let part = area_of(triangle);
            area += part;
            for c in 0..2 {
                let away = triangle[1][c] - origin[c] + triangle[2][c] - origin[c];
                moment[c] += part * away / 3.0;
            }
        }
        if area > 0.0 {
            let centroid = std::array::from_fn(|c| origin[c] + moment[c] / area);
            (area, centroid)
        } else {
            (0.0, origin)
        }
    }
}

/// Returns the area of a triangle whose corners are in the order of a cell's.
pub(super) fn area_of([a, b, c]: [PicturePoint; 3]) -> f64 {
    (((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> ConvexCell {
        ConvexCell::rectangle([0.0; 2], [1.0; 2])
    }

    #[test]
    fn a_cut_leaves_two_cells_that_make_up_the_whole() {
        let Cut::Both(positive, negative) = unit().cut(|p| p[0] + 2.0 * p[1] - 1.0, SLACK) else {
            panic!("the line crosses the square");
        };
        let ((above, _), (below, centroid)) =
            (positive.area_and_centroid(), negative.area_and_centroid());
        assert!((above - 0.75).abs() < 1e-15 && (below - 0.25).abs() < 1e-15);
        assert!((centroid[0] - 1.0 / 3.0).abs() < 1e-15 && (centroid[1] - 1.0 / 6.0).abs() < 1e-15);
    }

    #[test]
    fn a_line_along_a_side_cuts_nothing_off() {
        assert_eq!(unit().cut(|p| p[0], SLACK), Cut::Positive);
        assert_eq!(unit().cut(|p| -p[0], SLACK), Cut::Negative);
        assert_eq!(unit().cut(|p| p[0] + p[1] - 2.0, SLACK), Cut::Negative);
        assert_eq!(unit().cut(|p| p[0] - 1e-12, SLACK), Cut::Positive);
    }

    #[test]
    fn a_line_through_corners_repeats_none() {
        let Cut::Both(positive, negative) = unit().cut(|p| p[0] - p[1], SLACK) else {
            panic!("the diagonal crosses the square");
        };
        assert_eq!((positive.corners().len(), negative.corners().len()), (3, 3));
    }
}
