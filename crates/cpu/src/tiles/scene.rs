//! A scene that is drawn in tiles.

use super::TILE;
use super::image::{AREA, Image};
use super::layout::Layout;
use super::plan::{PassPlan, Plan};
use super::setup::{Input, Part, place};
use super::threads::{available, on_threads};
use super::tile::{self, Layer, Tile};
use super::triangle::Placed;
use crate::pass::DISCARDED;
use crate::prepared::frame;
use crate::steps::{Faithful, Steps};
use crate::surface::depth_encoding;
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::{Aspect, ChannelEncoding, Frame};
use etalon_scene::{LoadOperation, Pass, Scene};
use fearless_simd::{Level, dispatch};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The smallest number of vertices or primitives that threads share.
const SHARED: usize = 4096;

/// The smallest number of draws whose triangles threads share.
const DRAWS: usize = 64;

/// The vector instructions and the threads that kernels use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Machine {
    pub(crate) level: Level,
    pub(crate) threads: usize,
}

impl Machine {
    /// Returns all vector instructions and threads of this machine.
    pub(crate) fn whole() -> Self {
        Self {
            level: Level::new(),
            threads: available(),
        }
    }
}

/// A scene with its kernels and its memory.
#[derive(Debug)]
pub(crate) struct TiledScene {
    scene: Scene,
    plan: Plan,
    machine: Machine,
    images: Vec<Image>,
    placed: Vec<Placed>,
    parts: Vec<Part>,
    submitted: bool,
}

impl TiledScene {
    /// Returns a scene with its kernels.
    pub(crate) fn new(scene: Scene, plan: Plan, machine: Machine) -> Self {
        Self {
            images: scene.attachments.iter().map(Image::new).collect(),
            parts: (0..machine.threads).map(|_| Part::default()).collect(),
            placed: Vec::new(),
            submitted: false,
            scene,
            plan,
            machine,
        }
    }

    /// Performs the clears of load operations.
    fn load(&mut self, pass: usize) {
        let pass = &self.scene.passes[pass];
        for (location, index) in pass.color.iter().enumerate() {
            if let LoadOperation::Clear(value) = pass.color_operations(location).load {
                let encodings = self.scene.attachments[*index].format.color_channels();
                let code = |c: usize| Faithful.clear_code(encodings[c], value[c]);
                let image = &mut self.images[*index];
                image.clear.color = Some(image.layout.texel(code));
            }
        }
        let Some(index) = pass.depth_stencil else {
            return;
        };
        let format = self.scene.attachments[index].format;
        if let LoadOperation::Clear(value) = pass.operations.depth.load
            && let Some(encoding) = depth_encoding(format)
        {
            self.images[index].clear.depth = Some(Faithful.clear_code(encoding, value));
        }
        if let LoadOperation::Clear(value) = pass.operations.stencil.load
            && format.has_stencil()
        {
            self.images[index].clear.stencil = Some(value);
        }
    }

    /// Replaces the contents that store operations discard.
    fn discard(&mut self, pass: usize) {
        for (index, aspect) in self.scene.passes[pass].discarded() {
            let format = self.scene.attachments[index].format;
            let code = |encoding: ChannelEncoding| encoding.nearest_code(DISCARDED);
            let Image { clear, layout, .. } = &mut self.images[index];
            let encodings = format.color_channels();
            match aspect {
                Aspect::Color => clear.color = Some(layout.texel(|c| code(encodings[c]))),
                Aspect::Depth => clear.depth = depth_encoding(format).map(code),
                Aspect::Stencil => clear.stencil = format.has_stencil().then_some(0x99),
            }
        }
    }

    /// Draws a pass and resolves it.
    fn pass(&mut self, number: usize) {
        let plan = &self.plan.passes[number];
        let pass = &self.scene.passes[number];
        let mut take = |i: usize| (i, std::mem::take(&mut self.images[i].color));
        let color = plan.color.map(&mut take);
        let resolved = plan.resolve.as_ref().map(|(i, _)| take(*i));
        let mut others: Vec<_> = plan.others.iter().map(|o| take(o.index)).collect();
        let depth_stencil = plan.depth_stencil.map(|i| {
            let image = &mut self.images[i];
            let (depth, stencil) = (&mut image.depth, &mut image.stencil);
            (i, std::mem::take(depth), std::mem::take(stencil))
        });
        let (mut color, mut resolved, mut depth_stencil) = (color, resolved, depth_stencil);
        {
            let inputs = inputs(pass, plan, &self.images);
            transform(self.machine, &inputs, &mut self.placed);
            let parts = set_up(self.machine, plan, &inputs, &self.placed, &mut self.parts);
            let cleared = |i: Option<usize>| i.map(|i| self.images[i].clear).unwrap_or_default();
            let [across, down] = plan.size.map(|s| s.div_ceil(TILE));
            let samples = plan.positions.len();
            let (depths, stencils) = match &mut depth_stencil {
                Some((_, depth, stencil)) => (depth.as_mut_slice(), stencil.as_mut_slice()),
                None => (&mut [][..], &mut [][..]),
            };
            let words = Layout::new(plan.channels).words;
            let mut colors = chunks(color.as_mut().map(|c| c.1.as_mut_slice()), samples * words);
            let mut targets = chunks(resolved.as_mut().map(|c| c.1.as_mut_slice()), words);
            let mut others: Vec<_> = others
                .iter_mut()
                .map(|(i, memory)| {
                    let words = self.images[*i].layout.words;
                    let planes = chunks(Some(memory), samples * words);
                    (planes, words, self.images[*i].clear.color)
                })
                .collect();
            let mut depths = chunks(Some(depths), samples);
            let mut stencils = chunks(Some(stencils), samples);
            let (clear, depth_clear) = (cleared(plan.color), cleared(plan.depth_stencil));
            let tiles: Vec<Tile<'_>> = (0..across * down)
                .map(|i| Tile {
                    at: [i % across, i / across],
                    color: Layer {
                        planes: colors.next().unwrap_or_default(),
                        words,
                        clear: clear.color,
                    },
                    others: others
                        .iter_mut()
                        .map(|(planes, words, clear)| Layer {
                            planes: planes.next().unwrap_or_default(),
                            words: *words,
                            clear: *clear,
                        })
                        .collect(),
                    resolved: targets.next().unwrap_or_default(),
                    depth: Layer {
                        planes: depths.next().unwrap_or_default(),
                        words: 1,
                        clear: depth_clear.depth.map(|v| [v; 4]),
                    },
                    stencil: Layer {
                        planes: stencils.next().unwrap_or_default(),
                        words: 1,
                        clear: depth_clear.stencil.map(|v| [v; 4]),
                    },
                })
                .collect();
            draw_tiles(self.machine, plan, &inputs, parts, tiles);
        }
        for (i, memory) in color.into_iter().chain(resolved).chain(others) {
            self.images[i].color = memory;
            self.images[i].clear.color = None;
        }
        if let Some((i, depth, stencil)) = depth_stencil {
            let image = &mut self.images[i];
            (image.depth, image.stencil) = (depth, stencil);
            (image.clear.depth, image.clear.stencil) = (None, None);
        }
    }
}

