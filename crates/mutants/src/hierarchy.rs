//! Bugs of a coarse depth buffer, which stores the least and the greatest depth of each tile to reject
//! whole tiles.
//!
//! The rasterizer has no such buffer, so these bugs add one. Without a bug it changes no frame, since it
//! only rejects tiles in which no fragment passes. Each bug makes it wrong in one way.

use crate::aspects::reaches;
use crate::hooks::code;
use crate::list::bugs;
use crate::memory::{Area, StoredDataBug, copy, texel_rows};
use crate::plant::{Plant, memory};
use CompareFunction::{Always, Equal, Greater, GreaterEqual, Less, LessEqual};
use etalon_backend::Prepared;
use etalon_cpu::steps::{Moment, Stored};
use etalon_cpu::{CpuScene, CpuSurface};
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_pipeline::{Plain, window_position};
use etalon_scene::{
    CompareFunction, DepthBias, DepthState, Draw, Pass, PrimitiveTopology, PrimitiveVertices,
    Scene, StencilOperation,
};

/// A least and a greatest code.
type CodeRange = [u32; 2];

/// Returns true for the draws that a bug affects, given the pass index.
type Strikes = fn(usize, &Draw) -> bool;

/// The rules of a coarse depth buffer. Any of them can be wrong.
#[derive(Clone, Copy)]
struct DepthRules {
    /// The side of a tile, in texels.
    side: usize,
    /// The draws whose writes are not recorded.
    missed: Strikes,
    /// The draws for which every fragment of every tile that they touch is recorded as written.
    overrated: Strikes,
    /// Returns the comparison that is used for a draw, given the previous draw's depth test.
    compare: fn(Option<DepthState>, CompareFunction) -> CompareFunction,
    /// True if draws whose shader writes depth are tested with the depths of their vertices.
    trusts_vertices: bool,
    /// Returns true if a draw is rejected by mistake, given its depths and the stored ones.
    rejects_too: fn(CompareFunction, CodeRange, CodeRange) -> bool,
    /// The depth that is recorded for the initial clear.
    initial: Option<f32>,
    /// True if a new pass resets the ranges to those after the initial clear.
    forgets: bool,
    /// The number of tiles per row; further tiles share the entries at the start of the row.
    columns: usize,
    /// True if tiles that extend beyond the attachment are not recorded after the initial clear.
    misses_edges: bool,
    /// True if the clear of a load operation is not recorded.
    misses_loads: bool,
    /// True if rejected tiles skip their stencil operation.
    loses_stencil: bool,
}

impl Default for DepthRules {
    /// Returns the rules without a bug.
    fn default() -> Self {
        Self {
            side: 8,
            missed: |_, _| false,
            overrated: |_, _| false,
            compare: |_, compare| compare,
            trusts_vertices: false,
            rejects_too: |_, _, _| false,
            initial: None,
            forgets: false,
            columns: usize::MAX,
            misses_edges: false,
            misses_loads: false,
            loses_stencil: false,
        }
    }
}

/// The coarse depth buffer of one prepared scene.
#[derive(Default)]
struct Coarse {
    rules: DepthRules,
    /// The ranges of each attachment's tiles, row by row; empty for attachments without depth.
    maps: Vec<Vec<CodeRange>>,
    /// The maps after the initial clear.
    initial: Vec<Vec<CodeRange>>,
    /// The depth test of the previous draw.
    previous_test: Option<DepthState>,
    /// The tiles that are rejected, and copies of the attachments before the draw.
    rejected: Vec<Area>,
    kept: Vec<(usize, CpuSurface)>,
}

fn encoding(scene: &Scene, index: usize) -> Option<ChannelEncoding> {
    let format = scene.attachments[index].format;
    format.depth_encodings().first().copied()
}

/// Returns the range of the depths in an area.
fn range(surface: &CpuSurface, area: Area) -> CodeRange {
    let codes = texel_rows(surface, area).flat_map(|texels| {
        let planes = surface.planes.iter();
        planes.flat_map(move |plane| &plane[texels.clone()])
    });
    codes.fold([u32::MAX, 0], |[min, max], code| {
        [min.min(*code), max.max(*code)]
    })
}

/// Returns true if no depth of a draw passes against any stored depth.
fn rejects(compare: CompareFunction, [lo, hi]: CodeRange, [min, max]: CodeRange) -> bool {
    match compare {
        CompareFunction::Never => true,
        Less => lo >= max,
        LessEqual => lo > max,
        Greater => hi <= min,
        GreaterEqual => hi < min,
        Equal => lo > max || hi < min,
        CompareFunction::NotEqual => lo == hi && [lo, hi] == [min, max],
        Always => false,
    }
}

