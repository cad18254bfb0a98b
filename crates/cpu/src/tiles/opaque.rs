//! Small opaque triangles: one colour, under a depth test or none.

use super::TILE;
use super::depth::Depths;
use super::edges::Edges;
use super::plan::DrawPlan;
use super::work::Work;
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
    /// The word that a texel of one word becomes.
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

/// A sample's planes and position.
pub(crate) struct Planes<'p> {
    pub(crate) position: [i32; 2],
    /// The texels whose sample may be written.
    pub(crate) rect: [i32; 4],
    /// Empty if none are written.
    pub(crate) colors: &'p mut [u32],
    /// Empty if none are tested.
    pub(crate) depths: &'p mut [u32],
}

/// The depth codes of a triangle.
trait Source {
    /// Returns the codes of neighbouring texels of a row.
    fn codes<S: Simd>(&mut self, simd: S, chunk: i32, texel: [i32; 2]) -> u32x16<S>;
}

/// One code.
struct Flat(u32);

impl Source for Flat {
    #[inline(always)]
    fn codes<S: Simd>(&mut self, simd: S, _: i32, _: [i32; 2]) -> u32x16<S> {
        u32x16::splat(simd, self.0)
    }
}

/// Codes of any kind.
struct Any<'a>(&'a Depths, [i32; 2]);

impl Source for Any<'_> {
    #[inline(always)]
    fn codes<S: Simd>(&mut self, simd: S, _: i32, [x, y]: [i32; 2]) -> u32x16<S> {
        u32x16::load_array(simd, self.0.codes(x, y, self.1))
    }
}

/// Codes of floats without a bias, whose growth to the right is known for the first lanes.
struct Floats<'a> {
    depths: &'a Depths,
    position: [i32; 2],
    columns: [f64; LANES],
    /// The number of the lanes whose growth is known.
    chunk: i32,
}

impl Source for Floats<'_> {
    #[inline(always)]
    fn codes<S: Simd>(&mut self, simd: S, chunk: i32, [x, y]: [i32; 2]) -> u32x16<S> {
        if chunk != self.chunk {
            self.columns = self.depths.columns(x, self.position);
            self.chunk = chunk;
        }
        let codes = self.depths.floats(&self.columns, y, self.position);
        u32x16::load_array(simd, codes)
    }
}

impl<'a> Opaque<'a> {
    #[inline(always)]
    pub(crate) fn new(work: &'a Work<'_>, texels: [i32; 4], color: Option<u32>) -> Self {
        let triangle = work.triangle;
        let [left, top, right, bottom] = texels;
        let around = triangle.around.map(i32::from);
        let lanes = LANES as i32;
        let (start, last) = (around[0].max(left), around[2].min(right - 1));
        // What is narrow needs lanes once, wherever it stands.
        let near = start.min(left + TILE as i32 - lanes);
        let first = match last - near < lanes {
            true => near,
            false => start / lanes * lanes,
        };
        let plan: &DrawPlan = work.plan;
        Self {
            edges: Edges::new(triangle),
            depth: plan.depth,
            depths: work.depths.as_ref(),
            code: triangle.code,
            color,
            cut: triangle.cut,
            first,
            chunks: (last - first) / lanes + 1,
            rows: [around[1].max(top), around[3].min(bottom - 1)],
            corner: [left, top],
        }
    }

    /// Draws the covered texels of a sample.
    #[inline(always)]
    pub(crate) fn draw<S: Simd>(&self, simd: S, planes: Planes<'_>) {
        let position = planes.position;
        match self.depths {
            _ if self.depth.is_none() => self.scan::<S, Flat, false>(simd, planes, Flat(0)),
            None => self.scan::<S, Flat, true>(simd, planes, Flat(self.code)),
            Some(depths) if depths.are_floats() => {
                let source = Floats {
                    depths,
                    position,
                    columns: depths.columns(self.first, position),
                    chunk: 0,
                };
                self.scan::<S, Floats<'_>, true>(simd, planes, source);
            }
            Some(depths) => self.scan::<S, Any<'_>, true>(simd, planes, Any(depths, position)),
        }
    }

    /// Goes through rows and lanes, with depths or without.
    #[inline(always)]
    fn scan<S: Simd, D: Source, const DEPTH: bool>(
        &self,
        simd: S,
        planes: Planes<'_>,
        mut source: D,
    ) {
        let Planes {
            position,
            rect,
            colors,
            depths,
        } = planes;
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
        let write = self.depth.is_some_and(|d| d.write);
        let [less, equal, greater] = self.passing();
        // Less and equal exclude one another, so that one of the three answers remains.
        let less = mask32x16::splat(simd, less != greater);
        let equal = mask32x16::splat(simd, equal != greater);
        let greater = mask32x16::splat(simd, greater);
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
                let at = place + (chunk * lanes) as usize;
                if DEPTH {
                    let codes = source.codes(simd, chunk, [x, y]);
                    let stored = row_lanes(depths, at);
                    let old = u32x16::load_array_ref(simd, stored);
                    let below = codes.simd_lt(old) & less;
                    let same = codes.simd_eq(old) & equal;
                    covered &= greater ^ below ^ same;
                    if write {
                        covered.select(codes, old).store_array(stored);
                    }
                }
                if let Some(color) = self.color {
                    let stored = row_lanes(colors, at);
                    let old = u32x16::load_array_ref(simd, stored);
                    let new = u32x16::splat(simd, color);
                    covered.select(new, old).store_array(stored);
                }
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

    /// Returns whether a code passes that is less than the stored one, equal and greater.
    #[inline(always)]
    fn passing(&self) -> [bool; 3] {
        match self.depth.map(|d| d.compare) {
            Some(CompareFunction::Never) => [false, false, false],
            Some(CompareFunction::Less) => [true, false, false],
            Some(CompareFunction::Equal) => [false, true, false],
            Some(CompareFunction::LessEqual) => [true, true, false],
            Some(CompareFunction::Greater) => [false, false, true],
            Some(CompareFunction::NotEqual) => [true, false, true],
            Some(CompareFunction::GreaterEqual) => [false, true, true],
            Some(CompareFunction::Always) | None => [true, true, true],
        }
    }
}

/// Returns the lanes at a place of a plane.
#[inline(always)]
fn row_lanes(plane: &mut [u32], at: usize) -> &mut [u32; LANES] {
    let (lanes, _) = plane[at..at + LANES].as_chunks_mut();
    &mut lanes[0]
}