/// Returns an aspect's memory tile by tile, with this many planes per tile.
fn chunks<T>(memory: Option<&mut [T]>, planes: usize) -> std::slice::ChunksExactMut<'_, T> {
    memory
        .unwrap_or_default()
        .chunks_exact_mut(planes.max(1) * AREA)
}

/// Returns the vertices and primitives of the pass's draws.
fn inputs<'a>(pass: &'a Pass, plan: &'a PassPlan, images: &'a [Image]) -> Vec<Input<'a>> {
    let (mut base, mut first) = (0, 0);
    let mut inputs = Vec::with_capacity(plan.draws.len());
    for draw_plan in &plan.draws {
        let draw = &pass.draws[draw_plan.index];
        let input = Input::new(draw, draw_plan, images, base, first);
        base += draw.mesh.vertices.len();
        first += input.count;
        inputs.push(input);
    }
    inputs
}

/// Transforms the vertices of a pass.
fn transform(machine: Machine, inputs: &[Input<'_>], placed: &mut Vec<Placed>) {
    let end = inputs
        .last()
        .map_or(0, |i| i.base + i.draw.mesh.vertices.len());
    placed.clear();
    placed.resize(end, Placed::default());
    let mut rest = placed.as_mut_slice();
    for input in inputs {
        let vertices = &input.draw.mesh.vertices;
        let (slots, others) = rest.split_at_mut(vertices.len());
        rest = others;
        let each = if vertices.len() < SHARED {
            vertices.len().max(1)
        } else {
            vertices.len().div_ceil(machine.threads)
        };
        let jobs: Vec<_> = vertices.chunks(each).zip(slots.chunks_mut(each)).collect();
        on_threads(jobs, &|(vertices, placed)| {
            dispatch!(machine.level, _ => place(input.draw, vertices, placed));
        });
    }
}

/// Sets up the triangles of a pass. Returns the parts that are used, in drawing order.
fn set_up<'p>(
    machine: Machine,
    pass: &PassPlan,
    inputs: &[Input<'_>],
    placed: &[Placed],
    parts: &'p mut [Part],
) -> &'p [Part] {
    let tiles = pass.size.map(|s| s.div_ceil(TILE)).iter().product();
    let count = inputs.last().map_or(0, |i| i.first + i.count);
    // A draw costs more than a triangle, since its functions of codes are made.
    let shared = count >= SHARED || inputs.len() >= DRAWS;
    let used = if shared { parts.len() } else { 1 };
    let each = count.div_ceil(used);
    let jobs: Vec<_> = parts[..used].iter_mut().enumerate().collect();
    on_threads(jobs, &|(number, part)| {
        part.clear(tiles);
        let range = (number * each).min(count)..((number + 1) * each).min(count);
        dispatch!(machine.level, simd => part.set_up(simd, pass, inputs, placed, range));
    });
    &parts[..used]
}

/// Draws tiles. Each thread takes the next tile when it is free.
fn draw_tiles(
    machine: Machine,
    pass: &PassPlan,
    inputs: &[Input<'_>],
    parts: &[Part],
    tiles: Vec<Tile<'_>>,
) {
    let threads = machine.threads.min(tiles.len()).max(1);
    let queue = Mutex::new(tiles.into_iter());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    on_threads((0..threads).collect(), &|_: usize| {
        while let Some(tile) = next() {
            dispatch!(machine.level, simd => tile::draw(simd, tile, pass, inputs, parts));
        }
    });
}

impl Prepared for TiledScene {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let start = Instant::now();
        for (image, attachment) in self.images.iter_mut().zip(&self.scene.attachments) {
            image.begin(attachment);
        }
        for pass in 0..self.scene.passes.len() {
            self.load(pass);
            self.pass(pass);
            self.discard(pass);
        }
        self.images.iter_mut().for_each(Image::finish);
        self.submitted = true;
        let elapsed = start.elapsed();
        Ok(FrameTime {
            cpu: elapsed,
            gpu: None,
            wall: elapsed,
        })
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        let codes = |index: usize, aspect, channels| {
            self.images[index].codes(aspect, channels, self.machine.threads)
        };
        let mut frame = frame(&self.scene, self.submitted, codes)?;
        // No draw with kernels has counters.
        frame.counters = vec![0; self.scene.counters.len()];
        Ok(frame)
    }
}
