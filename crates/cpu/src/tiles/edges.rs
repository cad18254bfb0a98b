//! Edge functions, tile by tile and row by row.

use super::lanes::Lane;
use super::triangle::{Triangle, clockwise};
use crate::lanes::LANES;
use crate::linear::UNITS;

/// The greatest extent in sub-texel units of triangles whose edge functions are taken in 32 bits: with the lanes
/// beside it, no product sum exceeds 2³⁰.
pub(crate) const SMALL: i32 = 64 * UNITS as i32;

/// A triangle's three edge functions over the window: a sample is inside if all three are at least 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edges<N> {
    /// The start of each edge, in sub-texel units.
    from: [[i32; 2]; 3],
    /// Growth per unit to the right and down.
    across: [N; 3],
    down: [N; 3],
    /// 0 where samples on the edge are inside, otherwise -1.
    bias: [N; 3],
}

/// The part of a tile's samples that a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    None,
    /// Some, or none.
    Part,
    Whole,
}

/// The integers of edge functions.
pub(crate) trait Number:
    Copy + From<i32> + PartialOrd + std::ops::Add<Output = Self> + std::ops::Mul<Output = Self>
{
    /// Returns all bits if the number is at least 0, none otherwise.
    fn covered(self) -> Lane;

    /// Returns the bits that either number has.
    fn or(self, other: Self) -> Self;
}

impl Number for i32 {
    #[inline(always)]
    fn covered(self) -> Lane {
        !(self >> 31)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
}

impl Number for i64 {
    #[inline(always)]
    fn covered(self) -> Lane {
        !((self >> 63) as i32)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
}

impl<N: Number> Edges<N> {
    /// Returns the edge functions of a triangle of positive area.
    #[inline(always)]
    pub(crate) fn new(triangle: &Triangle) -> Self {
        let from = clockwise(&triangle.corners);
        let zero = N::from(0);
        let mut edges = Self {
            from,
            across: [zero; 3],
            down: [zero; 3],
            bias: [zero; 3],
        };
        for i in 0..3 {
            let ([px, py], [qx, qy]) = (from[i], from[(i + 1) % 3]);
            // The top-left rule.
            let inside = qy < py || (qy == py && qx > px);
            edges.across[i] = N::from(py - qy);
            edges.down[i] = N::from(qx - px);
            edges.bias[i] = N::from(if inside { 0 } else { -1 });
        }
        edges
    }

    /// Returns the growth of the three functions per unit to the right and down.
    #[inline(always)]
    pub(crate) fn growth(&self) -> [[N; 3]; 2] {
        [self.across, self.down]
    }

    /// Returns the three values at a point.
    #[inline(always)]
    pub(crate) fn at(&self, [x, y]: [i32; 2]) -> [N; 3] {
        std::array::from_fn(|i| {
            let [px, py] = self.from[i];
            self.across[i] * N::from(x - px) + self.down[i] * N::from(y - py) + self.bias[i]
        })
    }

    /// Returns the part of the samples of a rectangle of texels that the triangle covers, from the least and the
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
        let zero = N::from(0);
        let mut whole = true;
        for i in 0..3 {
            let (across, down) = (
                usize::from(self.across[i] > zero),
                usize::from(self.down[i] > zero),
            );
            let most = self.at([x[across], y[down]])[i];
            let least = self.at([x[1 - across], y[1 - down]])[i];
            if most < zero {
                return Touch::None;
            }
            whole &= least >= zero;
        }
        match whole {
            true => Touch::Whole,
            false => Touch::Part,
        }
    }

    /// Returns the edge functions at one point of the texels of rows, beginning from a texel.
    #[inline(always)]
    pub(crate) fn rows(&self, x: i32, y: i32, sample: [i32; 2]) -> Rows<N> {
        let units = UNITS as i32;
        let at = self.at([x * units + sample[0], y * units + sample[1]]);
        let unit = N::from(units);
        let mut steps = [[N::from(0); LANES]; 3];
        for (steps, across) in steps.iter_mut().zip(self.across) {
            for (lane, step) in steps.iter_mut().enumerate() {
                *step = across * N::from(lane as i32 * units);
            }
        }
        Rows {
            at,
            steps,
            chunk: self.across.map(|v| v * N::from(LANES as i32 * units)),
            down: self.down.map(|v| v * unit),
        }
    }
}

/// Edge functions at the texels of a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows<N> {
    /// The values in the row's first texel.
    at: [N; 3],
    /// Their growth to each lane.
    steps: [[N; LANES]; 3],
    /// Their growth to the next lanes and to the next row.
    chunk: [N; 3],
    down: [N; 3],
}

impl<N: Number> Rows<N> {
    /// Goes to the next row.
    #[inline(always)]
    pub(crate) fn next(&mut self) {
        for (at, down) in self.at.iter_mut().zip(self.down) {
            *at = *at + down;
        }
    }

    /// Returns the covered texels of the lanes that stand this many times their number behind the first.
    #[inline(always)]
    pub(crate) fn covered(&self, chunk: i32) -> [Lane; LANES] {
        let mut result = [0; LANES];
        let [a, b, c] = std::array::from_fn(|i| self.at[i] + self.chunk[i] * N::from(chunk));
        let [first, second, third] = &self.steps;
        for lane in 0..LANES {
            let bits = (a + first[lane]).or(b + second[lane]).or(c + third[lane]);
            result[lane] = bits.covered();
        }
        result
    }
}
