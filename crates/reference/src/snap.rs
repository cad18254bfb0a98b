//! Snapped positions as boxes of integers, since legal snapping leaves a position open by a step of the grid.

use crate::rules::Permission;
use etalon_frame::Limits;
use etalon_pipeline::{Point, signed_area};

/// The positions that legal snapping allows for one vertex: x and y each from low to high, in units of
/// [`units_per_texel`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct SnapBox {
    pub(crate) low: Point,
    pub(crate) high: Point,
}

/// A box in half the memory. Its numbers fit into 32 bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PackedBox([[i32; 2]; 2]);

impl PackedBox {
    /// Returns a box; `None` if its numbers do not fit.
    pub(crate) fn new(unpacked: SnapBox) -> Option<Self> {
        let axis = |v: i64| i32::try_from(v).ok();
        let point = |p: Point| Some([axis(p.x)?, axis(p.y)?]);
        Some(Self([point(unpacked.low)?, point(unpacked.high)?]))
    }

    #[inline]
    pub(crate) fn low(self) -> Point {
        let [[x, y], _] = self.0.map(|p| p.map(i64::from));
        Point { x, y }
    }

    #[inline]
    pub(crate) fn unpacked(self) -> SnapBox {
        let [_, [x, y]] = self.0.map(|p| p.map(i64::from));
        SnapBox {
            low: self.low(),
            high: Point { x, y },
        }
    }
}

impl SnapBox {
    /// Returns the box in which a sample lies: its point, or its texel if `spread` gives the units per texel.
    pub(crate) fn of_sample(point: Point, spread: Option<i64>) -> Self {
        let exact = Self {
            low: point,
            high: point,
        };
        spread.map_or(exact, |units| Self::texel_of(point, units))
    }

    /// Returns the texel that contains a point.
    pub(crate) fn texel_of(point: Point, units: i64) -> Self {
        let [x, y] = [point.x, point.y].map(|v| texel_of(v, units) * units);
        Self {
            low: Point { x, y },
            high: Point {
                x: x + units,
                y: y + units,
            },
        }
    }

    pub(crate) fn corners(self) -> [Point; 4] {
        let point = |x, y| Point { x, y };
        [
            self.low,
            point(self.high.x, self.low.y),
            point(self.low.x, self.high.y),
            self.high,
        ]
    }

    /// Returns the corners, or the position if there is only one.
    pub(crate) fn positions(self) -> impl Iterator<Item = Point> + Clone {
        let corners = self.corners().into_iter();
        corners.take(if self.is_exact() { 1 } else { 4 })
    }

    pub(crate) fn is_exact(self) -> bool {
        self.low == self.high
    }

    #[inline]
    pub(crate) fn contains(self, point: Point) -> bool {
        let (low, high) = (self.low, self.high);
        low.x <= point.x && point.x <= high.x && low.y <= point.y && point.y <= high.y
    }

    /// Returns true if all of another box is inside.
    #[inline]
    pub(crate) fn holds(self, other: Self) -> bool {
        self.contains(other.low) && self.contains(other.high)
    }

    /// Returns true if the boxes have a point in common.
    #[inline]
    pub(crate) fn meets(self, other: Self) -> bool {
        let (low, high) = (self.low, self.high);
        low.x <= other.high.x
            && other.low.x <= high.x
            && low.y <= other.high.y
            && other.low.y <= high.y
    }

    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            low: Point {
                x: self.low.x.min(other.low.x),
                y: self.low.y.min(other.low.y),
            },
            high: Point {
                x: self.high.x.max(other.high.x),
                y: self.high.y.max(other.high.y),
            },
        }
    }
}

/// The sub-texel units, and the adapter's grid, which is asked for only where it matters.
#[derive(Clone, Copy)]
pub(crate) struct SubTexels<'a> {
    /// Units per texel.
    pub(crate) units: i64,
    pub(crate) bits: &'a Permission<u8>,
}

impl SubTexels<'_> {
    /// Returns the step of the adapter's grid in units.
    pub(crate) fn step(self) -> i64 {
        self.units >> self.bits.value()
    }
}

/// The bits of the coarsest grid that the specifications permit.
const COARSEST_BITS: u8 = 4;

/// Returns the units per texel: enough for the adapter's grid and for sample positions in 1/256 texel.
pub(crate) fn units_per_texel(limits: &Limits) -> i64 {
    1 << limits.sub_pixel_bits.max(8)
}

/// Returns the step of the coarsest grid in sub-texel units. A position on this grid is on every adapter's grid.
pub(crate) fn coarsest_step(limits: &Limits) -> i64 {
    units_per_texel(limits) >> limits.sub_pixel_bits.min(COARSEST_BITS)
}

/// Returns a grid with the same units and the same coarsest step, for adapters whose own grids are unimportant.
pub(crate) fn basis_bits(bits: u8) -> u8 {
    match bits {
        0..COARSEST_BITS => bits,
        _ => bits.max(8),
    }
}

/// Returns the row or column of the texels that contain a coordinate. The units per texel are a power of two.
#[inline]
pub(crate) fn texel_of(coordinate: i64, units: i64) -> i64 {
    coordinate >> units.trailing_zeros()
}

/// Returns the least and the greatest signed area of a triangle, y up.
pub(crate) fn area(boxes: [SnapBox; 3]) -> (i64, i64) {
    // One corner decides most triangles; see `Triangle::side`.
    let size = |b: SnapBox| (b.high.x - b.low.x).max(b.high.y - b.low.y);
    let moved = boxes.map(size).into_iter().max().unwrap_or(0);
    let [a, b, c] = boxes.map(|b| b.low);
    let span = |p: Point, q: Point| (p.x - q.x).abs() + (p.y - q.y).abs();
    let bound = 2 * moved * (span(a, b) + span(b, c) + span(c, a)) + 8 * moved * moved;
    let area = signed_area([a, b, c]);
    if area.abs() > bound {
        return (area - bound, area + bound);
    }
    let (mut least, mut most) = (i64::MAX, i64::MIN);
    for a in boxes[0].corners() {
        for b in boxes[1].corners() {
            for c in boxes[2].corners() {
                let value = signed_area([a, b, c]);
                least = least.min(value);
                most = most.max(value);
            }
        }
    }
    (least, most)
}
