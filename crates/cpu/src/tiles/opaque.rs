//! Opaque triangles: one colour, with or without a depth test.

use super::TILE;
use super::depth::Depths;
use super::depth_stencil::{answers, passing};
use super::edges::{EdgeFunctions, EdgeSigns};
use super::lanes::NUMBERS;
use super::paint::{Kernel, TexelPaint};
use super::plan::{DrawKernels, Shading};
use super::triangle::RasterTriangle;
use crate::lanes::LANES;
use fearless_simd::prelude::*;
use fearless_simd::{i32x8, i32x16, u32x8, u32x16};

/// The number of lanes for narrow triangles.
pub(crate) const NARROW: i32 = 8;

/// The change of texels by a draw's opaque triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Store {
    /// The indices of the draw and the paint.
    of: [u32; 2],
    /// The facing, if the stencil state of the other facing might do something.
    front: Option<bool>,
    /// The word that replaces texels, which are one word each; `None` if colours are not written.
    color: Option<u32>,
    /// Whether the depth test passes for a code that is less than, equal to and greater than the stored one;
    /// `None` if depths are not tested.
    passes: Option<[bool; 3]>,
    /// True if the codes that pass are written.
    write: bool,
}

impl Store {
    /// Returns how a triangle changes texels, if it is opaque and its stencil state changes nothing.
    #[inline(always)]
    pub(crate) fn new(
        triangle: &RasterTriangle,
        plan: &DrawKernels,
        paint: &TexelPaint,
    ) -> Option<Self> {
        let color = match &paint.kernel {
            Kernel::Keep => None,
            Kernel::Store(word) => Some(*word),
            _ => return None,
        };
        let shaded = matches!(
            plan.shading,
            Shading::Expensive(_) | Shading::Texture { .. } | Shading::Texels(..)
        );
        (!shaded && paint.others.is_empty()).then_some(Self {
            of: [triangle.draw, triangle.paint],
            front: plan.stencil.map(|_| triangle.front),
            color,
            passes: plan.depth.map(|d| passing(d.compare)),
            write: plan.depth.is_some_and(|d| d.write),
        })
    }

    /// Returns true if a triangle of the same part does the same.
    #[inline(always)]
    pub(crate) fn is_of(&self, triangle: &RasterTriangle) -> bool {
        self.of == [triangle.draw, triangle.paint]
            && self.front.is_none_or(|front| front == triangle.front)
    }

    /// Returns true if colours are written.
    #[inline(always)]
    pub(crate) fn colors(&self) -> bool {
        self.color.is_some()
    }

    /// Returns true if depths are tested.
    #[inline(always)]
    pub(crate) fn tests(&self) -> bool {
        self.passes.is_some()
    }

    /// Draws one sample of small triangles. It is large, so it is not inlined.
    #[inline(never)]
    pub(crate) fn small<'t, S: Simd>(
        &self,
        simd: S,
        triangles: impl Iterator<Item = &'t RasterTriangle>,
        planes: SamplePlanes<'_>,
        texels: [i32; 4],
    ) {
        simd.vectorize(
            #[inline(always)]
            || match (self.tests(), self.colors()) {
                (true, true) => self.rows::<S, true, true>(simd, triangles, planes, texels),
                (true, false) => self.rows::<S, true, false>(simd, triangles, planes, texels),
                (false, true) => self.rows::<S, false, true>(simd, triangles, planes, texels),
                (false, false) => {}
            },
        );
    }

    /// Draws one sample of small triangles row by row, with depths, colours or both.
    #[inline(always)]
    fn rows<'t, S: Simd, const DEPTH: bool, const COLOR: bool>(
        &self,
        simd: S,
        triangles: impl Iterator<Item = &'t RasterTriangle>,
        planes: SamplePlanes<'_>,
        [left, top, ..]: [i32; 4],
    ) {
        let answers = self.answers::<S, u32x8<S>>(simd);
        let color = u32x8::splat(simd, self.color.unwrap_or(0));
        for triangle in triangles {
            let [start, first, _, last] = triangle.around.map(i32::from);
            let column = start.min(left + TILE as i32 - NARROW);
            let rows = EdgeFunctions::new(triangle).near(column, first, planes.position);
            let mut numbers = rows.lanes::<S, i32x8<S>>(simd);
            let code = u32x8::splat(simd, triangle.code);
            let mut place = ((first - top) * TILE as i32 + column - left) as usize;
            for _ in first..=last {
                let mut covered = numbers.covered();
                if DEPTH {
                    let stored = &mut planes.depths[place..place + 8];
                    covered = self.passed(simd, answers, covered, code, stored);
                }
                if COLOR {
                    replace(simd, covered, color, &mut planes.colors[place..place + 8]);
                }
                place += TILE;
                numbers.grow(rows.down, 1);
            }
        }
    }

    /// Returns masks that give the result of the depth test, as the booleans of `depth_stencil::answers` do.
    #[inline(always)]
    fn answers<S: Simd, I: SimdInt<S>>(&self, simd: S) -> [I::Mask; 3] {
        answers(self.passes.unwrap_or_default()).map(|answer| I::Mask::splat(simd, answer))
    }

    /// Returns the covered lanes that pass the depth test. Writes their codes if the draw writes depth.
    #[inline(always)]
    fn passed<S, U>(
        &self,
        simd: S,
        [less, equal, greater]: [U::Mask; 3],
        covered: U::Mask,
        codes: U,
        stored: &mut [u32],
    ) -> U::Mask
    where
        S: Simd,
        U: SimdInt<S, Element = u32>,
        U::Mask: Select<U>,
    {
        let old = U::from_slice(simd, stored);
        let below = codes.simd_lt(old) & less;
        let same = codes.simd_eq(old) & equal;
        let passed = covered & (greater ^ below ^ same);
        if self.write {
            passed.select(codes, old).store_slice(stored);
        }
        passed
    }
}

