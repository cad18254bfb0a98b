//! The attachments of a scene and their initial contents.

use crate::calls::{
    Access, BufferRows, ColorAttachment, DepthStencilAttachment, EncoderCommand, Filled,
    RenderPass, TextureAspect, buffer_usage,
};
use crate::path;
use crate::tables::{Lowering, TextureTarget};
use crate::texel;
use etalon_frame::{Requirement, TextureFormat};
use etalon_scene::{
    AttachmentContents, LoadOperation, Operations, Pass, PassOperations, Scene, StoreOperation,
};

/// The alignment of rows in a copy, in bytes (GPUTexelCopyBufferLayout).
pub(crate) const PITCH: u32 = 256;

/// An attachment of a scene.
pub(crate) struct Attached {
    pub(crate) target: TextureTarget,
    format: TextureFormat,
    size: [u32; 2],
    initial: InitialTexels,
    /// The pass that clears it: the first pass that uses it, if that pass draws to it and loads all of it.
    /// `None` if a separate pass clears it.
    cleared_by: Option<usize>,
    /// True if a pass writes to the attachment.
    changes: bool,
}

/// The initial contents of an attachment.
enum InitialTexels {
    Color([f32; 4]),
    DepthStencil(f32, u32),
    /// Rows in a buffer.
    Upload(BufferRows),
}

impl Attached {
    pub(crate) fn new(
        lowering: &mut Lowering<'_>,
        scene: &Scene,
        index: usize,
    ) -> Result<Self, Requirement> {
        let attachment = &scene.attachments[index];
        let (format, size) = (attachment.format, attachment.size);
        let upload = |lowering: &mut Lowering<'_>, codes: &[u32]| {
            let (bytes, pitch) = rows(format, size[0], codes);
            InitialTexels::Upload(BufferRows {
                buffer: lowering.filled(buffer_usage::COPY_SRC, bytes),
                offset: 0,
                pitch,
            })
        };
        let initial = match &attachment.contents {
            AttachmentContents::Texels(codes) => upload(lowering, codes),
            AttachmentContents::DepthStencil { depth, stencil } => {
                InitialTexels::DepthStencil(*depth, (*stencil).into())
            }
            AttachmentContents::Color(color) if lowering.device.draws(format) => {
                InitialTexels::Color(*color)
            }
            // The API cannot clear it, so the nearest codes are uploaded.
            AttachmentContents::Color(color) => {
                let channels = format.color_channels().iter().zip(color);
                let texel: Vec<_> = channels.map(|(e, v)| e.nearest_code((*v).into())).collect();
                let texels = size[0] as usize * size[1] as usize;
                upload(lowering, &texel.repeat(texels))
            }
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
        let place = path::target(scene, index, lowering.device.abilities);
        let views = scene.path.views;
        Ok(Self {
            target: lowering.attachment(format, size, attachment.samples, place, views)?,
            format,
            size,
            initial,
            cleared_by: first
                .filter(|pass| drawn.clone().nth(*pass).is_some_and(|d| d.0))
                .filter(|pass| loads(&scene.passes[*pass], index)),
            changes: drawn.clone().any(|(draws, resolves, _)| draws || resolves),
        })
    }

    /// Adds the commands of the initial contents, unless a pass clears the attachment. Uploads go to `first`
    /// if no pass changes the attachment, and to `each` otherwise.
    pub(crate) fn initialise(
        &self,
        lowering: &mut Lowering<'_>,
        first: &mut Vec<EncoderCommand>,
        each: &mut Vec<EncoderCommand>,
    ) {
        match self.initial {
            InitialTexels::Upload(from) => {
                let commands = if self.changes { each } else { first };
                commands.push(EncoderCommand::Upload {
                    from,
                    to: self.target.copied(TextureAspect::All, [0, 0]),
                    size: self.size,
                });
            }
            InitialTexels::Color(_) if self.cleared_by.is_none() => {
                let color = self.as_color(lowering, None, None, Operations::default());
                each.push(EncoderCommand::Pass(RenderPass {
                    color: vec![Some(color)],
                    ..RenderPass::default()
                }));
            }
            InitialTexels::DepthStencil(..) if self.cleared_by.is_none() => {
                let attachment = self.as_depth_stencil(lowering, None, &PassOperations::default());
                each.push(EncoderCommand::Pass(RenderPass {
                    depth_stencil: Some(attachment),
                    ..RenderPass::default()
                }));
            }
            InitialTexels::Color(_) | InitialTexels::DepthStencil(..) => {}
        }
    }

