//! A scene prepared for drawing.

use crate::attachment::DeviceAttachment;
use crate::binding::{Bound, Groups};
use crate::clock::Clock;
use crate::counting::{Counted, Counting};
use crate::format;
use crate::gpu::{BufferLease, Gpu};
use crate::limits::read_path;
use crate::path::{self, Reading};
use crate::pipeline::{DrawKey, INSTANCE_SLOT};
use crate::read::{self, Source};
use crate::state;
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_frame::{
    Frame, PathCommands, PathDraws, PathEnd, PathState, PathValue, ReadPath, Requirement,
    TextureFormat,
};
use etalon_scene::{Call, Draw, Pass, PassOperations, Pool, Scene, Viewport};
use std::ops::Range;
use std::time::Instant;
use wgpu::BufferUsages;
use wgpu::util::RenderEncoder;

/// A scene with all objects that drawing it needs.
pub(crate) struct PreparedScene<'a> {
    gpu: &'a Gpu,
    attachments: Vec<DeviceAttachment<'a>>,
    passes: Vec<PreparedPass>,
    /// The attachments that are read, and the way of each to the host.
    read: Vec<(usize, PathEnd)>,
    /// The passes of each command buffer.
    commands: Vec<Range<usize>>,
    state: PathState,
    vertices: Option<BufferLease<'a>>,
    indices: Option<BufferLease<'a>>,
    /// The arguments of indirect draws.
    arguments: Option<BufferLease<'a>>,
    counting: Counting<'a>,
    /// The scene's pool.
    pool: Option<(BufferLease<'a>, Pool)>,
    /// Kept alive for the bind groups.
    _params: Option<BufferLease<'a>>,
    submitted: bool,
}

struct PreparedPass {
    color: Vec<usize>,
    resolve: Vec<Option<usize>>,
    depth_stencil: Option<usize>,
    read_only: bool,
    operations: PassOperations,
    draws: Vec<PreparedDraw>,
    /// Draws with the same dynamic state, recorded before the pass.
    bundles: Vec<(Range<usize>, wgpu::RenderBundle)>,
}

struct PreparedDraw {
    pipeline: wgpu::RenderPipeline,
    /// A pipeline that is bound between the draw's state and its own.
    other: Option<wgpu::RenderPipeline>,
    bound: Option<Bound>,
    counted: Counted,
    viewport: Viewport,
    scissor: [u32; 4],
    blend_constant: wgpu::Color,
    stencil_reference: Option<u32>,
    /// The place of the vertices, in bytes.
    vertices: Range<u64>,
    /// The place of the colours of instances, in bytes.
    colors: Option<Range<u64>>,
    /// The place of the indices, in bytes, and their size.
    indices: Option<(Range<u64>, wgpu::IndexFormat)>,
    /// The drawn vertices, or indices of an indexed draw.
    drawn: Range<u32>,
    base_vertex: i32,
    instances: Range<u32>,
    /// The place of the arguments of an indirect draw.
    arguments: Option<u64>,
}

/// The contents of a scene's vertex and index buffers.
#[derive(Default)]
struct Geometry {
    vertices: Vec<u8>,
    indices: Vec<u8>,
    arguments: Vec<u8>,
}

/// Adds bytes, and zeroes up to the alignment of copies. Returns the place of the bytes.
fn append(buffer: &mut Vec<u8>, bytes: &[u8]) -> Range<u64> {
    let first = buffer.len() as u64;
    buffer.extend_from_slice(bytes);
    let place = first..buffer.len() as u64;
    let aligned = buffer
        .len()
        .next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT as usize);
    buffer.resize(aligned, 0);
    place
}