impl Coarse {
    fn reached(&mut self, moment: Moment, scene: &Scene, stored: Stored<'_>) {
        let surfaces = stored.surfaces;
        match moment {
            Moment::Initial => {
                self.maps = vec![Vec::new(); surfaces.len()];
                self.previous_test = None;
                for index in 0..surfaces.len() {
                    self.note(scene, index, surfaces);
                    if let (Some(depth), Some(encoding)) =
                        (self.rules.initial, encoding(scene, index))
                    {
                        self.maps[index].fill([code(encoding, depth); 2]);
                    }
                }
                self.initial.clone_from(&self.maps);
            }
            Moment::Begin { pass } if self.rules.forgets && pass > 0 => {
                self.maps.clone_from(&self.initial);
            }
            Moment::Draw { pass, draw } => {
                let pass = &scene.passes[pass];
                self.reject(scene, pass, &pass.draws[draw], surfaces);
            }
            Moment::Drawn { pass, draw } => {
                for (index, kept) in self.kept.drain(..) {
                    let rejected = self.rejected.iter();
                    rejected.for_each(|area| copy(&kept, &mut surfaces[index], *area));
                }
                self.rejected.clear();
                self.drawn(scene, pass, &scene.passes[pass].draws[draw], surfaces);
            }
            Moment::Loaded { pass } | Moment::Cleared { pass, .. } => {
                let pass = &scene.passes[pass];
                let cleared = pass.depth_stencil.filter(|index| match moment {
                    Moment::Cleared { clear, .. } => reaches(&clear, Aspect::Depth),
                    _ => {
                        let clears = pass.cleared().contains(&(*index, Aspect::Depth));
                        clears && !self.rules.misses_loads
                    }
                });
                if let Some(index) = cleared {
                    self.note(scene, index, surfaces);
                }
            }
            Moment::Begin { .. } | Moment::End { .. } => {}
        }
    }

    /// Records the depths of an attachment.
    fn note(&mut self, scene: &Scene, index: usize, surfaces: &[CpuSurface]) {
        if encoding(scene, index).is_none() {
            return;
        }
        let (surface, side) = (&surfaces[index], self.rules.side);
        let old = std::mem::take(&mut self.maps[index]);
        for y in (0..surface.height).step_by(side) {
            for x in (0..surface.width).step_by(side) {
                let (right, bottom) = (x + side, y + side);
                let cut = right > surface.width || bottom > surface.height;
                let map = &mut self.maps[index];
                let known = old
                    .get(map.len())
                    .filter(|_| cut && self.rules.misses_edges);
                let found = || range(surface, [x, y, right, bottom]);
                map.push(known.copied().unwrap_or_else(found));
            }
        }
    }

    /// Returns the tiles that a draw touches, with the range of its depths in each; empty if any vertex is
    /// not in front of the eye.
    fn touched(
        &self,
        encoding: ChannelEncoding,
        [columns, rows]: [usize; 2],
        draw: &Draw,
    ) -> Vec<(usize, CodeRange)> {
        let vertices = &draw.mesh.vertices;
        if vertices.iter().any(|v| v.position[3] <= 0.0) {
            return Vec::new();
        }
        let place = |i: &usize| {
            let position = vertices[*i].position;
            window_position(&mut Plain::<1>, position, &draw.viewport).map(|[value]| value)
        };
        let [near, far] = draw.viewport.depth;
        let (near, far) = (near.min(far), near.max(far));
        let mut found: Vec<Option<CodeRange>> = vec![None; columns * rows];
        for primitive in draw.mesh.primitives(draw.topology) {
            let corners: Vec<[f32; 3]> = match &primitive {
                PrimitiveVertices::Point(vertex) => vec![place(vertex)],
                PrimitiveVertices::Line(ends) => ends.iter().map(place).collect(),
                PrimitiveVertices::Triangle(corners) => corners.iter().map(place).collect(),
            };
            let ends = |axis: usize| {
                let values = corners.iter().map(|corner| corner[axis]);
                values.fold([f32::MAX, f32::MIN], |[low, high], v| {
                    [low.min(v), high.max(v)]
                })
            };
            let tiles = |axis: usize, most: usize| {
                let [low, high] = ends(axis);
                let tile = |v: f32| (v.max(0.0) as usize) / self.rules.side;
                tile(low - 1.0)..=tile(high + 1.0).min(most.saturating_sub(1))
            };
            let codes = ends(2).map(|z| code(encoding, z.clamp(near, far).clamp(0.0, 1.0) + 0.0));
            for tile in
                tiles(1, rows).flat_map(|row| tiles(0, columns).map(move |c| row * columns + c))
            {
                let [low, high] = found[tile].unwrap_or(codes);
                found[tile] = Some([low.min(codes[0]), high.max(codes[1])]);
            }
        }
        let tiles = found.into_iter().enumerate();
        tiles
            .filter_map(|(tile, range)| Some((tile, range?)))
            .collect()
    }

