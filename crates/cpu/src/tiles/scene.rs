//! A scene that is drawn in tiles.

use super::TILE;
use super::image::TiledImage;
use super::layer::{Layer, Tiles};
use super::plan::{KernelPlan, PassKernels};
use super::setup::{DrawGeometry, RangeTriangles, place};
use super::threads::{available, on_threads};
use super::tile::{self, Tile};
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

/// The smallest number of bytes that several threads clear: waking them takes as long as clearing fewer.
const CLEARED: usize = 1 << 22;

/// The vector instructions and the threads that kernels use.
#[derive(Clone, Copy, Debug)]
pub struct KernelMachine {
    /// The vector instructions.
    pub level: Level,
    /// The number of threads, at least 1.
    pub threads: usize,
}

impl KernelMachine {
    /// Returns all vector instructions and threads of this machine.
    pub fn whole() -> Self {
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
    plan: KernelPlan,
    machine: KernelMachine,
    images: Vec<TiledImage>,
    placed: Vec<Placed>,
    parts: Vec<RangeTriangles>,
    submitted: bool,
}

impl TiledScene {
    /// Returns a scene with its kernels.
    pub(crate) fn new(scene: Scene, plan: KernelPlan, machine: KernelMachine) -> Self {
        Self {
            images: scene.attachments.iter().map(TiledImage::new).collect(),
            parts: (0..machine.threads)
                .map(|_| RangeTriangles::default())
                .collect(),
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
                image.color.clear(image.layout.texel(code));
            }
        }
        let Some(index) = pass.depth_stencil else {
            return;
        };
        if let LoadOperation::Clear(value) = pass.operations.depth.load
            && let Some(encoding) = depth_encoding(self.scene.attachments[index].format)
        {
            let code = Faithful.clear_code(encoding, value);
            self.images[index].depth.clear([code; 4]);
        }
        if let LoadOperation::Clear(value) = pass.operations.stencil.load {
            self.images[index].stencil.clear([value; 4]);
        }
    }

    /// Replaces the contents that store operations discard.
    fn discard(&mut self, pass: usize) {
        for (index, aspect) in self.scene.passes[pass].discarded() {
            let format = self.scene.attachments[index].format;
            let code = |encoding: ChannelEncoding| encoding.nearest_code(DISCARDED);
            let image = &mut self.images[index];
            let encodings = format.color_channels();
            match aspect {
                Aspect::Color => {
                    let texel = image.layout.texel(|c| code(encodings[c]));
                    image.color.clear(texel);
                }
                Aspect::Depth => {
                    let code = depth_encoding(format).map(code);
                    image.depth.clear([code.unwrap_or_default(); 4]);
                }
                Aspect::Stencil => image.stencil.clear([0x99; 4]),
            }
        }
    }

    /// Writes the clear values of tiles that were not drawn to.
    fn write_clears(&mut self) {
        let (mut words, mut bytes) = (Vec::new(), Vec::new());
        for image in &mut self.images {
            words.extend(image.color.layers().chain(image.depth.layers()));
            bytes.extend(image.stencil.layers());
        }
        write_clears(self.machine, words);
        write_clears(self.machine, bytes);
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
            let [across, down] = plan.size.map(|s| s.div_ceil(TILE));
            let mut colors = layers(color.as_mut().map(|(_, tiles)| tiles));
            let mut others: Vec<_> = others.iter_mut().map(|(_, tiles)| tiles.layers()).collect();
            let mut targets = layers(resolved.as_mut().map(|(_, tiles)| {
                tiles.overwrite();
                tiles
            }));
            let (depths, stencils) = match &mut depth_stencil {
                Some((_, depth, stencil)) => (Some(depth), Some(stencil)),
                None => (None, None),
            };
            let (mut depths, mut stencils) = (layers(depths), layers(stencils));
            let tiles = (0..across * down).map(|i| {
                let tile = Tile {
                    at: [i % across, i / across],
                    color: colors.next().unwrap_or_default(),
                    others: others.iter_mut().filter_map(Iterator::next).collect(),
                    resolved: targets.next().unwrap_or_default().planes,
                    depth: depths.next().unwrap_or_default(),
                    stencil: stencils.next().unwrap_or_default(),
                };
                (i, tile)
            });
            let is_changed = |i: usize| {
                plan.resolve.is_some() || parts.iter().any(|part| !part.bins[i].is_empty())
            };
            let tiles = tiles.filter_map(|(i, tile)| is_changed(i).then_some(tile));
            let tiles: Vec<Tile<'_>> = tiles.collect();
            draw_tiles(self.machine, plan, &inputs, parts, tiles);
        }
        for (i, memory) in color.into_iter().chain(resolved).chain(others) {
            self.images[i].color = memory;
        }
        if let Some((i, depth, stencil)) = depth_stencil {
            let image = &mut self.images[i];
            (image.depth, image.stencil) = (depth, stencil);
        }
    }
}

/// Returns the layers of an aspect's tiles, if there is the aspect.
fn layers<T: Copy + Default>(tiles: Option<&mut Tiles<T>>) -> impl Iterator<Item = Layer<'_, T>> {
    tiles.into_iter().flat_map(Tiles::layers)
}

/// Writes the clear values of layers that are not in memory.
fn write_clears<T: Copy + Send>(machine: KernelMachine, mut layers: Vec<Layer<'_, T>>) {
    layers.retain(|layer| layer.cleared().is_some());
    let bytes: usize = layers.iter().map(|layer| size_of_val(layer.planes)).sum();
    let threads = if bytes < CLEARED { 1 } else { machine.threads };
    let each = layers.len().div_ceil(threads).max(1);
    on_threads(
        layers.chunks_mut(each).collect(),
        &|part: &mut [Layer<'_, T>]| {
            part.iter_mut().for_each(|layer| layer.touch(false));
        },
    );
}

/// Returns the vertices and primitives of the pass's draws.
fn inputs<'a>(
    pass: &'a Pass,
    plan: &'a PassKernels,
    images: &'a [TiledImage],
) -> Vec<DrawGeometry<'a>> {
    let (mut base, mut first) = (0, 0);
    let mut inputs = Vec::with_capacity(plan.draws.len());
    for draw_plan in &plan.draws {
        let draw = &pass.draws[draw_plan.index];
        let input = DrawGeometry::new(draw, draw_plan, images, base, first);
        base += draw.mesh.vertices.len();
        first += input.count;
        inputs.push(input);
    }
    inputs
}

/// Transforms the vertices of a pass.
fn transform(machine: KernelMachine, inputs: &[DrawGeometry<'_>], placed: &mut Vec<Placed>) {
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
    machine: KernelMachine,
    pass: &PassKernels,
    inputs: &[DrawGeometry<'_>],
    placed: &[Placed],
    parts: &'p mut [RangeTriangles],
) -> &'p [RangeTriangles] {
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
    machine: KernelMachine,
    pass: &PassKernels,
    inputs: &[DrawGeometry<'_>],
    parts: &[RangeTriangles],
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
        self.write_clears();
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
            let KernelMachine { level, threads } = self.machine;
            self.images[index].codes(aspect, channels, level, threads)
        };
        let mut frame = frame(&self.scene, self.submitted, codes)?;
        // No draw with kernels has counters.
        frame.counters = vec![0; self.scene.counters.len()];
        Ok(frame)
    }
}