/// Replaces the words in the lanes of a mask.
#[inline(always)]
fn replace<S, U>(simd: S, mask: U::Mask, new: U, stored: &mut [u32])
where
    S: Simd,
    U: SimdInt<S, Element = u32>,
    U::Mask: Select<U>,
{
    let old = U::from_slice(simd, stored);
    mask.select(new, old).store_slice(stored);
}

/// An opaque triangle in a tile.
pub(crate) struct Opaque<'a> {
    pub(crate) store: &'a Store,
    pub(crate) triangle: &'a RasterTriangle,
    pub(crate) depths: Option<Depths>,
    /// The left, top, right and bottom edges of the tile's texels.
    pub(crate) texels: [i32; 4],
}

/// A sample's planes and position.
pub(crate) struct SamplePlanes<'p> {
    pub(crate) position: [i32; 2],
    /// The texels whose sample can be written.
    pub(crate) rect: [i32; 4],
    /// The colours; empty if no colours are written.
    pub(crate) colors: &'p mut [u32],
    /// The depths; empty if no depths are tested.
    pub(crate) depths: &'p mut [u32],
}

/// The lanes of a triangle's rows.
#[derive(Clone, Copy)]
struct TileArea {
    /// The column of the first lanes, and the number of groups of lanes in a row.
    first: i32,
    chunks: i32,
    /// The first and the last row.
    rows: [i32; 2],
}

/// A source of a triangle's depth codes.
trait CodeSource {
    /// Returns the codes of consecutive texels of a row.
    fn codes<S: Simd, U: SimdInt<S, Element = u32>>(
        &mut self,
        simd: S,
        chunk: i32,
        texel: [i32; 2],
    ) -> U;
}

/// The same depth code for all texels.
struct Flat(u32);

impl CodeSource for Flat {
    #[inline(always)]
    fn codes<S: Simd, U: SimdInt<S, Element = u32>>(&mut self, simd: S, _: i32, _: [i32; 2]) -> U {
        U::splat(simd, self.0)
    }
}

/// Depth codes of any kind.
struct Any<'a>(&'a Depths, [i32; 2]);

impl CodeSource for Any<'_> {
    #[inline(always)]
    fn codes<S: Simd, U: SimdInt<S, Element = u32>>(
        &mut self,
        simd: S,
        _: i32,
        [x, y]: [i32; 2],
    ) -> U {
        U::from_slice(simd, &self.0.codes(x, y, self.1)[..U::LEN])
    }
}

/// Codes of floats without a bias. Keeps the part of the depths that depends on the column, for one group of
/// lanes.
struct Floats<'a> {
    depths: &'a Depths,
    position: [i32; 2],
    columns: [f64; LANES],
    /// The index of the group of lanes that `columns` was computed for.
    chunk: i32,
}

impl CodeSource for Floats<'_> {
    #[inline(always)]
    fn codes<S: Simd, U: SimdInt<S, Element = u32>>(
        &mut self,
        simd: S,
        chunk: i32,
        [x, y]: [i32; 2],
    ) -> U {
        if chunk != self.chunk {
            let columns = &mut self.columns[..U::LEN];
            self.depths.columns(x, self.position, columns);
            self.chunk = chunk;
        }
        let mut codes = [0; LANES];
        let columns = &self.columns[..U::LEN];
        self.depths
            .floats(columns, y, self.position, &mut codes[..U::LEN]);
        U::from_slice(simd, &codes[..U::LEN])
    }
}

