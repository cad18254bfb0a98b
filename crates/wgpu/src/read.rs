//! Reading attachments back as a frame.

use crate::counting::Counting;
use crate::fetch::FetchKey;
use crate::gpu::{Gpu, TextureLease, extent};
use crate::limits::{Abilities, read_path};
use crate::recording::{Recorder, Rows};
use crate::state;
use crate::target::Target;
use crate::texel;
use etalon_backend::codes::code_of_fetched;
use etalon_backend::{BackendError, Fault, Form, Plane, halves};
use etalon_frame::{
    Aspect, ChannelEncoding, Frame, Image, PathEnd, PathTarget, ReadPath, TextureFormat,
};
use wgpu::BufferUsages;

/// The size of an `rgba32uint` texel.
const SAMPLE_BYTES: usize = 16;

/// An attachment to read.
pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) format: TextureFormat,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) target: &'a Target,
    /// The way to the host.
    pub(crate) end: PathEnd,
}

/// The read-back of one aspect of an attachment.
struct ReadPlan<'a> {
    source: &'a Source<'a>,
    aspect: Aspect,
    method: ReadMethod,
    /// The path that the image declares. Multisampling is offered only if a shader returns the
    /// codes of a copy, or a shader reads single samples too; stencil is exact on both paths.
    read: ReadPath,
    channels: Vec<ChannelEncoding>,
    /// The offset in the buffer and the distance between rows.
    offset: u64,
    pitch: u32,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ReadMethod {
    /// Copied from the attachment.
    Copy,
    /// Fetched by a shader, four values to a texel.
    FetchTexel,
    /// Fetched by a shader as the bits of floats.
    FetchDepth,
    /// Fetched by a shader sample by sample, an image of four values each.
    FetchSamples,
    /// Read by stencil tests bit by bit, four bits to an image. OpenGL has the texture mode for
    /// fetching stencil only since 4.3 and ES 3.1.
    StencilBits,
}

/// Returns all aspects of all sources in order, and the counts.
pub(crate) fn frame(
    gpu: &Gpu,
    sources: &[Source<'_>],
    counting: &Counting<'_>,
) -> Result<Frame, BackendError> {
    let descriptor = wgpu::CommandEncoderDescriptor::default();
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    let copies = sources
        .iter()
        .map(|source| source.copy(gpu, &mut encoder))
        .collect::<Result<Vec<_>, _>>()?;
    let sources: Vec<_> = sources
        .iter()
        .zip(&copies)
        .map(|(source, copy)| Source {
            target: copy.as_ref().map_or(source.target, |copy| &***copy),
            ..*source
        })
        .collect();
    let mut size = 0;
    let mut plans = Vec::new();
    for source in &sources {
        for aspect in source.format.aspects() {
            let plan = ReadPlan::new(source, *aspect, gpu.abilities, size);
            size += plan.bytes();
            plans.push(plan);
        }
    }
    let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
    let buffer = gpu.buffer(usage, size + counting.bytes());
    // A copy that is lost must not leave the codes of an earlier scene with the same picture.
    encoder.clear_buffer(&buffer, 0, None);
    let mut scratch = Vec::new();
    for plan in &plans {
        plan.record(gpu, &mut encoder, &buffer, &mut scratch)?;
    }
    counting.copy(&mut encoder, &buffer, size);
    let index = gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    gpu.wait(index)?;
    let frame = {
        let bytes = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|error| BackendError::internal_of("mapping a buffer", error.to_string()))?;
        Frame {
            images: plans
                .iter()
                .map(|plan| plan.image(&bytes, gpu.fault))
                .collect(),
            counters: counting.counts(&bytes[size as usize..]),
        }
    };
    buffer.unmap();
    if let Some(recorder) = &gpu.recorder {
        recorder.begin();
        for (plan, image) in plans.iter().zip(&frame.images) {
            recorder.image(image, plan.planes(recorder));
        }
        recorder.counters(counting.recorded(recorder, size));
    }
    Ok(frame)
}

