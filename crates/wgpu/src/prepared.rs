//! A scene, ready to be drawn.

use crate::format;
use crate::gpu::{BufferLease, Clock, Gpu, TextureLease, extent};
use crate::limits;
use crate::pipeline::{DrawKey, PARAMS_BYTES};
use crate::read::{self, Source};
use etalon_backend::{BackendError, FrameTime, Prepared};
use etalon_case::Scene;
use etalon_case::scene::{Attachment, Contents, Draw};
use etalon_frame::{Frame, TextureFormat};
use std::time::{Duration, Instant};
use wgpu::BufferUsages;

/// Everything that drawing a scene takes.
pub(crate) struct Ready<'a> {
    gpu: &'a Gpu,
    slots: Vec<Slot<'a>>,
    passes: Vec<ReadyPass>,
    read: Vec<usize>,
    vertices: Option<BufferLease<'a>>,
    params: Option<(BufferLease<'a>, wgpu::BindGroup)>,
    submitted: bool,
}

/// An attachment.
struct Slot<'a> {
    name: String,
    format: TextureFormat,
    size: [u32; 2],
    target: TextureLease<'a>,
    start: Start<'a>,
    /// The first pass that draws to it.
    first_pass: Option<usize>,
}

/// What an attachment starts from.
enum Start<'a> {
    Color(wgpu::Color),
    DepthStencil(f32, u32),
    /// Rows that lie so many bytes apart in a buffer.
    Upload(BufferLease<'a>, u32),
}

struct ReadyPass {
    color: Vec<usize>,
    depth_stencil: Option<usize>,
    draws: Vec<ReadyDraw>,
}

struct ReadyDraw {
    pipeline: wgpu::RenderPipeline,
    binding: Binding,
    blend_constant: wgpu::Color,
    stencil_reference: Option<u32>,
    first_vertex: u32,
    vertices: u32,
}

enum Binding {
    None,
    /// The parameter block at this offset.
    Params(u32),
    /// The texture of this attachment.
    Texture(wgpu::BindGroup),
}