impl<'a> PreparedScene<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        if let Some(missing) = gpu.limits.missing(&scene.requirements()) {
            return Err(BackendError::NotSupported(missing));
        }
        let scene = scene.on_path();
        gpu.guard("preparing a scene", || Self::build(gpu, &scene))
    }

    fn build(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        let attachments = (0..scene.attachments.len())
            .map(|index| DeviceAttachment::new(gpu, scene, index))
            .collect::<Result<Vec<_>, _>>()?;
        gpu.errors.check("making attachments")?;
        let (counting, counted) = Counting::new(gpu, scene);
        gpu.errors.check("making counters")?;
        let mut counted = counted.into_iter();
        let pool = scene.pool.map(|pool| {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
            (gpu.buffer(usage, pool.bytes()), pool)
        });
        let bound = pool
            .as_ref()
            .map(|(buffer, pool)| (&**buffer, pool.bytes()));
        let mut groups = Groups::new(gpu, scene, &attachments, &counting, bound);
        let mut geometry = Geometry::default();
        let mut passes = Vec::new();
        for pass in &scene.passes {
            let draws = pass.draws.iter().zip(counted.by_ref());
            passes.push(PreparedPass {
                color: pass.color.clone(),
                resolve: pass.resolve.clone(),
                depth_stencil: pass.depth_stencil,
                read_only: pass.depth_stencil_read_only,
                operations: PassOperations {
                    color: (0..pass.color.len())
                        .map(|location| pass.color_operations(location))
                        .collect(),
                    ..pass.operations.clone()
                },
                draws: draws
                    .map(|(draw, counted)| {
                        let bound = groups.bind(draw, counted.runs)?;
                        PreparedDraw::new(gpu, scene, pass, draw, (bound, counted), &mut geometry)
                    })
                    .collect::<Result<_, _>>()?,
                bundles: Vec::new(),
            });
        }
        let filled = |usage, data: &[u8]| (!data.is_empty()).then(|| gpu.filled(usage, data));
        let params = groups.finish();
        let ends = scene.read.iter();
        let mut prepared = Self {
            gpu,
            attachments,
            passes,
            read: ends
                .map(|i| {
                    (
                        *i,
                        path::end(scene, *i, reading(gpu, scene.attachments[*i].format)),
                    )
                })
                .collect(),
            commands: path::commands(scene),
            state: scene.path.state,
            vertices: filled(BufferUsages::VERTEX, &geometry.vertices),
            indices: filled(BufferUsages::INDEX, &geometry.indices),
            arguments: filled(BufferUsages::INDIRECT, &geometry.arguments),
            _params: params,
            counting,
            pool,
            submitted: false,
        };
        if scene.path.commands == PathCommands::Secondary {
            prepared.bundle(scene)?;
        }
        Ok(prepared)
    }

    /// Records the draws of all passes as bundles, which set no dynamic state and no queries: a bundle holds
    /// draws that share theirs.
    fn bundle(&mut self, scene: &Scene) -> Result<(), BackendError> {
        for (number, pass) in scene.passes.iter().enumerate() {
            let known = |i: &usize| format::known(scene.attachments[*i].format);
            let colors = pass.color.iter().map(|i| known(i).map(Some));
            let colors = colors.collect::<Result<Vec<_>, _>>()?;
            let depth_stencil = pass.depth_stencil.as_ref().map(known).transpose()?;
            let descriptor = wgpu::RenderBundleEncoderDescriptor {
                label: None,
                color_formats: &colors,
                depth_stencil: depth_stencil.map(|format| wgpu::RenderBundleDepthStencil {
                    format,
                    depth_read_only: pass.depth_stencil_read_only,
                    stencil_read_only: pass.depth_stencil_read_only,
                }),
                sample_count: scene.pass_samples(pass),
                multiview: None,
            };
            let mut bundles = Vec::new();
            for run in runs(&self.passes[number].draws) {
                let mut encoder = self.gpu.device.create_render_bundle_encoder(&descriptor);
                for draw in &self.passes[number].draws[run.clone()] {
                    self.call(&mut encoder, draw);
                }
                bundles.push((run, encoder.finish(&Default::default())));
            }
            self.passes[number].bundles = bundles;
        }
        Ok(())
    }

    /// Records the initial contents and all passes.
    fn record(&self) -> Vec<wgpu::CommandBuffer> {
        let each = self.commands.iter().enumerate();
        each.map(|(number, passes)| self.record_passes(number, passes.clone()))
            .collect()
    }

    /// Records one command buffer.
    fn record_passes(&self, number: usize, passes: Range<usize>) -> wgpu::CommandBuffer {
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if number == 0 {
            for attachment in &self.attachments {
                attachment.initialise(&mut encoder, !self.submitted);
            }
            self.counting.start(&mut encoder);
            if let Some((buffer, pool)) = &self.pool {
                encoder.clear_buffer(buffer, 0, Some(pool.cleared_bytes()));
            }
        }
        for index in passes {
            self.record_pass(&mut encoder, index, &self.passes[index]);
        }
        if number + 1 == self.commands.len() {
            self.counting.finish(&mut encoder);
            if let Some(clock) = self.clock() {
                encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
                encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.mapped, 0, Clock::BYTES);
            }
        }
        encoder.finish()
    }

    fn record_pass(&self, encoder: &mut wgpu::CommandEncoder, index: usize, pass: &PreparedPass) {
        let colors: Vec<_> = pass
            .color
            .iter()
            .zip(&pass.resolve)
            .zip(&pass.operations.color)
            .map(|((color, resolve), operations)| {
                let resolve = resolve.map(|r| &self.attachments[r].target.view);
                Some(self.attachments[*color].as_color(Some(index), resolve, *operations))
            })
            .collect();
        let depth_stencil = pass.depth_stencil.map(|i| {
            let attachment = &self.attachments[i];
            if pass.read_only {
                attachment.as_read_only()
            } else {
                attachment.as_depth_stencil(Some(index), &pass.operations)
            }
        });
        let last = index + 1 == self.passes.len();
        let timestamps = self.clock().filter(|_| index == 0 || last);
        let mut encoder = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &colors,
            depth_stencil_attachment: depth_stencil,
            timestamp_writes: timestamps.map(|clock| wgpu::RenderPassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: (index == 0).then_some(0),
                end_of_pass_write_index: last.then_some(1),
            }),
            occlusion_query_set: self.counting.occlusion(),
            ..wgpu::RenderPassDescriptor::default()
        });
        if !pass.bundles.is_empty() {
            for (run, bundle) in &pass.bundles {
                let first = &pass.draws[run.start];
                self.counting.begin(&mut encoder, first.counted);
                first.set_state(&mut encoder);
                encoder.execute_bundles([bundle]);
                self.counting.end(&mut encoder, first.counted);
            }
            return;
        }
        for draw in &pass.draws {
            self.counting.begin(&mut encoder, draw.counted);
            if self.state == PathState::Overwritten {
                set_other_state(&mut encoder, draw);
            }
            draw.set_state(&mut encoder);
            self.call(&mut encoder, draw);
            self.counting.end(&mut encoder, draw.counted);
        }
    }

    /// Records a draw call with its pipeline and its inputs.
    fn call<'s>(&'s self, encoder: &mut impl RenderEncoder<'s>, draw: &'s PreparedDraw) {
        if let Some(other) = &draw.other {
            encoder.set_pipeline(other);
        }
        encoder.set_pipeline(&draw.pipeline);
        if let Some(bound) = &draw.bound {
            encoder.set_bind_group(0, Some(&bound.group), bound.offset.as_slice());
        }
        if let Some(vertices) = &self.vertices {
            encoder.set_vertex_buffer(0, Some(vertices.slice(draw.vertices.clone())));
            if let Some(colors) = draw.colors.clone() {
                encoder.set_vertex_buffer(INSTANCE_SLOT, Some(vertices.slice(colors)));
            }
        }
        let (drawn, instances) = (draw.drawn.clone(), draw.instances.clone());
        match (&draw.indices, &self.indices) {
            // All indices were restarts or incomplete primitives.
            (Some((place, _)), _) if place.is_empty() => {}
            (Some((place, format)), Some(indices)) => {
                encoder.set_index_buffer(indices.slice(place.clone()), *format);
                match (draw.arguments, &self.arguments) {
                    (Some(offset), Some(arguments)) => {
                        encoder.draw_indexed_indirect(arguments, offset)
                    }
                    _ => encoder.draw_indexed(drawn, draw.base_vertex, instances),
                }
            }
            (Some(_), None) => {}
            (None, _) => match (draw.arguments, &self.arguments) {
                (Some(offset), Some(arguments)) => encoder.draw_indirect(arguments, offset),
                _ => encoder.draw(drawn, instances),
            },
        }
    }

    /// Returns the clock, if there is a pass to write timestamps.
    fn clock(&self) -> Option<&'a Clock> {
        self.gpu.clock.as_ref().filter(|_| !self.passes.is_empty())
    }

    fn draw(&mut self) -> Result<FrameTime, BackendError> {
        let begin = Instant::now();
        let commands = self.record();
        let index = self.gpu.queue.submit(commands);
        let cpu = begin.elapsed();
        let clock = self.clock();
        if let Some(clock) = clock {
            clock
                .mapped
                .slice(..)
                .map_async(wgpu::MapMode::Read, |_| {});
        }
        self.gpu.wait(index)?;
        let wall = begin.elapsed();
        self.submitted = true;
        let gpu = clock.and_then(Clock::elapsed);
        Ok(FrameTime { cpu, gpu, wall })
    }
}