impl Source<'_> {
    /// Records the copy to another texture, if that is the way to the host.
    fn copy<'g>(
        &self,
        gpu: &'g Gpu,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Option<TextureLease<'g>>, BackendError> {
        if self.end != PathEnd::Copy {
            return Ok(None);
        }
        let target = gpu.attachment(self.format, self.size, self.samples, PathTarget::Plain)?;
        self.spoil(gpu, encoder, &target);
        let all = wgpu::TextureAspect::All;
        let (from, to) = (self.target.copied(all, [0, 0]), target.copied(all, [0, 0]));
        encoder.copy_texture_to_texture(from, to, extent(self.size));
        Ok(Some(target))
    }

    /// Fills the target of a copy with values that are left if the copy is lost.
    fn spoil(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, target: &Target) {
        let format = self.format;
        let color = [Some(wgpu::RenderPassColorAttachment {
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(state::color(
                    [if format.is_integer() { 77.0 } else { 0.3 }; 4],
                )),
                store: wgpu::StoreOp::Store,
            },
            ..cleared(target)
        })];
        let whole = wgpu::RenderPassDepthStencilAttachment {
            view: &target.view,
            depth_ops: format.has_depth().then_some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.3),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: format.has_stencil().then_some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(77),
                store: wgpu::StoreOp::Store,
            }),
        };
        if gpu.draws(format) {
            encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: if format.is_color() { &color } else { &[] },
                depth_stencil_attachment: (!format.is_color()).then_some(whole),
                ..wgpu::RenderPassDescriptor::default()
            });
        }
    }
}