    /// Returns the attachment for a pass of the scene, or, if `pass` is `None`, for a pass that only clears
    /// it.
    pub(crate) fn as_color(
        &self,
        lowering: &mut Lowering<'_>,
        pass: Option<usize>,
        resolve: Option<usize>,
        operations: Operations<[f32; 4]>,
    ) -> ColorAttachment {
        let initial = match self.initial {
            InitialTexels::Color(color) if self.cleared_by == pass => Some(color),
            _ => None,
        };
        ColorAttachment {
            view: lowering.view(self.target),
            depth_slice: self.target.slice(),
            resolve,
            operations: filled(operations.load.clear_value().or(initial), operations.store),
        }
    }

    /// Returns the attachment for a pass of the scene, or, if `pass` is `None`, for a pass that only clears
    /// it.
    pub(crate) fn as_depth_stencil(
        &self,
        lowering: &mut Lowering<'_>,
        pass: Option<usize>,
        operations: &PassOperations,
    ) -> DepthStencilAttachment {
        let (depth, stencil) = match self.initial {
            InitialTexels::DepthStencil(depth, stencil) if self.cleared_by == pass => {
                (Some(depth), Some(stencil))
            }
            _ => (None, None),
        };
        let cleared = operations.depth.load.clear_value();
        let depth = filled(cleared.or(depth), operations.depth.store);
        let cleared = operations.stencil.load.clear_value().map(u32::from);
        let stencil = filled(cleared.or(stencil), operations.stencil.store);
        self.accessed(lowering, Access::Written(depth), Access::Written(stencil))
    }

    /// Returns the attachment for a read-only pass.
    pub(crate) fn as_read_only(&self, lowering: &mut Lowering<'_>) -> DepthStencilAttachment {
        self.accessed(lowering, Access::ReadOnly, Access::ReadOnly)
    }

    fn accessed(
        &self,
        lowering: &mut Lowering<'_>,
        depth: Access<f32>,
        stencil: Access<u32>,
    ) -> DepthStencilAttachment {
        accessed(lowering, self.target, self.format, depth, stencil)
    }
}

/// Returns an attachment with the aspects that the format has.
pub(crate) fn accessed(
    lowering: &mut Lowering<'_>,
    target: TextureTarget,
    format: TextureFormat,
    depth: Access<f32>,
    stencil: Access<u32>,
) -> DepthStencilAttachment {
    DepthStencilAttachment {
        view: lowering.view(target),
        depth: if format.has_depth() {
            depth
        } else {
            Access::Absent
        },
        stencil: if format.has_stencil() {
            stencil
        } else {
            Access::Absent
        },
    }
}

/// Returns true if a pass draws to an attachment and loads all of its aspects.
fn loads(pass: &Pass, index: usize) -> bool {
    let mut colors = pass.color.iter().enumerate();
    let PassOperations { depth, stencil, .. } = &pass.operations;
    match colors.find(|(_, color)| **color == index) {
        Some((location, _)) => pass.color_operations(location).load == LoadOperation::Load,
        None => depth.load == LoadOperation::Load && stencil.load == LoadOperation::Load,
    }
}

fn filled<V>(clear: Option<V>, store: StoreOperation) -> Filled<V> {
    Filled {
        clear,
        store: store == StoreOperation::Store,
    }
}

/// Returns the bytes of codes, in rows padded to [`PITCH`], and the distance between rows in bytes.
fn rows(format: TextureFormat, width: u32, codes: &[u32]) -> (Vec<u8>, u32) {
    let row = width * texel::bytes(format) as u32;
    let pitch = row.next_multiple_of(PITCH);
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
