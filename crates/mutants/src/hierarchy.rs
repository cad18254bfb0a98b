//! Bugs of a coarse depth: a least and a greatest depth for each tile, by which whole tiles are rejected.
//!
//! The rasterizer has none, so these bugs bring one: without a bug it changes no frame, since it only
//! rejects tiles in which no fragment passes. Each bug makes it wrong in one way.

use super::hooks::code;
use super::list::{CONFUSION, List};
use super::memory::{Area, Memory, copy};
use super::plant::{Plant, memory};
use etalon_cpu::Surface;
use etalon_cpu::steps::{Moment, Stored};
use etalon_frame::{Aspect, ChannelEncoding};
use etalon_pipeline::{Plain, window_position};
use etalon_scene::{
    Clear, ClearTarget, CompareFunction, DepthBias, Draw, Pass, PrimitiveTopology,
    PrimitiveVertices, Scene, StencilFace, StencilOperation,
};

/// The bug of a coarse depth.
#[derive(Clone, Copy)]
enum Bug {
    /// None.
    #[cfg_attr(not(test), expect(dead_code, reason = "a test plants it"))]
    Faithful,
    /// What these draws write is not noted.
    Missed(fn(&Scene, usize, &Draw) -> bool),
    /// Of these draws, every fragment of every tile that they touch is noted as written.
    Overrated(fn(&Pass, &Draw) -> bool),
    /// A draw is tested as though it were another, given the draw before.
    TestedAs(fn(&Draw, &mut Draw)),
    /// These draws are tested by the depth of their vertices, which is not that of their fragments.
    Trusted(fn(&Draw) -> bool),
    /// A comparison with the least and the greatest depth rejects too much.
    Rejects(fn(CompareFunction, [u32; 2], [u32; 2]) -> bool),
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
    before: Option<Draw>,
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
                        let all = code(encoding, depth);
                        self.maps[index].ranges.fill([all; 2]);
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
                if let Some(index) = scene.passes[pass].depth_stencil {
                    self.cleared(scene, index, &clear, surfaces);
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
        let near = draw.viewport.depth[0].min(draw.viewport.depth[1]);
        let far = draw.viewport.depth[0].max(draw.viewport.depth[1]);
        let vertices: Vec<[f32; 3]> = draw
            .mesh
            .vertices
            .iter()
            .map(|v| {
                window_position(&mut Plain::<1>, v.position, &draw.viewport).map(|[value]| value)
            })
            .collect();
        if draw.mesh.vertices.iter().any(|v| v.position[3] <= 0.0) {
            return Vec::new();
        }
        for primitive in draw.mesh.primitives(draw.topology) {
            let at: Vec<usize> = match primitive {
                PrimitiveVertices::Point(at) => vec![at],
                PrimitiveVertices::Line(ends) => ends.to_vec(),
                PrimitiveVertices::Triangle(corners) => corners.to_vec(),
            };
            let ends = |axis: usize| {
                let all = at.iter().map(|i| vertices[*i][axis]);
                all.fold([f32::MAX, f32::MIN], |[low, high], v| {
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
        let all = found.into_iter().enumerate();
        all.filter_map(|(tile, range)| Some((tile, range?)))
            .collect()
    }

    /// Notes a clear command.
    fn cleared(&mut self, scene: &Scene, index: usize, clear: &Clear, surfaces: &[Surface]) {
        let ClearTarget::DepthStencil { depth, .. } = clear.target else {
            return;
        };
        if depth.is_some() {
            self.note(scene, index, surfaces);
        }
    }

    /// Finds the tiles in which a draw is rejected.
    fn reject(&mut self, scene: &Scene, pass: &Pass, asked: &Draw, surfaces: &[Surface]) {
        let Some(index) = pass.depth_stencil else {
            return;
        };
        let mut draw = asked.clone();
        if let (Bug::TestedAs(change), Some(before)) = (self.bug, &self.before) {
            change(before, &mut draw);
        }
        self.before = Some(asked.clone());
        let Some(depth) = draw.depth else { return };
        let trusted = matches!(self.bug, Bug::Trusted(of) if of(&draw));
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
        for (tile, codes) in self.touched(scene, index, &draw) {
            let known = match self.bug {
                Bug::Wraps(n) => tile / columns * columns + tile % columns % n,
                _ => tile,
            };
            let Some(range) = map.ranges.get(known) else {
                continue;
            };
            let wrongly = matches!(self.bug, Bug::Rejects(of) if of(depth.compare, codes, *range));
            if wrongly || rejects(depth.compare, codes, *range) {
                let (x, y) = (tile % columns * self.side, tile / columns * self.side);
                self.rejected.push([x, y, x + self.side, y + self.side]);
            }
        }
        if !self.rejected.is_empty() {
            let all = pass.color.iter().chain(&pass.depth_stencil);
            self.kept = all.map(|i| (*i, surfaces[*i].clone())).collect();
        }
    }

    /// Notes what a draw wrote.
    fn drawn(&mut self, scene: &Scene, number: usize, draw: &Draw, surfaces: &[Surface]) {
        let pass = &scene.passes[number];
        let Some(index) = pass.depth_stencil else {
            return;
        };
        if matches!(self.bug, Bug::Missed(of) if of(scene, number, draw)) {
            return;
        }
        if draw.depth.is_some_and(|d| d.write) {
            self.note(scene, index, surfaces);
        }
        let Bug::Overrated(of) = self.bug else { return };
        if !of(pass, draw) {
            return;
        }
        let Some(depth) = draw.depth else { return };
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

fn compares(draw: &Draw, functions: &[CompareFunction]) -> bool {
    draw.depth.is_some_and(|d| functions.contains(&d.compare))
}

pub(super) fn add(list: &mut List) {
    list.class("hierarchy", "size");
    missed(list);
    overrated(list);
    tested(list);
    kept(list);
}

fn missed(list: &mut List) {
    type Row = (&'static str, &'static str, fn(&Scene, usize, &Draw) -> bool);
    let rows: [Row; 6] = [
        ("shader-depth", "depths that shaders write", |_, _, d| {
            d.shader.writes_depth()
        }),
        ("always", "draws that always pass", |_, _, d| {
            compares(d, &[CompareFunction::Always])
        }),
        ("greater", "draws that compare with greater", |_, _, d| {
            let greater = [CompareFunction::Greater, CompareFunction::GreaterEqual];
            compares(d, &greater)
        }),
        ("less", "draws that compare with less", |_, _, d| {
            compares(d, &[CompareFunction::Less, CompareFunction::LessEqual])
        }),
        ("stencil", "draws with a stencil test", |_, _, d| {
            d.stencil.is_some()
        }),
        ("later-passes", "passes after the first", |_, pass, _| {
            pass > 0
        }),
    ];
    for (name, what, of) in rows {
        list.add(
            &format!("{name}-missed"),
            CONFUSION,
            format!("The coarse depth misses what is written by {what}."),
            plant(SIDE, Bug::Missed(of)),
        );
    }
    for side in [16, 32, 64] {
        list.add(
            &format!("shader-depth-missed-in-tiles-of-{side}"),
            CONFUSION,
            format!("A coarse depth of tiles of {side}×{side} misses depths that shaders write."),
            plant(side, Bug::Missed(|_, _, draw| draw.shader.writes_depth())),
        );
        list.add(
            &format!("always-missed-in-tiles-of-{side}"),
            CONFUSION,
            format!("A coarse depth of tiles of {side}×{side} misses draws that always pass."),
            plant(
                side,
                Bug::Missed(|_, _, draw| compares(draw, &[CompareFunction::Always])),
            ),
        );
    }
}

fn overrated(list: &mut List) {
    type Row = (&'static str, &'static str, fn(&Pass, &Draw) -> bool);
    let rows: [Row; 4] = [
        ("write-off", "a draw that writes no depth", |_, d| {
            d.depth.is_some_and(|depth| !depth.write)
        }),
        ("discard", "a draw whose shader discards", |_, d| {
            d.shader.discards()
        }),
        (
            "partly-covered",
            "a draw that covers a part of a tile",
            |_, d| d.depth.is_some_and(|depth| depth.write) && d.scissor.is_none(),
        ),
        ("stencil", "a draw whose stencil test may fail", |_, d| {
            d.stencil.is_some()
        }),
    ];
    for (name, what, of) in rows {
        list.add(
            &format!("{name}-noted-as-written"),
            CONFUSION,
            format!("The coarse depth counts every texel that {what} touches as written."),
            plant(SIDE, Bug::Overrated(of)),
        );
    }
}

fn tested(list: &mut List) {
    type Test = (&'static str, &'static str, fn(&Draw, &mut Draw));
    let tests: [Test; 2] = [
        (
            "compare-kept",
            "The coarse depth is tested with the comparison of the draw before.",
            |before, draw| {
                if let (Some(depth), Some(before)) = (&mut draw.depth, before.depth) {
                    depth.compare = before.compare;
                }
            },
        ),
        (
            "first-direction-kept",
            "The coarse depth is tested with less where the draw before compared with less.",
            |before, draw| {
                if let Some(depth) = &mut draw.depth
                    && compares(before, &[CompareFunction::Less])
                {
                    depth.compare = CompareFunction::Less;
                }
            },
        ),
    ];
    for (name, about, change) in tests {
        list.add(name, CONFUSION, about, plant(SIDE, Bug::TestedAs(change)));
    }
    list.add(
        "shader-depth-ignored",
        CONFUSION,
        "Draws whose shader writes depth are rejected by the depth of their vertices.",
        plant(SIDE, Bug::Trusted(|draw| draw.shader.writes_depth())),
    );
    type Reject = (
        &'static str,
        &'static str,
        fn(CompareFunction, [u32; 2], [u32; 2]) -> bool,
    );
    let rejects: [Reject; 5] = [
        (
            "greatest-used-for-greater",
            "Greater is tested against the greatest depth of a tile.",
            |compare, [_, hi], [_, max]| compare == CompareFunction::Greater && hi <= max,
        ),
        (
            "least-used-for-less",
            "Less is tested against the least depth of a tile.",
            |compare, [lo, _], [min, _]| compare == CompareFunction::Less && lo >= min,
        ),
        (
            "less-equal-bound-rejected",
            "Less-equal rejects a draw whose least depth is a tile's greatest.",
            |compare, [lo, _], [_, max]| compare == CompareFunction::LessEqual && lo >= max,
        ),
        (
            "greater-equal-bound-rejected",
            "Greater-equal rejects a draw whose greatest depth is a tile's least.",
            |compare, [_, hi], [min, _]| compare == CompareFunction::GreaterEqual && hi <= min,
        ),
        (
            "equal-bound-rejected",
            "Equal rejects a draw that meets a tile's depths at one end only.",
            |compare, [lo, hi], [min, max]| {
                compare == CompareFunction::Equal && (lo >= max || hi <= min)
            },
        ),
    ];
    for (name, about, of) in rejects {
        list.add(name, CONFUSION, about, plant(SIDE, Bug::Rejects(of)));
    }
}

fn kept(list: &mut List) {
    for (name, depth) in [("0", 0.0), ("1", 1.0)] {
        list.add(
            &format!("clear-missed-after-{name}"),
            CONFUSION,
            format!("The coarse depth misses the clear of an attachment and holds {name}."),
            plant(SIDE, Bug::Initial(depth)),
        );
    }
    list.add(
        "reset-between-passes",
        CONFUSION,
        "In the next pass, the coarse depth is that of the clear.",
        plant(SIDE, Bug::Forgets),
    );
    for n in [4, 8, 16] {
        list.add(
            &format!("columns-wrap-at-{n}"),
            CONFUSION,
            format!("A row of coarse depths has {n} tiles and begins anew after them."),
            plant(SIDE, Bug::Wraps(n)),
        );
    }
    let clears = [(
        "load-missed",
        "The coarse depth misses the clear of a load operation.",
        Bug::LoadMissed,
    )];
    for (name, about, bug) in clears {
        list.add(name, CONFUSION, about, plant(SIDE, bug));
    }
    list.add(
        "edge-missed",
        CONFUSION,
        "Tiles that extend beyond the attachment keep the coarse depth of the clear.",
        plant(SIDE, Bug::Partial),
    );
    list.add(
        "stencil-lost",
        CONFUSION,
        "In rejected tiles, stencil is not changed by fragments that fail the depth test.",
        plant(SIDE, Bug::StencilLost),
    );
    list.add(
        "points-missed",
        CONFUSION,
        "The coarse depth misses what is written by points and lines.",
        plant(
            SIDE,
            Bug::Missed(|_, _, draw| {
                matches!(
                    draw.topology,
                    PrimitiveTopology::PointList
                        | PrimitiveTopology::LineList
                        | PrimitiveTopology::LineStrip
                )
            }),
        ),
    );
}

#[cfg(test)]
pub(super) fn faithful(side: usize) -> Plant {
    plant(side, Bug::Faithful)
}
