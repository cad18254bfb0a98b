//! Bugs of a coarse depth: a least and a greatest depth for each tile, by which whole tiles are rejected.
//!
//! The rasterizer has none, so these bugs bring one: without a bug it changes no frame, since it only
//! rejects tiles in which no fragment passes. Each bug makes it wrong in one way.

use crate::aspects::reaches;
use crate::hooks::code;
use crate::list::List;
use crate::memory::{Area, Memory, copy};
use crate::plant::{Plant, memory};
use etalon_cpu::Surface;
use etalon_cpu::steps::{Moment, Stored};
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_pipeline::{Plain, window_position};
use etalon_scene::{
    CompareFunction, DepthBias, DepthState, Draw, Pass, PrimitiveTopology, PrimitiveVertices,
    Scene, StencilFace, StencilOperation, Vertex,
};

/// The bug of a coarse depth.
#[derive(Clone, Copy)]
enum Bug {
    /// None.
    #[cfg_attr(not(test), expect(dead_code, reason = "a test plants it"))]
    Faithful,
    /// What these draws write is not noted.
    Missed(Strikes),
    /// Of these draws, every fragment of every tile that they touch is noted as written.
    Overrated(fn(&Draw) -> bool),
    /// A draw is tested with another comparison, given the depth test of the draw before.
    TestedAs(fn(Option<DepthState>, CompareFunction) -> CompareFunction),
    /// Draws whose shader writes depth are tested by the depth of their vertices.
    VertexDepth,
    /// A comparison with the least and the greatest depth rejects too much.
    Rejects(CompareFunction, fn([u32; 2], [u32; 2]) -> bool),
    /// The initial clear is not noted: all depths are this one.
    Initial(f32),
    /// A pass change brings back what the initial clear left.
    Forgets,
    /// Tiles beyond this many in a row are those of the row's start.
    Wraps(usize),
    /// Tiles that extend beyond the attachment are not noted after the initial clear.
    Partial,
    /// The clear of a load operation is not noted.
    LoadMissed,
    /// Rejected tiles lose their stencil operation.
    StencilLost,
}

/// The least and the greatest code of each tile, row by row.
#[derive(Clone, Default)]
struct Map {
    columns: usize,
    ranges: Vec<[u32; 2]>,
}

/// The coarse depth of one prepared scene.
struct Coarse {
    side: usize,
    bug: Bug,
    /// One per attachment; empty without depth.
    maps: Vec<Map>,
    /// The maps after the initial clear.
    initial: Vec<Map>,
    before: Option<DepthState>,
    /// The tiles that are rejected, and the attachments as they are before the draw.
    rejected: Vec<Area>,
    kept: Vec<(usize, Surface)>,
}

fn encoding(scene: &Scene, index: usize) -> Option<ChannelEncoding> {
    let format = scene.attachments[index].format;
    format.depth_encodings().first().copied()
}

/// Returns the codes of the depths in an area, the least and the greatest.
fn range(surface: &Surface, [left, top, right, bottom]: Area) -> [u32; 2] {
    let mut found = [u32::MAX, 0];
    for plane in &surface.planes {
        for y in top..bottom.min(surface.height) {
            let row = y * surface.stride;
            for code in &plane[row + left..row + right.min(surface.width)] {
                found = [found[0].min(*code), found[1].max(*code)];
            }
        }
    }
    found
}

/// True if no depth of a draw passes against any stored one. Both are the least and the greatest code.
fn rejects(compare: CompareFunction, [lo, hi]: [u32; 2], [min, max]: [u32; 2]) -> bool {
    match compare {
        CompareFunction::Never => true,
        CompareFunction::Less => lo >= max,
        CompareFunction::LessEqual => lo > max,
        CompareFunction::Greater => hi <= min,
        CompareFunction::GreaterEqual => hi < min,
        CompareFunction::Equal => lo > max || hi < min,
        CompareFunction::NotEqual => lo == hi && [lo, hi] == [min, max],
        CompareFunction::Always => false,
    }
}

fn keeps(face: &StencilFace) -> bool {
    let keep = StencilOperation::Keep;
    face.fail_op == keep && face.depth_fail_op == keep
}

impl Coarse {
    fn new(side: usize, bug: Bug) -> Self {
        Self {
            side,
            bug,
            maps: Vec::new(),
            initial: Vec::new(),
            before: None,
            rejected: Vec::new(),
            kept: Vec::new(),
        }
    }