impl Opaque<'_> {
    /// Draws the covered texels of a sample. It is large, so it is not inlined.
    #[inline(never)]
    pub(crate) fn draw<S: Simd>(&self, simd: S, planes: SamplePlanes<'_>) {
        simd.vectorize(
            #[inline(always)]
            || self.lanes(simd, planes),
        );
    }

    #[inline(always)]
    fn lanes<S: Simd>(&self, simd: S, planes: SamplePlanes<'_>) {
        let [left, top, right, bottom] = self.texels;
        let around = self.triangle.around.map(i32::from);
        let (start, last) = (around[0].max(left), around[2].min(right - 1));
        let rows = [around[1].max(top), around[3].min(bottom - 1)];
        // A narrow triangle needs one group of lanes, wherever it is.
        let near = start.min(left + TILE as i32 - NARROW);
        if last - near < NARROW {
            let area = TileArea {
                first: near,
                chunks: 1,
                rows,
            };
            return self.sample::<S, i32x8<S>, u32x8<S>>(simd, planes, area);
        }
        let lanes = LANES as i32;
        let near = start.min(left + TILE as i32 - lanes);
        let first = if last - near < lanes {
            near
        } else {
            start / lanes * lanes
        };
        let area = TileArea {
            first,
            chunks: (last - first) / lanes + 1,
            rows,
        };
        self.sample::<S, i32x16<S>, u32x16<S>>(simd, planes, area);
    }

    /// Draws the covered texels of a sample, with lanes of these types.
    #[inline(always)]
    fn sample<S, I, U>(&self, simd: S, planes: SamplePlanes<'_>, area: TileArea)
    where
        S: Simd,
        I: SimdInt<S, Element = i32>,
        U: SimdInt<S, Element = u32, Mask = I::Mask>,
        I::Mask: Select<U>,
    {
        let position = planes.position;
        match &self.depths {
            _ if !self.store.tests() => {
                self.scan::<S, I, U, Flat, false>(simd, planes, area, Flat(0));
            }
            None => {
                let source = Flat(self.triangle.code);
                self.scan::<S, I, U, Flat, true>(simd, planes, area, source);
            }
            Some(depths) if depths.are_floats() => {
                let mut source = Floats {
                    depths,
                    position,
                    columns: [0.0; LANES],
                    chunk: 0,
                };
                let columns = &mut source.columns[..U::LEN];
                depths.columns(area.first, position, columns);
                self.scan::<S, I, U, Floats<'_>, true>(simd, planes, area, source);
            }
            Some(depths) => {
                let source = Any(depths, position);
                self.scan::<S, I, U, Any<'_>, true>(simd, planes, area, source);
            }
        }
    }

    /// Processes rows and lanes, with or without depths.
    #[inline(always)]
    fn scan<S, I, U, D, const DEPTH: bool>(
        &self,
        simd: S,
        planes: SamplePlanes<'_>,
        area: TileArea,
        mut source: D,
    ) where
        S: Simd,
        I: SimdInt<S, Element = i32>,
        U: SimdInt<S, Element = u32, Mask = I::Mask>,
        I::Mask: Select<U>,
        D: CodeSource,
    {
        let SamplePlanes {
            position,
            rect,
            colors,
            depths,
        } = planes;
        let [left, top, ..] = self.texels;
        let lanes = U::LEN as i32;
        let [first, last] = area.rows;
        let rows = EdgeSigns::new(self.triangle, area.first, first, position);
        let mut numbers = rows.lanes::<S, I>(simd);
        let store = self.store;
        let answers = store.answers::<S, U>(simd);
        let mut y = first;
        while y <= last {
            let place = ((y - top) * TILE as i32 + area.first - left) as usize;
            let mut chunk = 0;
            let mut here = numbers;
            while chunk < area.chunks {
                let mut covered = here.covered();
                let x = area.first + chunk * lanes;
                if self.triangle.cut {
                    let columns = I::from_slice(simd, &NUMBERS[..I::LEN]) + x;
                    let inside = columns.simd_ge(rect[0]) & columns.simd_lt(rect[2]);
                    let row = y >= rect[1] && y < rect[3];
                    covered = covered & inside & I::Mask::splat(simd, row);
                }
                let start = place + (chunk * lanes) as usize;
                if DEPTH {
                    let codes: U = source.codes(simd, chunk, [x, y]);
                    let stored = &mut depths[start..start + U::LEN];
                    covered = store.passed(simd, answers, covered, codes, stored);
                }
                if let Some(color) = store.color {
                    let new = U::splat(simd, color);
                    replace(simd, covered, new, &mut colors[start..start + U::LEN]);
                }
                chunk += 1;
                here.grow(rows.across, lanes);
            }
            numbers.grow(rows.down, 1);
            y += 1;
        }
    }
}
