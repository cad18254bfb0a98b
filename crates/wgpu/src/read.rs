//! From attachments to a frame.

use crate::gpu::{Gpu, Target, TextureLease, extent};
use crate::limits::read_path;
use crate::pipeline::FetchKey;
use etalon_backend::BackendError;
use etalon_frame::{Aspect, ChannelEncoding, Frame, Image, ReadPath, TextureFormat};
use wgpu::BufferUsages;

/// An attachment to read.
pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) format: TextureFormat,
    pub(crate) size: [u32; 2],
    pub(crate) target: &'a Target,
}

/// One aspect of an attachment on its way.
struct Piece<'a> {
    source: &'a Source<'a>,
    aspect: Aspect,
    how: How,
    channels: Vec<ChannelEncoding>,
    /// Bytes per code in the buffer.
    unit: usize,
    /// Where it starts in the buffer, and how far apart its rows lie there.
    offset: u64,
    pitch: u32,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum How {
    /// Copied from the attachment.
    Copy,
    /// Fetched by a shader, which stores a float's bits.
    FetchDepth,
    /// Found out by stencil tests bit by bit, four bits to an image. A stencil aspect can be
    /// fetched by a shader only where OpenGL has the texture mode for it, since 4.3 and ES 3.1.
    StencilBits,
}

/// All aspects of all sources, in order.
pub(crate) fn frame(gpu: &Gpu, sources: &[Source<'_>]) -> Result<Frame, BackendError> {
    let mut size = 0;
    let mut pieces = Vec::new();
    for source in sources {
        for aspect in source.format.aspects() {
            let piece = Piece::new(source, *aspect, gpu.abilities.copies, size);
            size += piece.bytes();
            pieces.push(piece);
        }
    }
    let buffer = gpu.buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST, size);
    let descriptor = wgpu::CommandEncoderDescriptor::default();
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    let mut scratch = Vec::new();
    for piece in &pieces {
        piece.record(gpu, &mut encoder, &buffer, &mut scratch)?;
    }
    let index = gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    gpu.wait(index)?;
    let images = {
        let bytes = buffer
            .slice(..)
            .get_mapped_range()
            .map_err(|error| BackendError::Internal(format!("mapping a buffer: {error}")))?;
        pieces.iter().map(|piece| piece.image(&bytes)).collect()
    };
    buffer.unmap();
    Ok(Frame { images })
}

