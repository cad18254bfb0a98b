//! Depth over a primitive, which legal snapping leaves partly open.

use crate::interval::{Interval, Lanes};
use crate::snap::{SnapBox, SubTexels, area};
use etalon_pipeline::{DepthPlane, Point};
use smallvec::SmallVec;

/// A depth over a primitive.
#[derive(Clone, Debug)]
pub(crate) struct Depth {
    /// The planes through the legally snapped vertices, except planes that are nowhere the lowest or highest
    /// near the primitive. Empty if the depth is constant or only the vertices' depths are known.
    planes: Vec<DepthPlane>,
    /// The largest change of any plane over one unit to the right and one down.
    pub(crate) steepest: f64,
    /// The largest distance of a depth from its plane.
    pub(crate) error: f64,
    /// The range of the vertices' depths, with the error of interpolating between them.
    pub(crate) hull: Interval,
}

impl Depth {
    pub(crate) fn flat(z: &[Interval]) -> Self {
        let hull = z.iter().copied().reduce(Interval::hull);
        Self {
            planes: Vec::new(),
            steepest: 0.0,
            error: 0.0,
            hull: hull.unwrap_or(Interval::exact(0.0)),
        }
    }

    /// Returns the depth of a known plane at positions that can be off by `off` along each axis; `hull`
    /// bounds it inside the primitive.
    pub(crate) fn of_plane(plane: DepthPlane, off: [f64; 2], hull: Interval, error: f64) -> Self {
        let (dx, dy) = (plane.dx.abs(), plane.dy.abs());
        Self {
            planes: if hull.low == hull.high {
                Vec::new()
            } else {
                vec![plane]
            },
            steepest: dx + dy,
            error: error + dx * off[0] + dy * off[1],
            hull: hull.widen(error),
        }
    }

    /// Returns true if the depth is the same all over the primitive.
    pub(crate) fn is_flat(&self) -> bool {
        self.planes.is_empty()
    }

    /// Adds the interpolation error: even a weighted sum of equal depths can differ from that depth.
    pub(crate) fn interpolated(mut self, float_error: f64) -> Self {
        let largest = self.hull.low.abs().max(self.hull.high.abs());
        self.error += largest * float_error;
        self.hull = self.hull.widen(largest * float_error);
        self
    }

    /// Returns the depth along a line, including its rectangle and the texels at its ends, which reach beyond
    /// the vertices.
    pub(crate) fn along(
        ends: [SnapBox; 2],
        z: [Interval; 2],
        units: i64,
        float_error: f64,
    ) -> Self {
        let mut depth = Self::flat(&z).interpolated(float_error);
        if z[0] == z[1] {
            return depth;
        }
        let length = |low: Point, high: Point| {
            let (x, y) = ((high.x - low.x) as f64, (high.y - low.y) as f64);
            x.hypot(y)
        };
        let length = length(ends[0].low, ends[1].low).max(1.0);
        let extent = depth.hull.high - depth.hull.low;
        depth.hull = depth.hull.widen(extent * 2.0 * units as f64 / length);
        depth
    }

    /// Returns the depth over a triangle.
    pub(crate) fn over(
        vertices: [SnapBox; 3],
        z: [Interval; 3],
        sub_texels: SubTexels<'_>,
        float_error: f64,
    ) -> Self {
        let mut depth = Self::flat(&z).interpolated(float_error);
        if z[0] == z[1] && z[1] == z[2] {
            return depth;
        }
        let middle = z.map(|z| (z.low + z.high) / 2.0);
        let (least, most) = area(vertices);
        if least <= 0 && most >= 0 {
            return depth;
        }
        let candidates: SmallVec<[DepthPlane; 64]> = planes(vertices, middle).collect();
        let growth = candidates.iter().fold((0.0, 0.0), |(x, y): (f64, f64), p| {
            (x.max(p.dx.abs()), y.max(p.dy.abs()))
        });
        depth.steepest = growth.0 + growth.1;
        depth.planes = extreme(&candidates, near(vertices, sub_texels.units));
        // Positions may be interpolated before or after snapping, so they may differ by one step of the grid.
        let widest = z.iter().map(|z| z.high - z.low).fold(0.0, f64::max);
        depth.error += depth.steepest * sub_texels.step() as f64 + widest;
        depth
    }

