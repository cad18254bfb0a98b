//! Small opaque triangles: one colour, under a depth test or none.

use super::TILE;
use super::depth::Depths;
use super::edges::Edges;
use super::plan::DrawPlan;
use super::tile::Work;
use crate::lanes::LANES;
use crate::linear::UNITS;
use etalon_scene::{CompareFunction, DepthState};
use fearless_simd::prelude::*;
use fearless_simd::{i32x16, mask32x16, u32x16};

/// The lanes' numbers.
const NUMBERS: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// A small triangle in a tile.
pub(crate) struct Opaque<'a> {
    edges: Edges<i32>,
    depth: Option<DepthState>,
    depths: Option<&'a Depths>,
    code: u32,
    color: Option<u32>,
    cut: bool,
    /// The column of the first lanes, and the number of lanes side by side.
    first: i32,
    chunks: i32,
    /// The first and the last row.
    rows: [i32; 2],
    /// The tile's left and top.
    corner: [i32; 2],
}

impl<'a> Opaque<'a> {
    #[inline(always)]
    pub(crate) fn new(work: &'a Work<'_>, texels: [i32; 4], color: Option<u32>) -> Self {
        let triangle = work.triangle;
        let [left, top, right, bottom] = texels;
        let around = triangle.around.map(i32::from);
        let lanes = LANES as i32;
        let first = around[0].max(left) / lanes * lanes;
        let plan: &DrawPlan = work.plan;
        Self {
            edges: Edges::new(triangle),
            depth: plan.depth,
            depths: work.depths.as_ref(),
            code: triangle.code,
            color,
            cut: triangle.cut,
            first,
            chunks: (around[2].min(right - 1) - first) / lanes + 1,
            rows: [around[1].max(top), around[3].min(bottom - 1)],
            corner: [left, top],
        }
    }

    /// Draws the covered texels of a sample to its planes; those that are not written may be empty.
    #[inline(always)]
    pub(crate) fn draw<S: Simd>(
        &self,
        simd: S,
        position: [i32; 2],
        rect: &[i32; 4],
        colors: &mut [u32],
        depths: &mut [u32],
    ) {
        let Some(state) = self.depth else {
            return self.scan(simd, position, rect, |at, _, covered| {
                self.store(simd, colors, at, covered);
            });
        };
        macro_rules! under {
            ($($name:ident $test:ident)*) => {
                match state.compare {
                    CompareFunction::Never => {}
                    CompareFunction::Always => self.scan(simd, position, rect, |at, texel, covered| {
                        if state.write {
                            let codes = self.codes(simd, texel, position);
                            let stored = lanes(depths, at);
                            let old = u32x16::load_array_ref(simd, stored);
                            covered.select(codes, old).store_array(stored);
                        }
                        self.store(simd, colors, at, covered);
                    }),
                    $(CompareFunction::$name => self.scan(simd, position, rect, |at, texel, covered| {
                        let codes = self.codes(simd, texel, position);
                        let stored = lanes(depths, at);
                        let old = u32x16::load_array_ref(simd, stored);
                        let passed = covered & codes.$test(old);
                        if state.write {
                            passed.select(codes, old).store_array(stored);
                        }
                        self.store(simd, colors, at, passed);
                    }),)*
                }
            };
        }
        under!(Less simd_lt Equal simd_eq LessEqual simd_le Greater simd_gt NotEqual simd_ne GreaterEqual simd_ge);
    }

    /// Returns the depth codes of neighbouring texels.
    #[inline(always)]
    fn codes<S: Simd>(&self, simd: S, [x, y]: [i32; 2], position: [i32; 2]) -> u32x16<S> {
        match self.depths {
            None => u32x16::splat(simd, self.code),
            Some(depths) => u32x16::load_array(simd, depths.codes(x, y, position)),
        }
    }

    /// Replaces the colours of a mask.
    #[inline(always)]
    fn store<S: Simd>(&self, simd: S, colors: &mut [u32], at: usize, mask: mask32x16<S>) {
        if let Some(color) = self.color {
            let stored = lanes(colors, at);
            let old = u32x16::load_array_ref(simd, stored);
            let new = u32x16::splat(simd, color);
            mask.select(new, old).store_array(stored);
        }
    }

    /// Goes through the lanes that cover a sample, with their place in the plane and their first texel.
    #[inline(always)]
    fn scan<S: Simd>(
        &self,
        simd: S,
        position: [i32; 2],
        rect: &[i32; 4],
        mut run: impl FnMut(usize, [i32; 2], mask32x16<S>),
    ) {
        let units = UNITS as i32;
        let numbers = i32x16::load_array(simd, NUMBERS);
        let [across, down] = self.edges.growth();
        let [first, last] = self.rows;
        let at = self.edges.at([
            self.first * units + position[0],
            first * units + position[1],
        ]);
        // Operations in closures would not be inlined.
        let mut values = [
            numbers * (across[0] * units) + at[0],
            numbers * (across[1] * units) + at[1],
            numbers * (across[2] * units) + at[2],
        ];
        let (lanes, zero) = (LANES as i32, i32x16::splat(simd, 0));
        let mut y = first;
        while y <= last {
            let place = ((y - self.corner[1]) * TILE as i32 + self.first - self.corner[0]) as usize;
            let mut chunk = 0;
            let mut here = values;
            while chunk < self.chunks {
                let mut covered = (here[0] | here[1] | here[2]).simd_ge(zero);
                let x = self.first + chunk * lanes;
                if self.cut {
                    let columns = numbers + x;
                    let inside = columns.simd_ge(rect[0]) & columns.simd_lt(rect[2]);
                    let row = y >= rect[1] && y < rect[3];
                    covered = covered & inside & mask32x16::splat(simd, row);
                }
                run(place + (chunk * lanes) as usize, [x, y], covered);
                chunk += 1;
                for (value, across) in here.iter_mut().zip(across) {
                    *value += across * (lanes * units);
                }
            }
            for (value, down) in values.iter_mut().zip(down) {
                *value += down * units;
            }
            y += 1;
        }
    }
}

/// Returns the lanes at a place of a plane.
#[inline(always)]
fn lanes(plane: &mut [u32], at: usize) -> &mut [u32; LANES] {
    let (lanes, _) = plane[at..at + LANES].as_chunks_mut();
    &mut lanes[0]
}