    /// Returns the number of columns and rows of tiles.
    fn size(&self, surface: &CpuSurface) -> [usize; 2] {
        [surface.width, surface.height].map(|length| length.div_ceil(self.rules.side))
    }

    /// Finds the tiles in which a draw is rejected.
    fn reject(&mut self, scene: &Scene, pass: &Pass, draw: &Draw, surfaces: &[CpuSurface]) {
        let Some(index) = pass.depth_stencil else {
            return;
        };
        let previous_test = std::mem::replace(&mut self.previous_test, draw.depth);
        let (Some(depth), Some(encoding)) = (draw.depth, encoding(scene, index)) else {
            return;
        };
        let keeps = |op| op == StencilOperation::Keep || self.rules.loses_stencil;
        let faces = draw.stencil.iter().flat_map(|s| [s.front, s.back]);
        let mut operations = faces.flat_map(|face| [face.fail_op, face.depth_fail_op]);
        let written = draw.shader.writes_depth();
        let moved = (written || draw.depth_bias != DepthBias::default())
            && !(written && self.rules.trusts_vertices);
        if moved || !operations.all(keeps) || draw.shader.counts_runs() {
            return;
        }
        let (side, compare) = (
            self.rules.side,
            (self.rules.compare)(previous_test, depth.compare),
        );
        let [columns, rows] = self.size(&surfaces[index]);
        for (tile, codes) in self.touched(encoding, [columns, rows], draw) {
            let (x, y) = (tile % columns, tile / columns);
            let known = self.maps[index].get(y * columns + x % self.rules.columns);
            if known.is_some_and(|known| {
                rejects(compare, codes, *known) || (self.rules.rejects_too)(compare, codes, *known)
            }) {
                let (left, top) = (x * side, y * side);
                self.rejected.push([left, top, left + side, top + side]);
            }
        }
        if !self.rejected.is_empty() {
            let attachments = pass.color.iter().chain(&pass.depth_stencil);
            self.kept = attachments.map(|i| (*i, surfaces[*i].clone())).collect();
        }
    }

    /// Records what a draw wrote.
    fn drawn(&mut self, scene: &Scene, pass: usize, draw: &Draw, surfaces: &[CpuSurface]) {
        let (Some(index), Some(depth)) = (scene.passes[pass].depth_stencil, draw.depth) else {
            return;
        };
        if (self.rules.missed)(pass, draw) {
            return;
        }
        if depth.write {
            self.note(scene, index, surfaces);
        }
        let Some(encoding) = encoding(scene, index).filter(|_| (self.rules.overrated)(pass, draw))
        else {
            return;
        };
        for (tile, [lo, hi]) in self.touched(encoding, self.size(&surfaces[index]), draw) {
            let range = &mut self.maps[index][tile];
            let [min, max] = *range;
            *range = match depth.compare {
                Less | LessEqual => [lo.min(min), hi.min(max)],
                Greater | GreaterEqual => [lo.max(min), hi.max(max)],
                Always => [lo, hi],
                _ => [min, max],
            };
        }
    }
}

/// Prepares a scene with a coarse depth buffer that has no bug, which changes no frame.
pub fn with_faithful_hierarchy(scene: Scene) -> impl Prepared {
    let mut coarse = Coarse::default();
    let memory =
        move |moment, scene: &Scene, stored: Stored<'_>| coarse.reached(moment, scene, stored);
    CpuScene::new(scene, StoredDataBug::new(memory))
}

fn coarse(rules: DepthRules) -> Plant {
    memory(move |coarse: &mut Coarse, moment, scene, stored| {
        coarse.rules = rules;
        coarse.reached(moment, scene, stored);
    })
}

fn compares(draw: &Draw, functions: &[CompareFunction]) -> bool {
    draw.depth.is_some_and(|d| functions.contains(&d.compare))
}

fn writes(draw: &Draw) -> bool {
    draw.depth.is_some_and(|d| d.write)
}

const SHADER_DEPTH: Strikes = |_, draw| draw.shader.writes_depth();
const ALWAYS: Strikes = |_, draw| compares(draw, &[Always]);
const THIN: [PrimitiveTopology; 3] = [
    PrimitiveTopology::PointList,
    PrimitiveTopology::LineList,
    PrimitiveTopology::LineStrip,
];