impl<'a> Ready<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        let missing = gpu.limits.missing(&scene.requirements());
        if let Some(missing) = missing.or_else(|| limits::missing(scene, gpu.abilities)) {
            return Err(BackendError::NotSupported(missing));
        }
        gpu.guard("preparing a scene", || Self::build(gpu, scene))
    }

    fn build(gpu: &'a Gpu, scene: &Scene) -> Result<Self, BackendError> {
        let slots: Vec<_> = (0..)
            .zip(&scene.attachments)
            .map(|(index, attachment)| {
                let mut slot = Slot::new(gpu, attachment);
                slot.first_pass = scene.passes.iter().position(|pass| {
                    pass.color.contains(&index) || pass.depth_stencil == Some(index)
                });
                slot
            })
            .collect();
        gpu.errors.check("making attachments")?;
        let mut vertices = Vec::new();
        let mut params = Vec::new();
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment;
        let stride = PARAMS_BYTES.next_multiple_of(u64::from(alignment)) as usize;
        let mut first_vertex = 0;
        let mut passes = Vec::new();
        for pass in &scene.passes {
            let formats = || pass.color.iter().map(|i| scene.attachments[*i].format);
            let depth_stencil = pass.depth_stencil.map(|i| scene.attachments[i].format);
            let mut draws = Vec::new();
            for draw in &pass.draws {
                let key = DrawKey::of(draw, formats(), depth_stencil);
                let count = draw.mesh.vertices.len() as u32;
                vertices.extend_from_slice(draw.mesh.bytes());
                let binding = if let Some(index) = draw.textures.first() {
                    Binding::Texture(gpu.fetch(&slots[*index].target).clone())
                } else if draw.shader.uses_params() {
                    let at = params.len();
                    params.extend_from_slice(&draw.params.to_bytes());
                    params.resize(at + stride, 0);
                    Binding::Params(at as u32)
                } else {
                    Binding::None
                };
                draws.push(ReadyDraw {
                    pipeline: gpu.pipelines.draw(&gpu.device, &gpu.errors, key)?,
                    binding,
                    blend_constant: format::color(draw.blend_constant),
                    stencil_reference: reference(draw),
                    first_vertex,
                    vertices: count,
                });
                first_vertex += count;
            }
            passes.push(ReadyPass {
                color: pass.color.clone(),
                depth_stencil: pass.depth_stencil,
                draws,
            });
        }
        let vertices = (!vertices.is_empty()).then(|| gpu.filled(BufferUsages::VERTEX, &vertices));
        let params = (!params.is_empty()).then(|| {
            let buffer = gpu.filled(BufferUsages::UNIFORM, &params);
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &gpu.pipelines.layouts.params.bindings,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &buffer,
                        offset: 0,
                        size: wgpu::BufferSize::new(PARAMS_BYTES),
                    }),
                }],
            });
            (buffer, group)
        });
        Ok(Self {
            gpu,
            slots,
            passes,
            read: scene.read.clone(),
            vertices,
            params,
            submitted: false,
        })
    }

    /// Records the initial contents and all passes.
    fn record(&self) -> wgpu::CommandBuffer {
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for slot in &self.slots {
            // An attachment that a pass draws to is cleared by the first such pass.
            match &slot.start {
                Start::Upload(buffer, pitch) if slot.first_pass.is_some() || !self.submitted => {
                    slot.upload(&mut encoder, buffer, *pitch);
                }
                Start::Color(_) if slot.first_pass.is_none() => {
                    let attachment = [Some(slot.as_color(true))];
                    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                        color_attachments: &attachment,
                        ..wgpu::RenderPassDescriptor::default()
                    });
                }
                Start::DepthStencil(..) if slot.first_pass.is_none() => {
                    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                        depth_stencil_attachment: Some(slot.as_depth_stencil(true)),
                        ..wgpu::RenderPassDescriptor::default()
                    });
                }
                _ => {}
            }
        }
        for (index, pass) in self.passes.iter().enumerate() {
            self.record_pass(&mut encoder, index, pass);
        }
        if let Some(clock) = self.clock() {
            encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
            encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.mapped, 0, Clock::BYTES);
        }
        encoder.finish()
    }

    fn record_pass(&self, encoder: &mut wgpu::CommandEncoder, index: usize, pass: &ReadyPass) {
        let slot = |i: &usize| {
            let slot = &self.slots[*i];
            (slot, slot.first_pass == Some(index))
        };
        let colors: Vec<_> = pass
            .color
            .iter()
            .map(slot)
            .map(|(slot, first)| Some(slot.as_color(first)))
            .collect();
        let depth_stencil = pass.depth_stencil.as_ref().map(slot);
        let last = index + 1 == self.passes.len();
        let timestamps = self.clock().filter(|_| index == 0 || last);
        let mut encoder = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &colors,
            depth_stencil_attachment: depth_stencil.map(|(s, first)| s.as_depth_stencil(first)),
            timestamp_writes: timestamps.map(|clock| wgpu::RenderPassTimestampWrites {
                query_set: &clock.queries,
                beginning_of_pass_write_index: (index == 0).then_some(0),
                end_of_pass_write_index: last.then_some(1),
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        if let Some(vertices) = &self.vertices {
            encoder.set_vertex_buffer(0, vertices.slice(..));
        }
        for draw in &pass.draws {
            encoder.set_pipeline(&draw.pipeline);
            match (&draw.binding, &self.params) {
                (Binding::Params(offset), Some((_, group))) => {
                    encoder.set_bind_group(0, group, &[*offset]);
                }
                (Binding::Texture(group), _) => encoder.set_bind_group(0, group, &[]),
                (Binding::Params(_) | Binding::None, _) => {}
            }
            encoder.set_blend_constant(draw.blend_constant);
            if let Some(reference) = draw.stencil_reference {
                encoder.set_stencil_reference(reference);
            }
            encoder.draw(draw.first_vertex..draw.first_vertex + draw.vertices, 0..1);
        }
    }

    /// Timestamps stand around passes, so there are none without a pass.
    fn clock(&self) -> Option<&'a Clock> {
        self.gpu.clock.as_ref().filter(|_| !self.passes.is_empty())
    }

    fn draw(&mut self) -> Result<FrameTime, BackendError> {
        let begin = Instant::now();
        let commands = self.record();
        let index = self.gpu.queue.submit([commands]);
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
        let gpu = clock.and_then(elapsed);
        Ok(FrameTime { cpu, gpu, wall })
    }
}

