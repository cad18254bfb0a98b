//! Attachments on the device: what they start from and how passes take them.

use crate::format;
use crate::gpu::{BufferLease, Gpu, TextureLease, extent};
use crate::texel;
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use etalon_scene::{Contents, Scene};
use wgpu::BufferUsages;

/// An attachment.
pub(crate) struct Slot<'a> {
    pub(crate) name: String,
    pub(crate) format: TextureFormat,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) target: TextureLease<'a>,
    start: Start<'a>,
    /// The pass that clears it: the first that has to do with it, where that one draws to it.
    cleared_by: Option<usize>,
    /// Whether some pass writes to it.
    changes: bool,
}

/// What an attachment starts from.
enum Start<'a> {
    Color(wgpu::Color),
    DepthStencil(f32, u32),
    /// Rows that lie so many bytes apart in a buffer.
    Upload(BufferLease<'a>, u32),
}

impl<'a> Slot<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene, index: usize) -> Result<Self, BackendError> {
        let attachment = &scene.attachments[index];
        let (format, size) = (attachment.format, attachment.size);
        let upload = |codes: &[u32]| {
            let (bytes, pitch) = rows(format, size[0], codes);
            Start::Upload(gpu.filled(BufferUsages::COPY_SRC, &bytes), pitch)
        };
        let start = match &attachment.contents {
            Contents::Color(color) if gpu.draws(format) => Start::Color(format::color(*color)),
            // The API cannot clear it, so it gets the nearest codes.
            Contents::Color(color) => {
                let channels = format.color_channels().iter().zip(color);
                let texel: Vec<_> = channels.map(|(e, v)| e.nearest_code((*v).into())).collect();
                upload(&texel.repeat(size[0] as usize * size[1] as usize))
            }
            Contents::DepthStencil { depth, stencil } => {
                Start::DepthStencil(*depth, (*stencil).into())
            }
            Contents::Texels(codes) => upload(codes),
        };
        let drawn = scene.passes.iter().map(|pass| {
            let depth_stencil = pass.depth_stencil == Some(index);
            let draws =
                pass.color.contains(&index) || depth_stencil && !pass.depth_stencil_read_only;
            let resolves = pass.resolve.contains(&Some(index));
            let fetches = pass.draws.iter().any(|d| d.textures.contains(&index));
            (draws, resolves, depth_stencil || fetches)
        });
        let first = drawn
            .clone()
            .position(|(draws, resolves, reads)| draws || resolves || reads);
        Ok(Self {
            name: attachment.name.clone(),
            format,
            size,
            samples: attachment.samples,
            target: gpu.attachment(format, size, attachment.samples)?,
            start,
            cleared_by: first.filter(|pass| drawn.clone().nth(*pass).is_some_and(|d| d.0)),
            changes: drawn.clone().any(|(draws, resolves, _)| draws || resolves),
        })
    }

    /// Records what gives the attachment its contents where no pass's own clear does. What nothing
    /// changes needs an upload only the `first` time.
    pub(crate) fn initialise(&self, encoder: &mut wgpu::CommandEncoder, first: bool) {
        match &self.start {
            Start::Upload(buffer, pitch) => {
                if self.changes || first {
                    self.upload(encoder, buffer, *pitch);
                }
            }
            Start::Color(_) if self.cleared_by.is_none() => {
                let attachment = [Some(self.as_color(None, None))];
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: &attachment,
                    ..wgpu::RenderPassDescriptor::default()
                });
            }
            Start::DepthStencil(..) if self.cleared_by.is_none() => {
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    depth_stencil_attachment: Some(self.as_depth_stencil(None)),
                    ..wgpu::RenderPassDescriptor::default()
                });
            }
            Start::Color(_) | Start::DepthStencil(..) => {}
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

    /// The attachment in a pass of the scene, or in the pass that only clears it.
    pub(crate) fn as_color<'s>(
        &'s self,
        pass: Option<usize>,
        resolve: Option<&'s wgpu::TextureView>,
    ) -> wgpu::RenderPassColorAttachment<'s> {
        let load = match self.start {
            Start::Color(color) if self.cleared_by == pass => wgpu::LoadOp::Clear(color),
            _ => wgpu::LoadOp::Load,
        };
        wgpu::RenderPassColorAttachment {
            view: &self.target.view,
            depth_slice: None,
            resolve_target: resolve,
            ops: wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            },
        }
    }

    /// The attachment in a pass of the scene, or in the pass that only clears it.
    pub(crate) fn as_depth_stencil(
        &self,
        pass: Option<usize>,
    ) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let (depth, stencil) = match self.start {
            Start::DepthStencil(depth, stencil) if self.cleared_by == pass => {
                (wgpu::LoadOp::Clear(depth), wgpu::LoadOp::Clear(stencil))
            }
            _ => (wgpu::LoadOp::Load, wgpu::LoadOp::Load),
        };
        let store = wgpu::StoreOp::Store;
        let depth = wgpu::Operations { load: depth, store };
        let stencil = wgpu::Operations {
            load: stencil,
            store,
        };
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.target.view,
            depth_ops: self.format.has_depth().then_some(depth),
            stencil_ops: self.format.has_stencil().then_some(stencil),
        }
    }

    /// The attachment in a pass that promises not to write to it.
    pub(crate) fn as_read_only(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.target.view,
            depth_ops: None,
            stencil_ops: None,
        }
    }
}

/// Codes as bytes, each row at a multiple of the pitch, which comes with them.
fn rows(format: TextureFormat, width: u32, codes: &[u32]) -> (Vec<u8>, u32) {
    let row = width * texel::bytes(format) as u32;
    let pitch = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let channels = format.color_channels().len();
    let mut padded = Vec::new();
    for row in codes.chunks(width as usize * channels) {
        for codes in row.chunks(channels) {
            texel::pack(format, codes, &mut padded);
        }
        padded.resize(padded.len().next_multiple_of(pitch as usize), 0);
    }
    (padded, pitch)
}