    fn reached(&mut self, moment: Moment, scene: &Scene, stored: Stored<'_>) {
        let surfaces = stored.surfaces;
        match moment {
            Moment::Initial => {
                self.maps = vec![Map::default(); surfaces.len()];
                self.before = None;
                for index in 0..surfaces.len() {
                    self.note(scene, index, surfaces);
                    if let (Bug::Initial(depth), Some(encoding)) =
                        (self.bug, encoding(scene, index))
                    {
                        let initial = code(encoding, depth);
                        self.maps[index].ranges.fill([initial; 2]);
                    }
                }
                self.initial = self.maps.clone();
            }
            Moment::Begin { pass } => {
                if matches!(self.bug, Bug::Forgets) && pass > 0 {
                    self.maps.clone_from(&self.initial);
                }
            }
            Moment::Draw { pass, draw } => {
                let pass = &scene.passes[pass];
                self.reject(scene, pass, &pass.draws[draw], surfaces);
            }
            Moment::Drawn { pass, draw } => {
                for (index, kept) in self.kept.drain(..) {
                    for area in &self.rejected {
                        copy(&kept, &mut surfaces[index], *area);
                    }
                }
                self.rejected.clear();
                self.drawn(scene, pass, &scene.passes[pass].draws[draw], surfaces);
            }
            Moment::Loaded { pass } => {
                let index = scene.passes[pass].depth_stencil;
                let clears = scene.passes[pass].cleared();
                let cleared = index.filter(|i| clears.contains(&(*i, Aspect::Depth)));
                if let Some(index) = cleared.filter(|_| !matches!(self.bug, Bug::LoadMissed)) {
                    self.note(scene, index, surfaces);
                }
            }
            Moment::Cleared { pass, clear } => {
                let index = scene.passes[pass].depth_stencil;
                if let Some(index) = index.filter(|_| reaches(&clear, Aspect::Depth)) {
                    self.note(scene, index, surfaces);
                }
            }
            Moment::End { .. } => {}
        }
    }

    /// Notes the depths of an attachment.
    fn note(&mut self, scene: &Scene, index: usize, surfaces: &[Surface]) {
        if encoding(scene, index).is_none() {
            return;
        }
        let (surface, side) = (&surfaces[index], self.side);
        let columns = surface.width.div_ceil(side);
        let old = std::mem::take(&mut self.maps[index]);
        let mut map = Map {
            columns,
            ranges: Vec::new(),
        };
        for y in (0..surface.height).step_by(side) {
            for x in (0..surface.width).step_by(side) {
                let partial = x + side > surface.width || y + side > surface.height;
                let known = old.ranges.get(map.ranges.len()).copied();
                map.ranges.push(match known {
                    Some(known) if partial && matches!(self.bug, Bug::Partial) => known,
                    _ => range(surface, [x, y, x + side, y + side]),
                });
            }
        }
        self.maps[index] = map;
    }

    /// Returns the tiles that a draw touches, with the least and the greatest code of its depths there;
    /// nothing if a vertex is not in front.
    fn touched(&self, scene: &Scene, index: usize, draw: &Draw) -> Vec<(usize, [u32; 2])> {
        let Some(encoding) = encoding(scene, index) else {
            return Vec::new();
        };
        let columns = self.maps[index].columns;
        let rows = self.maps[index].ranges.len() / columns.max(1);
        let mut found: Vec<Option<[u32; 2]>> = vec![None; columns * rows];
        let [near, far] = draw.viewport.depth;
        let (near, far) = (near.min(far), near.max(far));
        let position = |v: &Vertex| {
            window_position(&mut Plain::<1>, v.position, &draw.viewport).map(|[value]| value)
        };
        let vertices: Vec<[f32; 3]> = draw.mesh.vertices.iter().map(position).collect();
        if draw.mesh.vertices.iter().any(|v| v.position[3] <= 0.0) {
            return Vec::new();
        }
        for primitive in draw.mesh.primitives(draw.topology) {
            let corners: Vec<usize> = match primitive {
                PrimitiveVertices::Point(vertex) => vec![vertex],
                PrimitiveVertices::Line(ends) => ends.to_vec(),
                PrimitiveVertices::Triangle(corners) => corners.to_vec(),
            };
            let ends = |axis: usize| {
                let values = corners.iter().map(|i| vertices[*i][axis]);
                values.fold([f32::MAX, f32::MIN], |[low, high], v| {
                    [low.min(v), high.max(v)]
                })
            };
            let tiles = |axis: usize, most: usize| {
                let [low, high] = ends(axis);
                let tile = |v: f32| (v.max(0.0) as usize) / self.side;
                tile(low - 1.0)..=tile(high + 1.0).min(most.saturating_sub(1))
            };
            let codes = ends(2).map(|z| code(encoding, z.clamp(near, far).clamp(0.0, 1.0) + 0.0));
            for row in tiles(1, rows) {
                for column in tiles(0, columns) {
                    let tile = &mut found[row * columns + column];
                    let [low, high] = tile.unwrap_or(codes);
                    *tile = Some([low.min(codes[0]), high.max(codes[1])]);
                }
            }
        }
        let tiles = found.into_iter().enumerate();
        tiles
            .filter_map(|(tile, range)| Some((tile, range?)))
            .collect()
    }