impl<'a> Piece<'a> {
    fn new(source: &'a Source<'a>, aspect: Aspect, copies: bool, offset: u64) -> Self {
        let format = source.format;
        let float = vec![ChannelEncoding::Float32];
        let (how, channels, unit) = match aspect {
            Aspect::Color => {
                let channels = format.color_channels().to_vec();
                let unit = if channels.first() == Some(&ChannelEncoding::Float32) {
                    4
                } else {
                    1
                };
                (How::Copy, channels, unit)
            }
            Aspect::Depth => match (read_path(format, copies), format) {
                (ReadPath::Shader, _) => (How::FetchDepth, float, 4),
                (ReadPath::Copy, TextureFormat::Depth16Unorm) => {
                    (How::Copy, vec![ChannelEncoding::Unorm(16)], 2)
                }
                (ReadPath::Copy, _) => (How::Copy, float, 4),
            },
            Aspect::Stencil => {
                let channels = vec![ChannelEncoding::Uint(8)];
                if copies {
                    (How::Copy, channels, 1)
                } else {
                    (How::StencilBits, channels, 4)
                }
            }
        };
        let row = source.size[0] * (unit * channels.len()) as u32;
        Self {
            source,
            aspect,
            how,
            channels,
            unit,
            offset,
            pitch: row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT),
        }
    }

    fn image_bytes(&self) -> u64 {
        u64::from(self.pitch) * u64::from(self.source.size[1])
    }

    fn bytes(&self) -> u64 {
        match self.how {
            How::Copy | How::FetchDepth => self.image_bytes(),
            How::StencilBits => 2 * self.image_bytes(),
        }
    }

    /// Records the way into the buffer. Textures on the way are kept in `scratch` until the work
    /// is done.
    fn record<'g>(
        &self,
        gpu: &'g Gpu,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        scratch: &mut Vec<TextureLease<'g>>,
    ) -> Result<(), BackendError> {
        let size = self.source.size;
        match self.how {
            How::Copy => {
                let aspect = match self.aspect {
                    Aspect::Color => wgpu::TextureAspect::All,
                    Aspect::Depth => wgpu::TextureAspect::DepthOnly,
                    Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
                };
                self.copy(encoder, &self.source.target.texture, aspect, buffer, 0);
            }
            How::FetchDepth => {
                let target = gpu.scratch(wgpu::TextureFormat::R32Uint, size);
                let key = FetchKey::Depth;
                let pipeline = gpu.pipelines.fetch(&gpu.device, &gpu.errors, key)?;
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: &[Some(blank(&target))],
                    ..wgpu::RenderPassDescriptor::default()
                });
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, gpu.fetch(self.source.target), &[]);
                pass.draw(0..3, 0..1);
                drop(pass);
                let all = wgpu::TextureAspect::All;
                self.copy(encoder, &target.texture, all, buffer, 0);
                scratch.push(target);
            }
            How::StencilBits => {
                for half in [0_u8, 1] {
                    let target = gpu.scratch(wgpu::TextureFormat::Rgba8Unorm, size);
                    self.record_bits(gpu, encoder, &target, half)?;
                    let all = wgpu::TextureAspect::All;
                    let offset = u64::from(half) * self.image_bytes();
                    self.copy(encoder, &target.texture, all, buffer, offset);
                    scratch.push(target);
                }
            }
        }
        Ok(())
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
            color_attachments: &[Some(blank(target))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.source.target.view,
                depth_ops: format.has_depth().then_some(kept()),
                stencil_ops: Some(kept()),
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
        texture: &wgpu::Texture,
        aspect: wgpu::TextureAspect,
        buffer: &wgpu::Buffer,
        offset: u64,
    ) {
        let from = wgpu::TexelCopyTextureInfo {
            aspect,
            ..texture.as_image_copy()
        };
        let to = wgpu::TexelCopyBufferInfo {
            buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: self.offset + offset,
                bytes_per_row: Some(self.pitch),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(from, to, extent(self.source.size));
    }

    /// The image out of the mapped buffer.
    fn image(&self, bytes: &[u8]) -> Image {
        let codes = match self.how {
            How::Copy | How::FetchDepth => {
                self.codes(bytes, self.offset, self.unit, self.channels.len())
            }
            How::StencilBits => {
                let low = self.codes(bytes, self.offset, 1, 4);
                let high = self.codes(bytes, self.offset + self.image_bytes(), 1, 4);
                low.chunks(4)
                    .zip(high.chunks(4))
                    .map(|(low, high)| {
                        let bits = low.iter().chain(high).rev();
                        bits.fold(0, |value, bit| value << 1 | u32::from(*bit != 0))
                    })
                    .collect()
            }
        };
        let by_shader = self.how == How::FetchDepth;
        Image {
            attachment: self.source.name.to_owned(),
            aspect: self.aspect,
            size: self.source.size,
            samples: 1,
            channels: self.channels.clone(),
            // A stencil value is an integer, exact whichever way it took.
            read: if by_shader {
                ReadPath::Shader
            } else {
                ReadPath::Copy
            },
            codes,
        }
    }

    /// The little-endian codes of an image in the buffer, without what pads its rows.
    fn codes(&self, bytes: &[u8], offset: u64, unit: usize, channels: usize) -> Vec<u32> {
        let row = self.source.size[0] as usize * unit * channels;
        let image = &bytes[offset as usize..(offset + self.image_bytes()) as usize];
        image
            .chunks(self.pitch as usize)
            .flat_map(|padded| padded[..row].chunks(unit))
            .map(|code| {
                let bytes = code.iter().rev();
                bytes.fold(0, |value, byte| value << 8 | u32::from(*byte))
            })
            .collect()
    }
}

fn blank(target: &Target) -> wgpu::RenderPassColorAttachment<'_> {
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

fn kept<T>() -> wgpu::Operations<T> {
    wgpu::Operations {
        load: wgpu::LoadOp::Load,
        store: wgpu::StoreOp::Store,
    }
}
