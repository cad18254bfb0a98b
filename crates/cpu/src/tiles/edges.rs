//! Edge functions, tile by tile and row by row.

use super::lanes::NUMBERS;
use super::triangle::{RasterTriangle, clockwise};
use crate::linear::UNITS;
use fearless_simd::prelude::*;

/// The largest magnitude of a row's first value. An edge function grows by at most 2²³ per texel, which is
/// the largest extent of a triangle. Within a tile, a function farther from 0 than this does not change its
/// sign, and one nearer to 0 does not overflow 32 bits.
const FAR: i64 = 1 << 30;

/// A triangle's three edge functions over the window: a sample is inside if all three are at least 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFunctions {
    /// The first vertex of each edge, in sub-texel units.
    from: [[i32; 2]; 3],
    /// The increments per unit to the right and down.
    across: [i32; 3],
    down: [i32; 3],
    /// 0 if samples on the edge are inside, otherwise -1.
    bias: [i64; 3],
}

/// The part of a tile's samples that a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    None,
    /// The triangle covers some of the samples, or possibly none.
    Part,
    Whole,
}

impl EdgeFunctions {
    /// Returns the edge functions of a triangle of positive area.
    #[inline(always)]
    pub(crate) fn new(triangle: &RasterTriangle) -> Self {
        let from = clockwise(triangle);
        let mut edges = Self {
            from,
            across: [0; 3],
            down: [0; 3],
            bias: [0; 3],
        };
        for i in 0..3 {
            let ([px, py], [qx, qy]) = (from[i], from[(i + 1) % 3]);
            // The top-left rule.
            let inside = (qy < py) | ((qy == py) & (qx > px));
            edges.across[i] = py - qy;
            edges.down[i] = qx - px;
            edges.bias[i] = i64::from(inside) - 1;
        }
        edges
    }

    /// Returns the value of a function at a point.
    #[inline(always)]
    fn at(&self, edge: usize, [x, y]: [i32; 2]) -> i64 {
        let [px, py] = self.from[edge];
        i64::from(self.across[edge]) * i64::from(x - px)
            + i64::from(self.down[edge]) * i64::from(y - py)
            + self.bias[edge]
    }

    /// Returns how much of a rectangle of texels the triangle covers. `samples` gives the least and the
    /// greatest offset of samples across and down.
    #[inline(always)]
    pub(crate) fn touch(&self, texels: &[i32; 4], samples: &[[i32; 2]; 2]) -> Touch {
        let units = UNITS as i32;
        let [left, top, right, bottom] = *texels;
        let x = [
            left * units + samples[0][0],
            (right - 1) * units + samples[0][1],
        ];
        let y = [
            top * units + samples[1][0],
            (bottom - 1) * units + samples[1][1],
        ];
        let mut whole = true;
        for i in 0..3 {
            let (across, down) = (
                usize::from(self.across[i] > 0),
                usize::from(self.down[i] > 0),
            );
            let most = self.at(i, [x[across], y[down]]);
            let least = self.at(i, [x[1 - across], y[1 - down]]);
            if most < 0 {
                return Touch::None;
            }
            whole &= least >= 0;
        }
        if whole { Touch::Whole } else { Touch::Part }
    }

    /// Returns the [rows](Self::rows) of a triangle that is at most as large as a tile. The first texel must
    /// be at most a tile away from it.
    #[inline(always)]
    pub(crate) fn near(&self, x: i32, y: i32, sample: [i32; 2]) -> EdgeSigns {
        let units = UNITS as i32;
        let point = [x * units + sample[0], y * units + sample[1]];
        let mut values = [0; 3];
        for (i, slot) in values.iter_mut().enumerate() {
            let [px, py] = self.from[i];
            // These are products of 15-bit numbers, and the shift rounds down.
            let value = self.across[i] * (point[0] - px) + self.down[i] * (point[1] - py);
            *slot = (value + self.bias[i] as i32) >> UNITS.ilog2();
        }
        EdgeSigns {
            at: values,
            across: self.across,
            down: self.down,
        }
    }

    /// Returns numbers that have the signs of the edge functions at one point of each texel in a tile's rows,
    /// starting from a given texel.
    #[inline(always)]
    pub(crate) fn rows(&self, x: i32, y: i32, sample: [i32; 2]) -> EdgeSigns {
        let units = UNITS as i32;
        let point = [x * units + sample[0], y * units + sample[1]];
        let mut values = [0; 3];
        for (i, slot) in values.iter_mut().enumerate() {
            // From texel to texel, the function grows by a multiple of `UNITS`, so the floor keeps all signs.
            *slot = self.at(i, point).div_euclid(UNITS).clamp(-FAR, FAR) as i32;
        }
        EdgeSigns {
            at: values,
            across: self.across,
            down: self.down,
        }
    }
}

/// Numbers with the signs of the edge functions at the texels of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeSigns {
    /// The values at the row's first texel.
    pub(crate) at: [i32; 3],
    /// The increments to the next texel and to the next row.
    pub(crate) across: [i32; 3],
    pub(crate) down: [i32; 3],
}

impl EdgeSigns {
    /// Returns the rows of a triangle, beginning at a texel of a tile that the triangle touches.
    #[inline(always)]
    pub(crate) fn new(triangle: &RasterTriangle, x: i32, y: i32, sample: [i32; 2]) -> Self {
        let edges = EdgeFunctions::new(triangle);
        if triangle.is_near() {
            edges.near(x, y, sample)
        } else {
            edges.rows(x, y, sample)
        }
    }

    /// Returns the numbers at the first texels of the row.
    #[inline(always)]
    pub(crate) fn lanes<S: Simd, I: SimdInt<S, Element = i32>>(&self, simd: S) -> Numbers<S, I> {
        let numbers = I::from_slice(simd, &NUMBERS[..I::LEN]);
        // Operations in closures would not be inlined.
        let ([a, b, c], [d, e, f]) = (self.at, self.across);
        Numbers {
            simd,
            edges: [numbers * d + a, numbers * e + b, numbers * f + c],
        }
    }
}

/// The numbers of [`EdgeSigns`] at consecutive texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers<S, I> {
    simd: S,
    edges: [I; 3],
}

impl<S: Simd, I: SimdInt<S, Element = i32>> Numbers<S, I> {
    /// Returns the covered lanes.
    #[inline(always)]
    pub(crate) fn covered(&self) -> I::Mask {
        let [a, b, c] = self.edges;
        (a | b | c).simd_ge(I::splat(self.simd, 0))
    }

    /// Adds `times` times an increment.
    #[inline(always)]
    pub(crate) fn grow(&mut self, growth: [i32; 3], times: i32) {
        for (numbers, growth) in self.edges.iter_mut().zip(growth) {
            *numbers += growth * times;
        }
    }
}