    /// Finds the tiles in which a draw is rejected.
    fn reject(&mut self, scene: &Scene, pass: &Pass, draw: &Draw, surfaces: &[Surface]) {
        let Some(index) = pass.depth_stencil else {
            return;
        };
        let before = std::mem::replace(&mut self.before, draw.depth);
        let Some(mut depth) = draw.depth else { return };
        if let Bug::TestedAs(change) = self.bug {
            depth.compare = change(before, depth.compare);
        }
        let trusted = matches!(self.bug, Bug::VertexDepth) && draw.shader.writes_depth();
        let moves = draw.shader.writes_depth() || draw.depth_bias != DepthBias::default();
        let lost = matches!(self.bug, Bug::StencilLost);
        let faces = draw.stencil.iter().flat_map(|s| [s.front, s.back]);
        let acts = !lost && faces.into_iter().any(|face| !keeps(&face));
        if moves && !trusted || acts || draw.shader.counts_runs() {
            return;
        }
        let map = self.maps.get(index);
        let Some(map) = map else { return };
        let columns = self.maps[index].columns.max(1);
        for (tile, codes) in self.touched(scene, index, draw) {
            let known = match self.bug {
                Bug::Wraps(n) => tile / columns * columns + tile % columns % n,
                _ => tile,
            };
            let Some(range) = map.ranges.get(known) else {
                continue;
            };
            let wrongly = matches!(self.bug, Bug::Rejects(compare, of) if compare == depth.compare && of(codes, *range));
            if wrongly || rejects(depth.compare, codes, *range) {
                let (x, y) = (tile % columns * self.side, tile / columns * self.side);
                self.rejected.push([x, y, x + self.side, y + self.side]);
            }
        }
        if !self.rejected.is_empty() {
            let attachments = pass.color.iter().chain(&pass.depth_stencil);
            self.kept = attachments.map(|i| (*i, surfaces[*i].clone())).collect();
        }
    }

    /// Notes what a draw wrote.
    fn drawn(&mut self, scene: &Scene, number: usize, draw: &Draw, surfaces: &[Surface]) {
        let pass = &scene.passes[number];
        let Some(index) = pass.depth_stencil else {
            return;
        };
        if matches!(self.bug, Bug::Missed(of) if of(number, draw)) {
            return;
        }
        let Some(depth) = draw.depth else { return };
        if depth.write {
            self.note(scene, index, surfaces);
        }
        if !matches!(self.bug, Bug::Overrated(of) if of(draw)) {
            return;
        }
        for (tile, [lo, hi]) in self.touched(scene, index, draw) {
            let [min, max] = &mut self.maps[index].ranges[tile];
            match depth.compare {
                CompareFunction::Less | CompareFunction::LessEqual => {
                    (*min, *max) = (lo.min(*min), hi.min(*max));
                }
                CompareFunction::Greater | CompareFunction::GreaterEqual => {
                    (*min, *max) = (lo.max(*min), hi.max(*max));
                }
                CompareFunction::Always => (*min, *max) = (lo, hi),
                _ => {}
            }
        }
    }
}

fn plant(side: usize, bug: Bug) -> Plant {
    memory(move || {
        let mut coarse = Coarse::new(side, bug);
        Memory::new(move |moment, scene, stored| coarse.reached(moment, scene, stored))
    })
}

/// The side of a tile, where a bug is not one of a certain side.
const SIDE: usize = 8;

/// True of the draws that a bug strikes, given the number of the pass.
type Strikes = fn(usize, &Draw) -> bool;

fn compares(draw: &Draw, functions: &[CompareFunction]) -> bool {
    draw.depth.is_some_and(|d| functions.contains(&d.compare))
}