    /// Limits the depth to the range of the vertices' depths.
    pub(crate) fn between(mut self, z: &[Interval]) -> Self {
        self.hull = Self::flat(z).hull;
        self
    }

    /// Widens the depth for the edges of a triangle, which reach beyond it like lines.
    pub(crate) fn reach_out(&mut self, units: i64) {
        let far = self.steepest * 2.0 * units as f64;
        self.error += far;
        self.hull = self.hull.widen(far);
    }

    /// Returns the hull over the texel that contains a point, inside the primitive or not.
    pub(crate) fn over_texel(&self, point: Point, units: i64) -> Interval {
        self.hull_of(SnapBox::texel_of(point, units).corners())
    }

    pub(crate) fn at(&self, point: Point) -> Interval {
        self.beyond(point).clamp(self.hull.low, self.hull.high)
    }

    /// Returns the depth at a point, which can be outside.
    pub(crate) fn beyond(&self, point: Point) -> Interval {
        self.hull_of([point])
    }

    /// Returns the hull of the depths at some points, which can be outside.
    #[inline]
    fn hull_of<const N: usize>(&self, points: [Point; N]) -> Interval {
        if self.is_flat() {
            return self.hull;
        }
        let mut depths = Lanes::<N>::new();
        for plane in &self.planes {
            for (i, point) in points.iter().enumerate() {
                depths.add(i, plane.at(*point));
            }
        }
        depths.hull().widen(self.error)
    }
}

/// Returns the corners of a rectangle that contains all points near a triangle at which its planes are
/// evaluated.
fn near(vertices: [SnapBox; 3], units: i64) -> [Point; 4] {
    let [a, b, c] = vertices;
    let mut bounds = a.hull(b).hull(c);
    let reach = 4 * units;
    bounds.low.x -= reach;
    bounds.low.y -= reach;
    bounds.high.x += reach;
    bounds.high.y += reach;
    bounds.corners()
}

/// Returns the planes that are lowest or highest somewhere in a rectangle. A plane that is not above another
/// plane at any corner is not above it anywhere inside.
fn extreme(planes: &[DepthPlane], corners: [Point; 4]) -> Vec<DepthPlane> {
    if planes.len() < 3 {
        return planes.to_vec();
    }
    let values: SmallVec<[[f64; 4]; 64]> =
        planes.iter().map(|p| corners.map(|c| p.at(c))).collect();
    let under = |i: usize, j: usize| values[i].iter().zip(&values[j]).all(|(a, b)| a <= b);
    let (mut highest, mut lowest): (SmallVec<[usize; 64]>, SmallVec<[usize; 64]>) =
        (SmallVec::new(), SmallVec::new());
    for i in 0..planes.len() {
        if !highest.iter().any(|j| under(i, *j)) {
            highest.retain(|j| !under(*j, i));
            highest.push(i);
        }
        if !lowest.iter().any(|j| under(*j, i)) {
            lowest.retain(|j| !under(i, *j));
            lowest.push(i);
        }
    }
    highest.extend(lowest);
    highest.sort_unstable();
    highest.dedup();
    highest.into_iter().map(|i| planes[i]).collect()
}

/// Returns the planes through all corners of the snapped positions: one if they are exact. A plane's slope is
/// a quotient of functions that are linear in each coordinate, so its extremes are at corners.
pub(crate) fn planes(boxes: [SnapBox; 3], z: [f64; 3]) -> impl Iterator<Item = DepthPlane> {
    let corners = SnapBox::positions;
    corners(boxes[0]).flat_map(move |a| {
        corners(boxes[1])
            .flat_map(move |b| corners(boxes[2]).map(move |c| DepthPlane::new([a, b, c], z)))
    })
}