bugs! {
    class "hierarchy", "size";
    for (name, what, missed as Strikes) in [
        ("shader-depth", "depths that shaders write", SHADER_DEPTH),
        ("always", "draws that always pass", ALWAYS),
        ("greater", "draws with greater", |_, draw| compares(draw, &[Greater, GreaterEqual])),
        ("less", "draws with less", |_, draw| compares(draw, &[Less, LessEqual])),
        ("stencil", "draws with stencil", |_, draw| draw.stencil.is_some()),
        ("later-passes", "later passes", |pass, _| pass > 0),
        ("points", "points and lines", |_, draw| THIN.contains(&draw.topology)),
    ] {
        "{name}-missed: The coarse depth misses what is written by {what}." =>
            coarse(DepthRules { missed, ..DepthRules::default() });
    }
    for side in [16, 32, 64] {
        "shader-depth-missed-in-tiles-of-{side}: A coarse depth of {side}×{side} misses depths that shaders write." =>
            coarse(DepthRules { side, missed: SHADER_DEPTH, ..DepthRules::default() });
        "always-missed-in-tiles-of-{side}: A coarse depth of {side}×{side} misses draws that always pass." =>
            coarse(DepthRules { side, missed: ALWAYS, ..DepthRules::default() });
    }
    for (name, what, overrated as Strikes) in [
        ("write-off", "writes no depth", |_, d| d.depth.is_some() && !writes(d)),
        ("discard", "discards", |_, d| d.shader.discards()),
        ("partly-covered", "covers a part of a tile", |_, d| writes(d) && d.scissor.is_none()),
        ("stencil", "has a stencil test", |_, d| d.stencil.is_some()),
    ] {
        "{name}-noted-as-written: A draw that {what} counts as writing every texel it touches." =>
            coarse(DepthRules { overrated, ..DepthRules::default() });
    }
    "compare-kept: The coarse depth is tested with the comparison of the draw before." =>
        coarse(DepthRules { compare: |before, compare| before.map_or(compare, |before| before.compare), ..DepthRules::default() });
    "first-direction-kept: After a draw with less, the coarse depth is tested with less." =>
        coarse(DepthRules {
            compare: |before, compare| if before.is_some_and(|b| b.compare == Less) { Less } else { compare },
            ..DepthRules::default()
        });
    "shader-depth-ignored: Draws whose shader writes depth are rejected by the depths of their vertices." =>
        coarse(DepthRules { trusts_vertices: true, ..DepthRules::default() });
    "greatest-used-for-greater: Greater is tested against the greatest depth of a tile." =>
        coarse(DepthRules { rejects_too: |c, [_, hi], [_, max]| c == Greater && hi <= max, ..DepthRules::default() });
    "least-used-for-less: Less is tested against the least depth of a tile." =>
        coarse(DepthRules { rejects_too: |c, [lo, _], [min, _]| c == Less && lo >= min, ..DepthRules::default() });
    "less-equal-bound-rejected: Less-equal rejects depths equal to the greatest depth." =>
        coarse(DepthRules { rejects_too: |c, [lo, _], [_, max]| c == LessEqual && lo >= max, ..DepthRules::default() });
    "greater-equal-bound-rejected: Greater-equal rejects depths equal to the least depth." =>
        coarse(DepthRules { rejects_too: |c, [_, hi], [min, _]| c == GreaterEqual && hi <= min, ..DepthRules::default() });
    "equal-bound-rejected: Equal rejects a draw that meets a tile's depths at one end only." =>
        coarse(DepthRules { rejects_too: |c, [lo, hi], [min, max]| c == Equal && (lo >= max || hi <= min), ..DepthRules::default() });
    for n in [0, 1] {
        "clear-missed-after-{n}: The coarse depth misses the first clear and holds {n}." =>
            coarse(DepthRules { initial: Some(n as f32), ..DepthRules::default() });
    }
    "reset-between-passes: In the next pass, the coarse depth is that of the clear." =>
        coarse(DepthRules { forgets: true, ..DepthRules::default() });
    for columns in [4, 8, 16] {
        "columns-wrap-at-{columns}: A row of coarse depths begins anew after {columns} tiles." =>
            coarse(DepthRules { columns, ..DepthRules::default() });
    }
    "load-missed: The coarse depth misses the clear of a load operation." =>
        coarse(DepthRules { misses_loads: true, ..DepthRules::default() });
    "edge-missed: Tiles that extend beyond the attachment keep the coarse depth of the clear." =>
        coarse(DepthRules { misses_edges: true, ..DepthRules::default() });
    "stencil-lost: In rejected tiles, fragments that fail the depth test do not change stencil." =>
        coarse(DepthRules { loses_stencil: true, ..DepthRules::default() });
}