impl Prepared for PreparedScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let gpu = self.gpu;
        gpu.guard("drawing a scene", || self.draw())
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            return Err(BackendError::internal(
                "read back before anything was drawn",
            ));
        }
        let source = |(index, end): &(usize, PathEnd)| {
            let attachment = &self.attachments[*index];
            Source {
                name: &attachment.name,
                format: attachment.format,
                size: attachment.size,
                samples: attachment.samples,
                target: &attachment.target,
                end: *end,
            }
        };
        let sources: Vec<_> = self.read.iter().map(source).collect();
        self.gpu.guard("reading a frame back", || {
            read::frame(self.gpu, &sources, &self.counting)
        })
    }
}

impl PreparedDraw {
    fn new(
        gpu: &Gpu,
        scene: &Scene,
        pass: &Pass,
        draw: &Draw,
        (bound, counted): (Option<Bound>, Counted),
        geometry: &mut Geometry,
    ) -> Result<Self, BackendError> {
        let formats: Vec<_> = pass
            .color
            .iter()
            .map(|i| scene.attachments[*i].format)
            .collect();
        let depth_stencil = pass.depth_stencil.map(|i| scene.attachments[i].format);
        let samples = scene.pass_samples(pass);
        let pipeline = |draw: &Draw, formats: &[TextureFormat]| {
            let key = DrawKey::of(draw, formats.iter().copied(), depth_stencil, samples);
            gpu.pipelines.draw(&gpu.device, &gpu.errors, key)
        };
        let other = match scene.path.state {
            PathState::OtherPipeline => Some(pipeline(&path::other(draw), &formats)?),
            _ => None,
        };
        // WebGPU restarts only strips.
        let call = draw.call().without_list_restarts(draw.topology);
        let vertices = append(&mut geometry.vertices, call.vertex_bytes());
        let colors =
            (!call.colors.is_empty()).then(|| append(&mut geometry.vertices, call.color_bytes()));
        let indices = call.indices.as_ref().map(|_| {
            let place = append(&mut geometry.indices, &call.index_bytes());
            (place, state::index_format(call.index))
        });
        let arguments = match scene.path.draws {
            PathDraws::Indirect => Some(place_arguments(gpu, geometry, &call)?),
            _ => None,
        };
        let [width, height] = scene.pass_size(pass);
        Ok(Self {
            pipeline: pipeline(draw, &formats)?,
            other,
            bound,
            counted,
            viewport: draw.viewport,
            scissor: draw.scissor.unwrap_or([0, 0, width, height]),
            blend_constant: state::color(draw.blend_constant),
            stencil_reference: reference(draw),
            vertices,
            colors,
            indices,
            drawn: call.first..call.first + call.count,
            base_vertex: call.base_vertex,
            instances: call.first_instance..call.first_instance + call.instances,
            arguments,
        })
    }