pub(super) fn add(list: &mut List) {
    use CompareFunction::{Always, Equal, Greater, GreaterEqual, Less, LessEqual};
    list.class("hierarchy", "size");
    let shader_depth: Strikes = |_, draw| draw.shader.writes_depth();
    let always: Strikes = |_, draw| compares(draw, &[Always]);
    let missed: [(&str, &str, Strikes); 7] = [
        ("shader-depth", "depths that shaders write", shader_depth),
        ("always", "draws that always pass", always),
        ("greater", "draws with greater", |_, draw| {
            compares(draw, &[Greater, GreaterEqual])
        }),
        ("less", "draws with less", |_, draw| {
            compares(draw, &[Less, LessEqual])
        }),
        ("stencil", "draws with stencil", |_, draw| {
            draw.stencil.is_some()
        }),
        ("later-passes", "later passes", |pass, _| pass > 0),
        ("points", "points and lines", |_, draw| {
            use PrimitiveTopology::{LineList, LineStrip, PointList};
            [PointList, LineList, LineStrip].contains(&draw.topology)
        }),
    ];
    for (name, what, strikes) in missed {
        list.bug(format!(
            "{name}-missed: The coarse depth misses what is written by {what}."
        ))
        .plant(plant(SIDE, Bug::Missed(strikes)));
    }
    for side in [16, 32, 64] {
        for (name, what, strikes) in &missed[..2] {
            list.bug(format!(
                "{name}-missed-in-tiles-of-{side}: A coarse depth of {side}×{side} misses {what}."
            ))
            .plant(plant(side, Bug::Missed(*strikes)));
        }
    }
    type Overrated = fn(&Draw) -> bool;
    let overrated: [(&str, &str, Overrated); 4] = [
        ("write-off", "writes no depth", |d| {
            d.depth.is_some_and(|depth| !depth.write)
        }),
        ("discard", "discards", |d| d.shader.discards()),
        ("partly-covered", "covers a part of a tile", |d| {
            d.depth.is_some_and(|depth| depth.write) && d.scissor.is_none()
        }),
        ("stencil", "has a stencil test", |d| d.stencil.is_some()),
    ];
    for (name, what, strikes) in overrated {
        list.bug(format!(
            "{name}-noted-as-written: A draw that {what} counts as writing every texel it touches."
        ))
        .plant(plant(SIDE, Bug::Overrated(strikes)));
    }
    let mut add = |text: &str, bug| list.bug(text).plant(plant(SIDE, bug));
    add(
        "compare-kept: The coarse depth is tested with the comparison of the draw before.",
        Bug::TestedAs(|before, compare| before.map_or(compare, |before| before.compare)),
    );
    add(
        "first-direction-kept: The coarse depth is tested with less behind a draw with less.",
        Bug::TestedAs(|before, compare| match before {
            Some(before) if before.compare == Less => Less,
            _ => compare,
        }),
    );
    add(
        "shader-depth-ignored: Draws whose shader writes depth are rejected by that of their vertices.",
        Bug::VertexDepth,
    );
    add(
        "greatest-used-for-greater: Greater is tested against the greatest depth of a tile.",
        Bug::Rejects(Greater, |[_, hi], [_, max]| hi <= max),
    );
    add(
        "least-used-for-less: Less is tested against the least depth of a tile.",
        Bug::Rejects(Less, |[lo, _], [min, _]| lo >= min),
    );
    add(
        "less-equal-bound-rejected: Less-equal rejects what is equal to the greatest depth.",
        Bug::Rejects(LessEqual, |[lo, _], [_, max]| lo >= max),
    );
    add(
        "greater-equal-bound-rejected: Greater-equal rejects what is equal to the least depth.",
        Bug::Rejects(GreaterEqual, |[_, hi], [min, _]| hi <= min),
    );
    add(
        "equal-bound-rejected: Equal rejects a draw that meets a tile's depths at one end only.",
        Bug::Rejects(Equal, |[lo, hi], [min, max]| lo >= max || hi <= min),
    );
    add(
        "clear-missed-after-0: The coarse depth misses the first clear and holds 0.",
        Bug::Initial(0.0),
    );
    add(
        "clear-missed-after-1: The coarse depth misses the first clear and holds 1.",
        Bug::Initial(1.0),
    );
    add(
        "reset-between-passes: In the next pass, the coarse depth is that of the clear.",
        Bug::Forgets,
    );
    for n in [4, 8, 16] {
        let text =
            format!("columns-wrap-at-{n}: A row of coarse depths begins anew after {n} tiles.");
        add(&text, Bug::Wraps(n));
    }
    add(
        "load-missed: The coarse depth misses the clear of a load operation.",
        Bug::LoadMissed,
    );
    add(
        "edge-missed: Tiles that extend beyond the attachment keep the coarse depth of the clear.",
        Bug::Partial,
    );
    add(
        "stencil-lost: Where tiles are rejected, fragments that fail the depth test leave stencil.",
        Bug::StencilLost,
    );
}

#[cfg(test)]
pub(super) fn faithful(side: usize) -> Plant {
    plant(side, Bug::Faithful)
}
