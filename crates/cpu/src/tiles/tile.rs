//! A tile: draws all its triangles in drawing order, while its texels are in the processor's caches.

use super::AREA;
use super::TILE;
use super::depth::Depths;
use super::depth_stencil::{
    ANY, ANY_STENCIL, Decided, decided, hull, keeps, operate, operate_groups, operated,
    stencil_decided,
};
use super::edges::EdgeSigns;
use super::fragments::{Fragments, MOST};
use super::lanes::{ALL, LaneBits, alphas_from, columns, lanes, select};
use super::layer::Layer;
use super::opaque::{Opaque, SamplePlanes, Store};
use super::paint::{Kernel, TexelPaint};
use super::plan::{DrawKernels, PassKernels, Shading};
use super::setup::{DrawGeometry, RangeTriangles, TiledTriangle, tile_texels};
use super::texels::Sources;
use super::texture::Coordinates;
use super::triangle::{RasterTriangle, TriangleKind};
use super::work::TriangleWork;
use crate::lanes::LANES;
use etalon_pipeline::shader::cost;
use etalon_scene::{StencilFace, StencilOperation};
use fearless_simd::i32x16;
use fearless_simd::prelude::*;
use std::hint::black_box;
use std::iter;

/// A tile of a pass's attachments.
#[derive(Debug)]
pub(crate) struct Tile<'a> {
    /// The column and row of the tile.
    pub(crate) at: [usize; 2],
    pub(crate) color: Layer<'a, u32>,
    /// The colour attachments after the first.
    pub(crate) others: Vec<Layer<'a, u32>>,
    /// The tile of the attachment that the colour is resolved to.
    pub(crate) resolved: &'a mut [u32],
    pub(crate) depth: Layer<'a, u32>,
    pub(crate) stencil: Layer<'a, u8>,
}

impl<'a> Tile<'a> {
    /// Returns the colour attachments that a paint changes, each with its function.
    #[inline(always)]
    fn drawn<'t, 'p>(
        &'t mut self,
        paint: &'p TexelPaint,
    ) -> impl Iterator<Item = (&'t mut Layer<'a, u32>, &'p Kernel)> {
        let first = iter::once((&mut self.color, &paint.kernel));
        let layers = first.chain(self.others.iter_mut().zip(&paint.others));
        layers.filter(|(_, kernel)| !kernel.keeps())
    }
}

/// A tile being drawn.
struct TileDrawing<'t, 'a> {
    pass: &'t PassKernels,
    tile: Tile<'a>,
    /// The index of the tile in the attachments.
    index: usize,
    /// The left, top, right and bottom edges of the tile's texels.
    texels: [i32; 4],
    /// True if only the first sample is in memory, and all samples are equal to it.
    same: bool,
    /// A range that contains all depth codes.
    range: [u32; 2],
    /// A range that contains all stencil values.
    stencils: [u8; 2],
}

/// The result of the tests for all texels of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TestResult {
    StencilFails,
    DepthFails,
    Passes,
}

impl TestResult {
    /// Returns the result of a stencil and a depth test, if it is the same for all texels.
    fn of(stencil: Option<Decided>, depth: Option<Decided>) -> Option<Self> {
        match (stencil?, depth) {
            (Decided::Fail, _) => Some(Self::StencilFails),
            (Decided::Pass, Some(Decided::Fail)) => Some(Self::DepthFails),
            (Decided::Pass, Some(Decided::Pass)) => Some(Self::Passes),
            (Decided::Pass, None) => None,
        }
    }

    /// Returns the operation on stored stencil values.
    fn operation(self, face: &StencilFace) -> StencilOperation {
        match self {
            Self::StencilFails => face.fail_op,
            Self::DepthFails => face.depth_fail_op,
            Self::Passes => face.pass_op,
        }
    }
}