    /// Records the state that no pipeline holds.
    fn set_state(&self, encoder: &mut wgpu::RenderPass<'_>) {
        let ([x, y, w, h], [near, far]) = (self.viewport.rect, self.viewport.depth);
        encoder.set_viewport(x, y, w, h, near, far);
        let [x, y, w, h] = self.scissor;
        encoder.set_scissor_rect(x, y, w, h);
        encoder.set_blend_constant(self.blend_constant);
        if let Some(reference) = self.stencil_reference {
            encoder.set_stencil_reference(reference);
        }
    }

    /// True if the state that no pipeline holds is the same, and no query begins or ends between the draws.
    fn shares_state(&self, other: &Self) -> bool {
        let state = |draw: &Self| {
            (
                draw.viewport,
                draw.scissor,
                draw.blend_constant,
                draw.stencil_reference,
            )
        };
        let counted = [self.counted, other.counted].map(Counted::is_edge);
        state(self) == state(other) && counted == [false, false]
    }
}

/// Returns the longest runs of draws that share the state that no pipeline holds.
fn runs(draws: &[PreparedDraw]) -> Vec<Range<usize>> {
    let mut first = 0;
    draws
        .chunk_by(PreparedDraw::shares_state)
        .map(|run| {
            let range = first..first + run.len();
            first = range.end;
            range
        })
        .collect()
}