impl Prepared for Ready<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let gpu = self.gpu;
        gpu.guard("drawing a scene", || self.draw())
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        if !self.submitted {
            let message = "read back before the first submit".to_owned();
            return Err(BackendError::Internal(message));
        }
        let source = |index: &usize| {
            let slot = &self.slots[*index];
            Source {
                name: &slot.name,
                format: slot.format,
                size: slot.size,
                target: &slot.target,
            }
        };
        let sources: Vec<_> = self.read.iter().map(source).collect();
        self.gpu
            .guard("reading a frame back", || read::frame(self.gpu, &sources))
    }
}

impl<'a> Slot<'a> {
    fn new(gpu: &'a Gpu, attachment: &Attachment) -> Self {
        let format = attachment.format;
        Self {
            name: attachment.name.clone(),
            format,
            size: attachment.size,
            target: gpu.attachment(format, attachment.size),
            start: match &attachment.contents {
                Contents::Color(color) => Start::Color(format::color(*color)),
                Contents::DepthStencil { depth, stencil } => {
                    Start::DepthStencil(*depth, (*stencil).into())
                }
                Contents::Texels(codes) => {
                    let (bytes, pitch) = rows(format, attachment.size[0], codes);
                    Start::Upload(gpu.filled(BufferUsages::COPY_SRC, &bytes), pitch)
                }
            },
            first_pass: None,
        }
    }

    fn upload(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer, pitch: u32) {
        let source = wgpu::TexelCopyBufferInfo {
            buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(pitch),
                rows_per_image: None,
            },
        };
        let target = self.target.texture.as_image_copy();
        encoder.copy_buffer_to_texture(source, target, extent(self.size));
    }

    fn as_color(&self, first: bool) -> wgpu::RenderPassColorAttachment<'_> {
        let load = match self.start {
            Start::Color(color) if first => wgpu::LoadOp::Clear(color),
            _ => wgpu::LoadOp::Load,
        };
        wgpu::RenderPassColorAttachment {
            view: &self.target.view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            },
        }
    }

    fn as_depth_stencil(&self, first: bool) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let (depth, stencil) = match self.start {
            Start::DepthStencil(depth, stencil) if first => {
                (wgpu::LoadOp::Clear(depth), wgpu::LoadOp::Clear(stencil))
            }
            _ => (wgpu::LoadOp::Load, wgpu::LoadOp::Load),
        };
        let store = wgpu::StoreOp::Store;
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.target.view,
            depth_ops: self
                .format
                .has_depth()
                .then_some(wgpu::Operations { load: depth, store }),
            stencil_ops: self.format.has_stencil().then_some(wgpu::Operations {
                load: stencil,
                store,
            }),
        }
    }
}

/// WebGPU has one reference for both faces; `SeparateStencilMasks` is denied, so they agree.
fn reference(draw: &Draw) -> Option<u32> {
    draw.stencil.map(|s| s.front.reference.into())
}

/// Uploaded codes as bytes, each row at a multiple of the pitch, which comes with them.
fn rows(format: TextureFormat, width: u32, codes: &[u32]) -> (Vec<u8>, u32) {
    let bytes: Vec<u8> = match format {
        TextureFormat::Rgba32Float => codes.iter().flat_map(|c| c.to_le_bytes()).collect(),
        _ => codes.iter().map(|c| *c as u8).collect(),
    };
    let texel = if format == TextureFormat::Rgba32Float {
        16
    } else {
        4
    };
    let row = width * texel;
    let pitch = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let mut padded = Vec::new();
    for row in bytes.chunks(row as usize) {
        padded.extend_from_slice(row);
        padded.resize(padded.len().next_multiple_of(pitch as usize), 0);
    }
    (padded, pitch)
}

/// The time between the two timestamps, which are mapped by now; then they are unmapped.
fn elapsed(clock: &Clock) -> Option<Duration> {
    let ticks = {
        let bytes = clock.mapped.slice(..).get_mapped_range().ok()?;
        let tick = |at: usize| {
            let bytes = bytes.get(at..at + 8)?.try_into().ok()?;
            Some(u64::from_le_bytes(bytes))
        };
        // A clock that goes backwards tells nothing.
        tick(8)?.checked_sub(tick(0)?)
    };
    clock.mapped.unmap();
    let nanoseconds = ticks? as f64 * f64::from(clock.period);
    Some(Duration::from_nanos(nanoseconds as u64))
}
