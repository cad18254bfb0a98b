//! The attachments of a scene and their initial contents.

use crate::gpu::{BufferLease, Gpu, TextureLease, extent};
use crate::path;
use crate::state;
use crate::texel;
use etalon_backend::BackendError;
use etalon_frame::TextureFormat;
use etalon_scene::{
    Contents, LoadOperation, Operations, Pass, PassOperations, Scene, StoreOperation,
};
use wgpu::BufferUsages;

/// An attachment of a scene on the device.
pub(crate) struct DeviceAttachment<'a> {
    pub(crate) name: String,
    pub(crate) format: TextureFormat,
    pub(crate) size: [u32; 2],
    pub(crate) samples: u32,
    pub(crate) target: TextureLease<'a>,
    initial: InitialContents<'a>,
    /// The pass that clears it: the first that uses it, if that one draws to it and loads all of it. What
    /// another load operation replaces is cleared before.
    cleared_by: Option<usize>,
    /// True if a pass writes to it.
    changes: bool,
}

/// The initial contents of an attachment.
enum InitialContents<'a> {
    Color(wgpu::Color),
    DepthStencil(f32, u32),
    /// A buffer of rows, and the distance between them.
    Upload(BufferLease<'a>, u32),
}

impl<'a> DeviceAttachment<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &Scene, index: usize) -> Result<Self, BackendError> {
        let attachment = &scene.attachments[index];
        let (format, size) = (attachment.format, attachment.size);
        let upload = |codes: &[u32]| {
            let (bytes, pitch) = rows(format, size[0], codes);
            InitialContents::Upload(gpu.filled(BufferUsages::COPY_SRC, &bytes), pitch)
        };
        let initial = match &attachment.contents {
            Contents::Color(color) if gpu.draws(format) => {
                InitialContents::Color(state::color(*color))
            }
            // The API cannot clear it, so the nearest codes are uploaded.
            Contents::Color(color) => {
                let channels = format.color_channels().iter().zip(color);
                let texel: Vec<_> = channels.map(|(e, v)| e.nearest_code((*v).into())).collect();
                upload(&texel.repeat(size[0] as usize * size[1] as usize))
            }
            Contents::DepthStencil { depth, stencil } => {
                InitialContents::DepthStencil(*depth, (*stencil).into())
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
            target: gpu.attachment(format, size, attachment.samples, path::target(scene, index))?,
            initial,
            cleared_by: first
                .filter(|pass| drawn.clone().nth(*pass).is_some_and(|d| d.0))
                .filter(|pass| loads(&scene.passes[*pass], index)),
            changes: drawn.clone().any(|(draws, resolves, _)| draws || resolves),
        })
    }

    /// Records the initial contents, unless a pass clears the attachment. An attachment that no
    /// pass changes is uploaded only the `first` time.
    pub(crate) fn initialise(&self, encoder: &mut wgpu::CommandEncoder, first: bool) {
        match &self.initial {
            InitialContents::Upload(buffer, pitch) => {
                if self.changes || first {
                    self.upload(encoder, buffer, *pitch);
                }
            }
            InitialContents::Color(_) if self.cleared_by.is_none() => {
                let attachment = [Some(self.as_color(None, None, Operations::default()))];
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: &attachment,
                    ..wgpu::RenderPassDescriptor::default()
                });
            }
            InitialContents::DepthStencil(..) if self.cleared_by.is_none() => {
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    depth_stencil_attachment: Some(
                        self.as_depth_stencil(None, &PassOperations::default()),
                    ),
                    ..wgpu::RenderPassDescriptor::default()
                });
            }
            InitialContents::Color(_) | InitialContents::DepthStencil(..) => {}
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
        let target = self.target.copied(wgpu::TextureAspect::All, [0, 0]);
        encoder.copy_buffer_to_texture(source, target, extent(self.size));
    }

    /// Returns the attachment for a pass of the scene, or for a pass that only clears it.
    pub(crate) fn as_color<'s>(
        &'s self,
        pass: Option<usize>,
        resolve: Option<&'s wgpu::TextureView>,
        operations: Operations<[f32; 4]>,
    ) -> wgpu::RenderPassColorAttachment<'s> {
        let initial = match self.initial {
            InitialContents::Color(color) if self.cleared_by == pass => Some(color),
            _ => None,
        };
        let cleared = operations.load.clear_value().map(state::color);
        wgpu::RenderPassColorAttachment {
            view: &self.target.view,
            depth_slice: self.target.slice(),
            resolve_target: resolve,
            ops: both(cleared.or(initial), operations.store),
        }
    }

    /// Returns the attachment for a pass of the scene, or for a pass that only clears it.
    pub(crate) fn as_depth_stencil(
        &self,
        pass: Option<usize>,
        operations: &PassOperations,
    ) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        let (depth, stencil) = match self.initial {
            InitialContents::DepthStencil(depth, stencil) if self.cleared_by == pass => {
                (Some(depth), Some(stencil))
            }
            _ => (None, None),
        };
        let cleared = operations.depth.load.clear_value();
        let depth = both(cleared.or(depth), operations.depth.store);
        let cleared = operations.stencil.load.clear_value().map(u32::from);
        let stencil = both(cleared.or(stencil), operations.stencil.store);
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.target.view,
            depth_ops: self.format.has_depth().then_some(depth),
            stencil_ops: self.format.has_stencil().then_some(stencil),
        }
    }

    /// Returns the attachment for a read-only pass.
    pub(crate) fn as_read_only(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.target.view,
            depth_ops: None,
            stencil_ops: None,
        }
    }
}

/// True if a pass loads all aspects of an attachment that it draws to.
fn loads(pass: &Pass, index: usize) -> bool {
    let mut colors = pass.color.iter().enumerate();
    let PassOperations { depth, stencil, .. } = &pass.operations;
    match colors.find(|(_, color)| **color == index) {
        Some((location, _)) => pass.color_operations(location).load == LoadOperation::Load,
        None => depth.load == LoadOperation::Load && stencil.load == LoadOperation::Load,
    }
}

/// Returns wgpu's operations of an aspect: a clear with this value, or a load.
fn both<V>(cleared: Option<V>, store: StoreOperation) -> wgpu::Operations<V> {
    wgpu::Operations {
        load: cleared.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
        store: match store {
            StoreOperation::Store => wgpu::StoreOp::Store,
            StoreOperation::Discard => wgpu::StoreOp::Discard,
        },
    }
}

/// Returns the bytes of codes with padded rows, and the distance between rows.
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
