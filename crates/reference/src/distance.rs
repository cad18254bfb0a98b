//! Clip distances over a primitive, which is clipped wherever a distance is negative.
//!
//! Vertices made by clipping are computed and snapped like all others. An edge made by clipping is therefore
//! within some steps of the grid of the zero of the distance, and a sample nearer than that can be on either
//! side. Two texels at each end of a line are open, whatever ends it (Vulkan, Bresenham Line Segment
//! Rasterization; OpenGL 4.6, 14.5.1).

use crate::depth::Depth;
use crate::interval::Interval;
use crate::possible::Possible;
use crate::snap::{SnapBox, SubTexels};
use etalon_pipeline::{DepthPlane, Point};

/// The number of grid steps that an edge made by clipping can be off by.
const EDGE_STEPS: f64 = 2.0;

/// A clip distance over a primitive.
#[derive(Clone, Debug)]
pub(crate) enum ClipDistance {
    /// The least and the greatest value anywhere on the primitive.
    Between(Interval),
    /// Linear over a triangle.
    Over {
        plane: Depth,
        /// The largest change of the distance through the error in the edge's position.
        error: f64,
    },
    /// Linear along a line.
    Along { plane: DepthPlane, error: f64 },
}

impl ClipDistance {
    /// Returns a distance that is constant, or that varies between the vertices in an unknown way.
    pub(crate) fn between(values: &[f64]) -> Self {
        let intervals = values.iter().map(|v| Interval::exact(*v));
        let hull = intervals.reduce(Interval::hull);
        Self::Between(hull.unwrap_or(Interval::exact(0.0)))
    }

    /// A distance of unknown sign.
    pub(crate) const UNKNOWN: Self = Self::Between(Interval {
        low: -1.0,
        high: 1.0,
    });

    /// Returns a distance with a known plane of the distance over w.
    pub(crate) fn of_plane(plane: Depth) -> Self {
        // One of the steps is already in the plane's error.
        let error = plane.error * (EDGE_STEPS - 1.0);
        Self::Over { plane, error }
    }

    /// Returns the distance over a triangle in front of the eye, from its values at the vertices divided by
    /// their w. That quotient has the distance's sign and is linear in the window (OpenGL 4.6, 13.7 and
    /// 14.6.1; WebGPU, 23.2.4).
    pub(crate) fn over(
        vertices: [SnapBox; 3],
        values: [f64; 3],
        sub_texels: SubTexels<'_>,
        float_error: f64,
    ) -> Self {
        // If all values have the same sign, nothing or everything is clipped.
        if values.iter().all(|v| *v >= 0.0) || values.iter().all(|v| *v < 0.0) {
            return Self::between(&values);
        }
        let exact = values.map(Interval::exact);
        let plane = Depth::over(vertices, exact, sub_texels, float_error);
        let error = plane.steepest * sub_texels.step() as f64 * EDGE_STEPS;
        Self::Over { plane, error }
    }

    pub(crate) fn along(ends: [SnapBox; 2], values: [f64; 2], units: i64) -> Self {
        if values.iter().all(|v| *v >= 0.0) || values.iter().all(|v| *v < 0.0) {
            return Self::between(&values);
        }
        let plane = DepthPlane::along(ends.map(|e| e.low), values);
        let error = (plane.dx.abs() + plane.dy.abs()) * units as f64 * 2.0;
        Self::Along { plane, error }
    }

    /// Like [`ClipDistance::keeps`], for any point in the texel that contains this one.
    pub(crate) fn keeps_in_texel(&self, at: Point, units: i64) -> Possible {
        let corners = SnapBox::texel_of(at, units)
            .corners()
            .map(|c| self.keeps(c));
        let can = corners.iter().any(|c| c.can());
        Possible::of(can, corners.iter().all(|c| c.must()))
    }

    /// Returns whether a covered point remains. A distance of 0 is inside (Vulkan, Primitive Clipping; OpenGL
    /// 4.6, 13.7; WebGPU, 23.2.4).
    pub(crate) fn keeps(&self, at: Point) -> Possible {
        let Interval { low, high } = match self {
            Self::Between(hull) => *hull,
            Self::Over { plane, error } => plane.beyond(at).widen(*error),
            Self::Along { plane, error } => Interval::exact(plane.at(at)).widen(*error),
        };
        Possible::of(high >= 0.0, low >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::Rules;
    use crate::test_limits::limits;
    use etalon_frame::{Api, Limits};

    const UNITS: i64 = 256;

    fn exact(x: i64, y: i64) -> SnapBox {
        let at = Point {
            x: x * UNITS,
            y: y * UNITS,
        };
        SnapBox { low: at, high: at }
    }

    /// Returns rules for an adapter with a grid of 1/16 texel.
    fn rules() -> Rules {
        Rules::of(&Limits {
            sub_pixel_bits: 4,
            ..limits(Api::Vulkan)
        })
    }

    fn sixteenths(rules: &Rules) -> SubTexels<'_> {
        SubTexels {
            units: UNITS,
            bits: &rules.sub_pixel_bits,
        }
    }

    /// Returns the centre of a texel in row 3.
    fn at(x: i64) -> Point {
        Point {
            x: x * UNITS + UNITS / 2,
            y: 3 * UNITS + UNITS / 2,
        }
    }

    #[test]
    fn a_clip_plane_is_undecided_only_near_its_edge() {
        let corners = [exact(0, 0), exact(16, 0), exact(0, 16)];
        let rules = rules();
        let over = |values| ClipDistance::over(corners, values, sixteenths(&rules), 1e-5);
        // Zero between columns 5 and 6, half a texel from both centres.
        let between = over([-6.0, 10.0, -6.0]);
        assert_eq!(between.keeps(at(5)), Possible::Never);
        assert_eq!(between.keeps(at(6)), Possible::Always);
        // Zero at the centres of column 6.
        let through = over([-6.5, 9.5, -6.5]);
        assert_eq!(through.keeps(at(6)), Possible::Maybe);
        assert_eq!(
            (through.keeps(at(5)), through.keeps(at(7))),
            (Possible::Never, Possible::Always)
        );
        assert_eq!(between.keeps_in_texel(at(6), UNITS), Possible::Maybe);
        assert_eq!(between.keeps_in_texel(at(7), UNITS), Possible::Always);
    }

    #[test]
    fn a_clip_distance_of_zero_is_inside_and_a_negative_one_outside() {
        let corners = [exact(0, 0), exact(16, 0), exact(0, 16)];
        let rules = rules();
        let over = |values| ClipDistance::over(corners, values, sixteenths(&rules), 1e-5);
        assert_eq!(over([0.0; 3]).keeps(at(4)), Possible::Always);
        assert_eq!(over([0.0, 1.0, -0.0]).keeps(at(0)), Possible::Always);
        assert_eq!(over([-1.0, -0.5, -2.0]).keeps(at(4)), Possible::Never);
    }

    #[test]
    fn a_line_is_open_within_two_texels_of_its_cut() {
        let ends = [exact(0, 3), exact(16, 3)];
        let line = ClipDistance::along(ends, [-8.0, 8.0], UNITS);
        assert_eq!(line.keeps(at(4)), Possible::Never);
        assert_eq!(line.keeps(at(8)), Possible::Maybe);
        assert_eq!(line.keeps(at(11)), Possible::Always);
    }
}
