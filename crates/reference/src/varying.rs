//! Values interpolated over a primitive, which legal snapping leaves partly open.

use crate::depth::Depth;
use crate::interval::{Interval, Lanes};
use crate::snap::SnapBox;
use etalon_pipeline::{DepthPlane, Point};

/// The roundings of a quotient of two interpolated values: each value, and the quotient. The specifications
/// promise no precision beyond that of floating-point (Vulkan, Basic Polygon Rasterization; OpenGL 4.6,
/// 2.3.4.1 and 14.6.1).
const ROUNDINGS: f64 = 4.0;

/// A value over a primitive.
#[derive(Clone, Debug)]
pub(crate) enum Varying {
    /// Linear over the window.
    Linear(Depth),
    /// Linear in space: a quotient of two values that are linear over the window.
    Perspective(Perspective),
}

/// A value that is linear in space.
#[derive(Clone, Debug)]
pub(crate) struct Perspective {
    /// The planes of the value over w and of 1 over w, for each position that legal snapping allows: the value
    /// at the top left corner, and the growth to the right and down.
    choices: Vec<[[f64; 3]; 2]>,
    /// The additional error of a position: horizontally, and vertically.
    off: [f64; 2],
    error: f64,
    /// The range of the vertices' values, with the error of interpolating between them.
    hull: Interval,
}

impl Varying {
    /// Returns true if the value is the same all over the primitive.
    pub(crate) fn is_flat(&self) -> bool {
        match self {
            Self::Linear(depth) => depth.is_flat(),
            Self::Perspective(_) => false,
        }
    }

    /// Returns the range of the vertices' values.
    pub(crate) fn hull(&self) -> Interval {
        match self {
            Self::Linear(depth) => depth.hull,
            Self::Perspective(value) => value.hull,
        }
    }

    /// Returns the value at a point inside.
    pub(crate) fn at(&self, point: Point) -> Interval {
        match self {
            Self::Linear(depth) => depth.at(point),
            Self::Perspective(value) => value.within([point; 2]).clamp_to(value.hull),
        }
    }

    /// Returns the hull over the texel that contains a point, inside the primitive or not.
    pub(crate) fn over_texel(&self, point: Point, units: i64) -> Interval {
        match self {
            Self::Linear(depth) => depth.over_texel(point, units),
            Self::Perspective(value) => {
                let SnapBox { low, high } = SnapBox::texel_of(point, units);
                value.within([low, high])
            }
        }
    }
}

impl Perspective {
    /// Returns the value over a triangle in front of the eye, from its values and w at the vertices. As a
    /// quotient of functions that are linear in each coordinate of a vertex, it has its extremes at the
    /// corners of the snapped positions.
    pub(crate) fn over(
        boxes: [SnapBox; 3],
        w: [f64; 3],
        values: [f64; 3],
        grid: i64,
        float_error: f64,
    ) -> Self {
        let corners = SnapBox::positions;
        let (value, reciprocal_w) = ([0, 1, 2].map(|i| values[i] / w[i]), w.map(|w| 1.0 / w));
        let choices = corners(boxes[0]).flat_map(|a| {
            corners(boxes[1]).flat_map(move |b| {
                corners(boxes[2]).map(move |c| {
                    let points = [a, b, c];
                    [value, reciprocal_w].map(|z| DepthPlane::new(points, z))
                })
            })
        });
        // Positions may be interpolated before or after snapping, so they may differ by one step of the grid.
        Self::of(choices, [grid as f64; 2], values, float_error)
    }

    /// Returns the value with known planes of it over w and of 1 over w, at positions that can be off by
    /// `off`.
    pub(crate) fn of(
        choices: impl IntoIterator<Item = [DepthPlane; 2]>,
        off: [f64; 2],
        values: [f64; 3],
        float_error: f64,
    ) -> Self {
        let hull = values
            .map(Interval::exact)
            .into_iter()
            .reduce(Interval::hull);
        let hull = hull.unwrap_or(Interval::EVERYTHING);
        let error = hull.low.abs().max(hull.high.abs()) * float_error * ROUNDINGS;
        let parts = choices
            .into_iter()
            .map(|both| both.map(|plane| plane.parts()));
        Self {
            choices: Vec::from_iter(parts),
            off,
            error,
            hull: hull.widen(error),
        }
    }

    /// Returns the values over a rectangle: along each axis the quotient is monotone if w is positive.
    fn within(&self, [low, high]: [Point; 2]) -> Interval {
        let [right, down] = self.off;
        let (left, right) = (low.x as f64 - right, high.x as f64 + right);
        let (top, bottom) = (low.y as f64 - down, high.y as f64 + down);
        let (across, along) = ([left, right, left, right], [top, top, bottom, bottom]);
        let (mut quotients, mut divisors) = (Lanes::<4>::new(), Lanes::<4>::new());
        for [value, reciprocal_w] in &self.choices {
            for i in 0..4 {
                let at = |[value, dx, dy]: &[f64; 3]| value + across[i] * dx + along[i] * dy;
                let divisor = at(reciprocal_w);
                quotients.add(i, at(value) / divisor);
                divisors.add(i, divisor);
            }
        }
        if divisors.least() <= 0.0 {
            return Interval::EVERYTHING;
        }
        quotients.hull().widen(self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNITS: i64 = 256;

    fn exact(x: i64, y: i64) -> SnapBox {
        let at = Point {
            x: x * UNITS,
            y: y * UNITS,
        };
        SnapBox { low: at, high: at }
    }

    fn triangle(values: [f64; 3]) -> Perspective {
        let boxes = [exact(0, 0), exact(16, 0), exact(0, 16)];
        Perspective::over(boxes, [1.0, 4.0, 1.0], values, UNITS / 16, 1e-5)
    }

    #[test]
    fn a_perspective_value_is_closer_to_that_of_the_nearer_vertex() {
        let value = Varying::Perspective(triangle([0.0, 10.0, 0.0]));
        // Halfway in the window is a fifth of the way in space.
        let Interval { low, high } = value.at(Point { x: 8 * UNITS, y: 0 });
        assert!(low < 2.0 && high > 2.0 && high - low < 0.1, "{low} {high}");
        let end = value.at(Point {
            x: 16 * UNITS,
            y: 0,
        });
        assert!(end.high < 10.001 && end.low > 9.7);
    }

    #[test]
    fn the_interval_of_a_texel_contains_those_of_its_points() {
        let value = Varying::Perspective(triangle([0.0, 10.0, 0.0]));
        let point = Point {
            x: 8 * UNITS + 77,
            y: 2 * UNITS + 30,
        };
        let (at_point, over_texel) = (value.at(point), value.over_texel(point, UNITS));
        assert!(over_texel.low < at_point.low && at_point.high < over_texel.high);
    }

    #[test]
    fn a_value_beyond_the_horizon_can_be_anything() {
        let value = Varying::Perspective(triangle([0.0, 10.0, 0.0]));
        let far = Point {
            x: 64 * UNITS,
            y: 0,
        };
        assert_eq!(value.over_texel(far, UNITS), Interval::EVERYTHING);
    }
}