impl<'a> ReadPlan<'a> {
    fn new(source: &'a Source<'a>, aspect: Aspect, abilities: Abilities, offset: u64) -> Self {
        let format = source.format;
        let path = read_path(format, abilities);
        let channels = match (aspect, format) {
            (Aspect::Color, _) => format.color_channels().to_vec(),
            (Aspect::Stencil, _) => vec![ChannelEncoding::Uint(8)],
            (Aspect::Depth, TextureFormat::Depth16Unorm) if path == ReadPath::Copy => {
                vec![ChannelEncoding::Unorm(16)]
            }
            (Aspect::Depth, _) => vec![ChannelEncoding::Float32],
        };
        let method = match aspect {
            _ if source.samples > 1 => ReadMethod::FetchSamples,
            Aspect::Color if source.end == PathEnd::ShaderRead => ReadMethod::FetchTexel,
            Aspect::Depth if path == ReadPath::Shader || source.end == PathEnd::ShaderRead => {
                ReadMethod::FetchDepth
            }
            Aspect::Stencil if !abilities.copies => ReadMethod::StencilBits,
            Aspect::Color | Aspect::Depth | Aspect::Stencil => ReadMethod::Copy,
        };
        let plan = Self {
            source,
            aspect,
            method,
            read: if aspect == Aspect::Depth {
                path
            } else {
                ReadPath::Copy
            },
            channels,
            offset,
            pitch: 0,
        };
        let row = source.size[0] * plan.texel_bytes() as u32;
        Self {
            pitch: row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT),
            ..plan
        }
    }

    /// Returns the size of a texel in the buffer.
    fn texel_bytes(&self) -> usize {
        match (self.method, self.aspect) {
            (ReadMethod::FetchSamples | ReadMethod::FetchTexel, _) => SAMPLE_BYTES,
            (ReadMethod::FetchDepth | ReadMethod::StencilBits, _) => 4,
            (ReadMethod::Copy, Aspect::Color) => texel::bytes(self.source.format),
            (ReadMethod::Copy, Aspect::Stencil) => 1,
            (ReadMethod::Copy, Aspect::Depth) => match self.channels.as_slice() {
                [ChannelEncoding::Unorm(16)] => 2,
                _ => 4,
            },
        }
    }

    fn image_bytes(&self) -> u64 {
        u64::from(self.pitch) * u64::from(self.source.size[1])
    }

    fn bytes(&self) -> u64 {
        match self.method {
            ReadMethod::Copy | ReadMethod::FetchDepth | ReadMethod::FetchTexel => {
                self.image_bytes()
            }
            ReadMethod::FetchSamples => u64::from(self.source.samples) * self.image_bytes(),
            ReadMethod::StencilBits => 2 * self.image_bytes(),
        }
    }

    /// Records the copy to the buffer. `scratch` keeps the textures between alive until the work is
    /// done.
    fn record<'g>(
        &self,
        gpu: &'g Gpu,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        scratch: &mut Vec<TextureLease<'g>>,
    ) -> Result<(), BackendError> {
        let size = self.source.size;
        match self.method {
            ReadMethod::Copy => {
                let aspect = match self.aspect {
                    Aspect::Color => wgpu::TextureAspect::All,
                    Aspect::Depth => wgpu::TextureAspect::DepthOnly,
                    Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
                };
                self.copy(encoder, self.source.target, aspect, buffer, 0);
            }
            ReadMethod::FetchTexel => {
                let layouts = &gpu.pipelines.layouts;
                let (key, layout) = if self.source.format.is_integer() {
                    (FetchKey::IntegerTexel, &layouts.integer_texture)
                } else {
                    (FetchKey::Texel, &layouts.texture)
                };
                let bindings = gpu.bound(layout, &[self.source.target.fetch()]);
                let format = wgpu::TextureFormat::Rgba32Uint;
                let fetched = (key, &bindings, format, 0);
                scratch.push(self.fetch(gpu, encoder, buffer, fetched)?);
            }
            ReadMethod::FetchDepth => {
                let layout = &gpu.pipelines.layouts.texture;
                let bindings = gpu.bound(layout, &[self.source.target.fetch()]);
                let format = wgpu::TextureFormat::R32Uint;
                let fetched = (FetchKey::Depth, &bindings, format, 0);
                scratch.push(self.fetch(gpu, encoder, buffer, fetched)?);
            }
            ReadMethod::FetchSamples => {
                let (layouts, target) = (&gpu.pipelines.layouts, self.source.target);
                let (key, layout, view) = if self.aspect == Aspect::Stencil {
                    (FetchKey::StencilSample, &layouts.integers, target.stencil())
                } else {
                    (FetchKey::Sample, &layouts.samples, target.fetch())
                };
                let bindings = gpu.bound(layout, &[view]);
                let format = wgpu::TextureFormat::Rgba32Uint;
                for sample in 0..self.source.samples {
                    let fetched = (key, &bindings, format, sample);
                    scratch.push(self.fetch(gpu, encoder, buffer, fetched)?);
                }
            }
            ReadMethod::StencilBits => {
                for half in [0_u8, 1] {
                    let target = gpu.scratch(wgpu::TextureFormat::Rgba8Unorm, size);
                    self.record_bits(gpu, encoder, &target, half)?;
                    let all = wgpu::TextureAspect::All;
                    let offset = u64::from(half) * self.image_bytes();
                    self.copy(encoder, &target, all, buffer, offset);
                    scratch.push(target);
                }
            }
        }
        Ok(())
    }

    /// Records the fetch of one sample and its copy to the buffer. Returns the texture between.
    fn fetch<'g>(
        &self,
        gpu: &'g Gpu,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        (key, bindings, format, sample): (FetchKey, &wgpu::BindGroup, wgpu::TextureFormat, u32),
    ) -> Result<TextureLease<'g>, BackendError> {
        let target = gpu.scratch(format, self.source.size);
        let pipeline = gpu.pipelines.fetch(&gpu.device, &gpu.errors, key)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared(&target))],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, bindings, &[]);
        pass.draw(3 * sample..3 * sample + 3, 0..1);
        drop(pass);
        let offset = u64::from(sample) * self.image_bytes();
        let all = wgpu::TextureAspect::All;
        self.copy(encoder, &target, all, buffer, offset);
        Ok(target)
    }

    fn record_bits(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        half: u8,
    ) -> Result<(), BackendError> {
        let format = self.source.format;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared(target))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.source.target.view,
                depth_ops: format.has_depth().then_some(unchanged()),
                stencil_ops: Some(unchanged()),
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_stencil_reference(0xff);
        for bit in 4 * half..4 * half + 4 {
            let key = FetchKey::StencilBit { format, bit };
            let pipeline = gpu.pipelines.fetch(&gpu.device, &gpu.errors, key)?;
            pass.set_pipeline(&pipeline);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }

    fn copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &Target,
        aspect: wgpu::TextureAspect,
        buffer: &wgpu::Buffer,
        offset: u64,
    ) {
        let [width, height] = self.source.size;
        let (columns, rows) = match self.source.end {
            PathEnd::Part => (halves(width), halves(height)),
            _ => (vec![(0, width)], vec![(0, height)]),
        };
        for (y, high) in rows {
            for (x, wide) in &columns {
                let texels = u64::from(*x) * self.texel_bytes() as u64;
                let place = u64::from(y) * u64::from(self.pitch) + texels;
                let to = wgpu::TexelCopyBufferInfo {
                    buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: self.offset + offset + place,
                        bytes_per_row: Some(self.pitch),
                        rows_per_image: None,
                    },
                };
                let from = texture.copied(aspect, [*x, y]);
                encoder.copy_texture_to_buffer(from, to, extent([*wide, high]));
            }
        }
    }

    /// Returns the image from the mapped buffer.
    fn image(&self, bytes: &[u8], fault: Option<Fault>) -> Image {
        let mut codes = match self.method {
            ReadMethod::Copy | ReadMethod::FetchDepth => self.copied(bytes),
            ReadMethod::FetchSamples | ReadMethod::FetchTexel => self.samples(bytes),
            ReadMethod::StencilBits => {
                let (low, high) = (self.texels(bytes, 0), self.texels(bytes, 1));
                low.zip(high)
                    .map(|(low, high)| {
                        let bits = low.iter().chain(high).rev();
                        bits.fold(0, |value, bit| value << 1 | u32::from(*bit != 0))
                    })
                    .collect()
            }
        };
        if let Some(Fault::Read(fault)) = fault {
            let (size, samples) = (self.source.size, self.source.samples);
            fault.apply(&mut codes, size, samples, &self.channels);
        }
        Image {
            attachment: self.source.name.to_owned(),
            aspect: self.aspect,
            size: self.source.size,
            samples: self.source.samples,
            channels: self.channels.clone(),
            read: self.read,
            codes,
        }
    }

    /// Notes where the codes are that were just read.
    fn planes(&self, recorder: &Recorder) -> Vec<Plane> {
        let rows = |image: u64| Rows {
            offset: self.offset + image * self.image_bytes(),
            pitch: self.pitch,
            row: self.source.size[0] * self.texel_bytes() as u32,
            rows: self.source.size[1],
        };
        let floats = match self.channels.first() {
            Some(ChannelEncoding::Uint(_)) => Form::Code,
            _ => Form::Float,
        };
        let (texel, channels, form) = match self.method {
            ReadMethod::FetchSamples | ReadMethod::FetchTexel => {
                let each = (0..self.channels.len() as u32).map(|channel| [32 * channel, 32]);
                (SAMPLE_BYTES as u32, each.collect(), floats)
            }
            ReadMethod::FetchDepth => (4, vec![[0, 32]], Form::Code),
            ReadMethod::StencilBits => (1, vec![[0, 8]], Form::Code),
            ReadMethod::Copy => {
                let texel = self.texel_bytes() as u32;
                let channels = match self.aspect {
                    Aspect::Color => texel::places(self.source.format),
                    Aspect::Depth | Aspect::Stencil => vec![[0, 8 * texel]],
                };
                (texel, channels, Form::Code)
            }
        };
        let plane = |output| Plane {
            output,
            texel,
            channels: channels.clone(),
            form,
        };
        match self.method {
            ReadMethod::StencilBits => vec![plane(recorder.bits([rows(0), rows(1)]))],
            _ => (0..self.source.samples.into())
                .map(|sample| plane(recorder.rows(rows(sample))))
                .collect(),
        }
    }

    /// Returns the texels of the n-th image of this read, row by row.
    fn texels<'b>(&self, bytes: &'b [u8], image: u64) -> impl Iterator<Item = &'b [u8]> + use<'b> {
        let texel = self.texel_bytes();
        let row = self.source.size[0] as usize * texel;
        let start = self.offset + image * self.image_bytes();
        bytes[start as usize..(start + self.image_bytes()) as usize]
            .chunks(self.pitch as usize)
            .flat_map(move |padded| padded[..row].chunks(texel))
    }

    fn copied(&self, bytes: &[u8]) -> Vec<u32> {
        let mut codes = Vec::new();
        for texel in self.texels(bytes, 0) {
            if self.aspect == Aspect::Color {
                texel::unpack(self.source.format, texel, &mut codes);
            } else {
                let bytes = texel.iter().rev();
                codes.push(bytes.fold(0, |value, byte| value << 8 | u32::from(*byte)));
            }
        }
        codes
    }

    fn samples(&self, bytes: &[u8]) -> Vec<u32> {
        let mut images: Vec<_> = (0..self.source.samples)
            .map(|sample| self.texels(bytes, sample.into()))
            .collect();
        let texels = self.source.size[0] as usize * self.source.size[1] as usize;
        let mut codes = Vec::with_capacity(texels * images.len() * self.channels.len());
        for _ in 0..texels {
            for texel in images.iter_mut().filter_map(Iterator::next) {
                let codes_of_texel =
                    texel
                        .chunks(4)
                        .zip(&self.channels)
                        .map(|(bytes, encoding)| {
                            let bytes = bytes.iter().rev();
                            let bits = bytes.fold(0, |value, byte| value << 8 | u32::from(*byte));
                            code_of_fetched(*encoding, bits)
                        });
                codes.extend(codes_of_texel);
            }
        }
        codes
    }
}

fn cleared(target: &Target) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view: &target.view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    }
}

fn unchanged<T>() -> wgpu::Operations<T> {
    wgpu::Operations {
        load: wgpu::LoadOp::Load,
        store: wgpu::StoreOp::Store,
    }
}