/// Draws a tile.
#[inline(always)]
pub(crate) fn draw<S: Simd>(
    simd: S,
    tile: Tile<'_>,
    pass: &PassKernels,
    inputs: &[DrawGeometry<'_>],
    parts: &[RangeTriangles],
) {
    let samples = pass.positions.len();
    let across = pass.size[0].div_ceil(TILE);
    let index = tile.at[1] * across + tile.at[0];
    let cleared = (tile.color.planes.is_empty() || tile.color.cleared().is_some())
        && tile.others.iter().all(|o| o.cleared().is_some())
        && (tile.depth.planes.is_empty() || tile.depth.cleared().is_some())
        && (tile.stencil.planes.is_empty() || tile.stencil.cleared().is_some());
    let mut drawing = TileDrawing {
        pass,
        index,
        texels: tile_texels(pass, tile.at),
        same: samples == 1 || cleared,
        range: tile.depth.cleared().map_or(ANY, |[code, ..]| [code; 2]),
        stencils: (tile.stencil.cleared()).map_or(ANY_STENCIL, |[value, ..]| [value; 2]),
        tile,
    };
    for part in parts {
        let mut last: Option<Store> = None;
        let mut entries = part.bins[index].as_slice();
        while let [entry, rest @ ..] = entries {
            let triangle = &part.triangles[entry.triangle()];
            let input = &inputs[triangle.draw as usize];
            let whole = entry.is_whole();
            // The planes are ready for further triangles of the same draw and paint.
            if whole || last.as_ref().is_none_or(|store| !store.is_of(triangle)) {
                last = drawing.triangle(simd, triangle, input, part, whole);
            }
            entries = match &last {
                Some(store) if triangle.shape == TriangleKind::Small => {
                    drawing.small(simd, store, entries, input, part)
                }
                Some(store) => {
                    drawing.opaque(simd, store, triangle, input, part);
                    rest
                }
                None => rest,
            };
        }
    }
    drawing.finish(simd);
}

impl TileDrawing<'_, '_> {
    /// Draws a triangle. An opaque triangle that covers a part of the tile is left to
    /// [`opaque`](Self::opaque): this function prepares the planes, and returns how the triangle changes
    /// texels.
    #[inline(always)]
    fn triangle<S: Simd>(
        &mut self,
        simd: S,
        triangle: &RasterTriangle,
        input: &DrawGeometry<'_>,
        part: &RangeTriangles,
        whole: bool,
    ) -> Option<Store> {
        let paint = &part.paints[triangle.paint as usize];
        let plan = input.plan;
        let state = plan.stencil.as_ref();
        let face = state.map(|s| if triangle.front { &s.front } else { &s.back });
        let answer = self.answer(triangle, plan);
        let stencil = match face {
            Some(face) => stencil_decided(face, self.stencils),
            None => Some(Decided::Pass),
        };
        let outcome = TestResult::of(stencil, answer);
        // Stencil state that passes and changes nothing can be ignored.
        let face = face.filter(|face| match outcome {
            // After a triangle that covers only a part of the tile, the tests of later triangles of the draw
            // might have another result.
            Some(outcome) if whole || outcome == TestResult::StencilFails => {
                !keeps(face, outcome.operation(face))
            }
            _ => {
                let pass = stencil == Some(Decided::Pass);
                !(pass && keeps(face, face.depth_fail_op) && keeps(face, face.pass_op))
            }
        });
        let fails = matches!(
            outcome,
            Some(TestResult::StencilFails | TestResult::DepthFails)
        );
        if (fails && face.is_none()) || paint.samples == 0 {
            return None;
        }
        for (layer, _) in self.tile.drawn(paint) {
            layer.touch(self.same);
        }
        if plan.depth.is_some() {
            self.tile.depth.touch(self.same);
        }
        if face.is_some() {
            self.tile.stencil.touch(self.same);
        }
        let samples = u32::MAX >> (32 - self.pass.positions.len());
        let covers_all = whole && paint.samples & samples == samples;
        if self.same && !covers_all {
            self.expand();
        }
        if !whole && face.is_none() {
            let store = Store::new(triangle, plan, paint);
            if store.is_some() {
                return store;
            }
        }
        let work = TriangleWork {
            triangle,
            plan,
            face,
            paint,
            depths: self.depths(triangle, input, part),
            texture: input.texture.as_ref().map(|texture| {
                (
                    texture,
                    Coordinates::new(input.draw, triangle, &part.rare(triangle).vertices),
                )
            }),
            texels: input.texels,
        };
        self.samples(simd, &work, whole, outcome);
        let replaces_all = covers_all && work.is_constant();
        if !fails {
            self.widen(
                triangle,
                plan,
                replaces_all && outcome == Some(TestResult::Passes),
            );
        }
        if let Some(face) = face {
            self.widen_stencils(face, replaces_all, outcome);
        }
        None
    }

    /// Returns the result of the depth test, if it is the same for all texels.
    #[inline(always)]
    fn answer(&self, triangle: &RasterTriangle, plan: &DrawKernels) -> Option<Decided> {
        match plan.depth {
            None => Some(Decided::Pass),
            Some(depth) if triangle.is_flat() => decided(depth.compare, triangle.code, self.range),
            Some(_) => None,
        }
    }

    /// Returns the depths of a triangle, unless it is flat or depths are not tested.
    #[inline(always)]
    fn depths(
        &self,
        triangle: &RasterTriangle,
        input: &DrawGeometry<'_>,
        part: &RangeTriangles,
    ) -> Option<Depths> {
        match (input.plan.depth, self.pass.depth) {
            (Some(_), Some(encoding)) if !triangle.is_flat() => {
                let bias = part.rare(triangle).bias;
                Some(Depths::new(input.draw, triangle, bias, encoding))
            }
            _ => None,
        }
    }

    /// Widens the range of depths to include every depth that a triangle might have written, to all texels or
    /// to some.
    #[inline(always)]
    fn widen(&mut self, triangle: &RasterTriangle, plan: &DrawKernels, replaces_all: bool) {
        if !plan.depth.is_some_and(|d| d.write) {
            return;
        }
        let code = triangle.code;
        self.range = if !triangle.is_flat() {
            ANY
        } else if replaces_all {
            [code; 2]
        } else {
            [self.range[0].min(code), self.range[1].max(code)]
        };
    }

    /// Widens the range of stencil values by every value that a face can have written to all or some texels.
    #[inline(always)]
    fn widen_stencils(
        &mut self,
        face: &StencilFace,
        replaces_all: bool,
        outcome: Option<TestResult>,
    ) {
        let old = self.stencils;
        let updated = |outcome: TestResult| operated(face, outcome.operation(face), old);
        self.stencils = match outcome {
            Some(outcome) if replaces_all => updated(outcome),
            Some(outcome) => hull(old, updated(outcome)),
            None => [
                TestResult::StencilFails,
                TestResult::DepthFails,
                TestResult::Passes,
            ]
            .into_iter()
            .fold(old, |range, outcome| hull(range, updated(outcome))),
        };
    }

    /// Gives every sample its own planes.
    #[inline(always)]
    fn expand(&mut self) {
        if self.pass.positions.len() > 1 {
            self.tile.color.expand();
            self.tile.others.iter_mut().for_each(Layer::expand);
            self.tile.depth.expand();
            self.tile.stencil.expand();
            self.same = false;
        }
    }

    /// Draws a triangle sample by sample.
    #[inline(always)]
    fn samples<S: Simd>(
        &mut self,
        simd: S,
        work: &TriangleWork<'_>,
        whole: bool,
        outcome: Option<TestResult>,
    ) {
        // If the triangle covers only a part of the tile, every sample has its own planes by now.
        let planes = if self.same {
            1
        } else {
            self.pass.positions.len()
        };
        let decided = outcome.filter(|_| whole && work.is_constant());
        for sample in 0..planes {
            if !self.same && work.paint.samples & (1 << sample) == 0 {
                continue;
            }
            match decided {
                Some(outcome) => self.decided(simd, work, sample, outcome),
                None => self.scan(simd, work, sample, whole),
            }
        }
    }

    /// Draws all texels of a sample, for which the tests have the same result.
    #[inline(always)]
    fn decided<S: Simd>(
        &mut self,
        simd: S,
        work: &TriangleWork<'_>,
        sample: usize,
        outcome: TestResult,
    ) {
        let [left, top, right, bottom] = self.texels;
        let start = sample * AREA;
        let range = start..start + (bottom - top) as usize * TILE;
        if let Some(face) = work.face {
            let values = &mut self.tile.stencil.planes[range.clone()];
            operate(face, outcome.operation(face), values);
        }
        if outcome != TestResult::Passes {
            return;
        }
        if work.plan.depth.is_some_and(|d| d.write) {
            self.tile.depth.planes[range.clone()].fill(work.triangle.code);
        }
        if let Shading::Expensive(steps) = work.plan.shading {
            for y in top..bottom {
                for x in (left..right).step_by(LANES) {
                    work_off(steps, [x, y]);
                }
            }
        }
        for (layer, kernel) in self.tile.drawn(work.paint) {
            kernel.whole(simd, layer.sample(sample), range.len());
        }
    }

    /// Draws a triangle that replaces colour, depth or both, with a depth test.
    #[inline(always)]
    fn opaque<S: Simd>(
        &mut self,
        simd: S,
        store: &Store,
        triangle: &RasterTriangle,
        input: &DrawGeometry<'_>,
        part: &RangeTriangles,
    ) {
        let plan = input.plan;
        if self.answer(triangle, plan) == Some(Decided::Fail) {
            return;
        }
        let opaque = Opaque {
            store,
            triangle,
            depths: self.depths(triangle, input, part),
            texels: self.texels,
        };
        let samples = part.paints[triangle.paint as usize].samples;
        for sample in 0..self.pass.positions.len() {
            if samples & (1 << sample) == 0 {
                continue;
            }
            let planes = self.planes(store, plan, sample);
            opaque.draw(simd, planes);
        }
        self.widen(triangle, plan, false);
    }

    /// Returns the planes of a sample that opaque triangles of a draw change.
    #[inline(always)]
    fn planes(&mut self, store: &Store, plan: &DrawKernels, sample: usize) -> SamplePlanes<'_> {
        SamplePlanes {
            position: self.pass.positions[sample],
            rect: plan.rects[sample],
            colors: if store.colors() {
                self.tile.color.sample(sample)
            } else {
                &mut []
            },
            depths: if store.tests() {
                self.tile.depth.sample(sample)
            } else {
                &mut []
            },
        }
    }

    /// Draws the small triangles at the beginning of `entries`, while they do the same to texels as the
    /// first. Returns the remaining entries.
    #[inline(always)]
    fn small<'e, S: Simd>(
        &mut self,
        simd: S,
        store: &Store,
        entries: &'e [TiledTriangle],
        input: &DrawGeometry<'_>,
        part: &RangeTriangles,
    ) -> &'e [TiledTriangle] {
        let is_alike = |entry: &&TiledTriangle| {
            let triangle = &part.triangles[entry.triangle()];
            triangle.shape == TriangleKind::Small && store.is_of(triangle) && !entry.is_whole()
        };
        let count = entries.iter().take_while(is_alike).count();
        let (alike, others) = entries.split_at(count);
        let triangles = alike.iter().map(|e| &part.triangles[e.triangle()]);
        let [first, ..] = alike else {
            return others;
        };
        let samples = part.paints[part.triangles[first.triangle()].paint as usize].samples;
        let texels = self.texels;
        for sample in 0..self.pass.positions.len() {
            if samples & (1 << sample) == 0 {
                continue;
            }
            let planes = self.planes(store, input.plan, sample);
            store.small(simd, triangles.clone(), planes, texels);
        }
        for triangle in triangles {
            self.widen(triangle, input.plan, false);
        }
        others
    }

    /// Draws the texels of one sample that a triangle covers, which are all of them if `whole` is true. It is
    /// large, so it is not inlined.
    #[inline(never)]
    fn scan<S: Simd>(&mut self, simd: S, work: &TriangleWork<'_>, sample: usize, whole: bool) {
        simd.vectorize(
            #[inline(always)]
            || self.scan_of(simd, work, sample, whole),
        );
    }

    #[inline(always)]
    fn scan_of<S: Simd>(&mut self, simd: S, work: &TriangleWork<'_>, sample: usize, whole: bool) {
        let mut fragments = Fragments::new();
        let triangle = work.triangle;
        let [left, top, right, bottom] = self.texels;
        let around = if whole {
            [left, top, right - 1, bottom - 1]
        } else {
            triangle.around.map(i32::from)
        };
        let wide = LANES as i32;
        let first = around[0].max(left) / wide * wide;
        let (y_first, y_last) = (around[1].max(top), around[3].min(bottom - 1));
        let last = around[2].min(right - 1);
        let rows = EdgeSigns::new(triangle, first, y_first, self.pass.positions[sample]);
        let mut row = rows.lanes::<S, i32x16<S>>(simd);
        let rect = &work.plan.rects[sample];
        let cut = triangle.cut && !whole;
        for y in y_first..=y_last {
            let mut here = row;
            row.grow(rows.down, 1);
            if cut && (y < rect[1] || y >= rect[3]) {
                continue;
            }
            for chunk in 0..=(last - first) / wide {
                let x = first + chunk * wide;
                let mut mask = if whole {
                    ALL
                } else {
                    here.covered().to_bitmask() as LaneBits
                };
                here.grow(rows.across, wide);
                if cut {
                    mask &= columns(x, [rect[0], rect[2]]);
                }
                let place = (y - top) as usize * TILE + (x - left) as usize;
                if fragments.push(place, mask) {
                    self.fragments(simd, work, sample, &mut fragments);
                    fragments.clear();
                }
            }
        }
        if !fragments.is_empty() {
            self.fragments(simd, work, sample, &mut fragments);
        }
    }

    /// Tests, blends and stores fragments of one sample. It is large, so it is not inlined.
    #[inline(never)]
    fn fragments<S: Simd>(
        &mut self,
        simd: S,
        work: &TriangleWork<'_>,
        sample: usize,
        fragments: &mut Fragments,
    ) {
        simd.vectorize(
            #[inline(always)]
            || self.fragments_of(simd, work, sample, fragments),
        );
    }

    #[inline(always)]
    fn fragments_of<S: Simd>(
        &mut self,
        simd: S,
        work: &TriangleWork<'_>,
        sample: usize,
        fragments: &mut Fragments,
    ) {
        let [left, top, ..] = self.texels;
        let texel_at = |place: usize| [left + (place % TILE) as i32, top + (place / TILE) as i32];
        let fetched = match (&work.texture, &work.plan.shading) {
            (Some((texture, coordinates)), Shading::Texture { address, kept, .. }) => {
                let mut fetched = [[0; LANES]; MOST];
                for ((place, mask), texels) in fragments.groups_mut().zip(&mut fetched) {
                    let [x, y] = texel_at(place);
                    *texels = texture.nearest(*address, coordinates.at(x, y));
                    *mask &= alphas_from(simd, texels, *kept);
                }
                Some(fetched)
            }
            _ => None,
        };
        let mut failed = fragments.masks();
        if let Some(face) = work.face {
            fragments.test_stencil(simd, face, self.tile.stencil.sample(sample));
            failed = fragments.lost(failed);
        }
        let tested = fragments.masks();
        if let Some(state) = &work.plan.depth {
            let position = self.pass.positions[sample];
            let plane = self.tile.depth.sample(sample);
            match &work.depths {
                None => fragments.test_depth(simd, state, plane, |_| [work.triangle.code; LANES]),
                Some(depths) => fragments.test_depth(simd, state, plane, |place| {
                    let [x, y] = texel_at(place);
                    depths.codes(x, y, position)
                }),
            }
        }
        if let Some(face) = work.face {
            let behind = fragments.lost(tested);
            for (operation, masks) in [
                (face.fail_op, failed),
                (face.depth_fail_op, behind),
                (face.pass_op, fragments.masks()),
            ] {
                let plane = self.tile.stencil.sample(sample);
                operate_groups(simd, face, operation, plane, fragments.with(&masks));
            }
        }
        if let Shading::Expensive(steps) = work.plan.shading {
            for (place, mask) in fragments.groups() {
                if mask != 0 {
                    work_off(steps, texel_at(place));
                }
            }
        }
        if let Some(fetched) = &fetched {
            let plane = self.tile.color.sample(sample);
            for ((place, mask), texels) in fragments.groups().zip(fetched) {
                select(simd, lanes(plane, place), mask, texels);
            }
            return;
        }
        let sources = Sources::new(work.texels.as_ref(), self.index);
        for (layer, kernel) in self.tile.drawn(work.paint) {
            kernel.masked(simd, layer.sample(sample), fragments, &sources);
        }
    }

    /// Resolves colour, and gives every sample its own planes.
    #[inline(always)]
    fn finish<S: Simd>(&mut self, simd: S) {
        if let Some((_, resolve)) = &self.pass.resolve {
            let Tile {
                color, resolved, ..
            } = &mut self.tile;
            color.touch(self.same);
            resolve.tile(simd, color.planes, self.same, resolved);
        }
        if self.same {
            self.expand();
        }
    }
}

/// Does an expensive shader's work for consecutive texels. The work adds 0 to their colours, so its result is
/// dropped.
#[inline(always)]
fn work_off(steps: f32, [x, y]: [i32; 2]) {
    let columns: [u32; LANES] = std::array::from_fn(|lane| x as u32 + lane as u32);
    black_box(cost(columns, y as u32, steps));
}