/// Records other values of the state that no pipeline holds.
fn set_other_state(encoder: &mut wgpu::RenderPass<'_>, draw: &PreparedDraw) {
    encoder.set_viewport(0.0, 0.0, 1.0, 1.0, 0.25, 0.5);
    encoder.set_scissor_rect(0, 0, 1, 1);
    let wgpu::Color { r, g, b, a } = draw.blend_constant;
    let [r, g, b, a] = [r, g, b, a].map(|v| if v > 0.5 { 0.0 } else { 1.0 });
    encoder.set_blend_constant(wgpu::Color { r, g, b, a });
    if let Some(reference) = draw.stencil_reference {
        encoder.set_stencil_reference(!reference & 0xff);
    }
}

/// Adds the arguments of a draw, behind others that would draw nothing. Returns their place.
fn place_arguments(
    gpu: &Gpu,
    geometry: &mut Geometry,
    call: &Call<'_>,
) -> Result<u64, BackendError> {
    let features = gpu.device.features();
    if call.first_instance > 0 && !features.contains(wgpu::Features::INDIRECT_FIRST_INSTANCE) {
        let value = PathValue::Draws(PathDraws::Indirect);
        return Err(BackendError::NotSupported(Requirement::Path(value)));
    }
    let words = match call.indices {
        Some(_) => vec![
            call.count,
            call.instances,
            call.first,
            call.base_vertex.cast_unsigned(),
            call.first_instance,
        ],
        None => vec![call.count, call.instances, call.first, call.first_instance],
    };
    let bytes = |words: &[u32]| -> Vec<u8> { words.iter().flat_map(|w| w.to_ne_bytes()).collect() };
    append(&mut geometry.arguments, &bytes(&vec![0; words.len()]));
    Ok(append(&mut geometry.arguments, &bytes(&words)).start)
}

/// Returns what the adapter does by default with attachments of a format.
fn reading(gpu: &Gpu, format: TextureFormat) -> Reading {
    Reading {
        copies: gpu.abilities.copies,
        fetches: read_path(format, gpu.abilities) == ReadPath::Shader,
    }
}

/// WebGPU has one reference for both faces; `SeparateStencilMasks` is denied, so they are equal.
fn reference(draw: &Draw) -> Option<u32> {
    draw.stencil.map(|s| s.front.reference.into())
}
