//! The tables of a list while lowering fills them.

use crate::calls::{
    BindGroup, Buffer, CallList, LayoutEntry, Shader, Texture, TextureAspect, TextureDimension,
    TexturePart, TextureView, buffer_usage, texture_usage,
};
use crate::device::{Device, attachment_usages, read_path, texture_usages};
use crate::format::GpuFormat;
use crate::path::{AttachmentTexture, ReadingPath as ReadingAbility};
use crate::pipeline_state::{PipelineState, RenderPipeline};
use etalon_frame::{
    Feature, PathTarget, PathValue, PathViews, ReadPath, Requirement, TextureFormat,
};
use etalon_scene::Sampler;
use std::borrow::Cow;

/// The WGSL attribute of inputs that are not interpolated.
const FLAT: &str = "@interpolate(flat)";

/// A texture, or the part of one that an attachment is.
#[derive(Clone, Copy)]
pub(crate) struct TextureTarget {
    pub(crate) texture: usize,
    /// The format of views.
    pub(crate) format: GpuFormat,
    /// The format of the texture.
    stored: GpuFormat,
    pub(crate) samples: u32,
    shape: AttachmentTexture,
}

impl TextureTarget {
    /// Returns the slice that passes draw to, if the texture is a 3D texture.
    pub(crate) fn slice(&self) -> Option<u32> {
        self.shape.slice()
    }

    /// Returns the part that copies take, beginning at a texel.
    pub(crate) fn copied(&self, aspect: TextureAspect, [x, y]: [u32; 2]) -> TexturePart {
        TexturePart {
            texture: self.texture,
            level: self.shape.level,
            origin: [x, y, self.shape.layer],
            aspect,
        }
    }
}

/// The tables of a list while lowering fills them.
pub(crate) struct Lowering<'a> {
    pub(crate) device: &'a Device,
    pub(crate) list: CallList,
}

/// Returns the index of an item in a table. A new item is added at the end.
fn place<T: PartialEq>(table: &mut Vec<T>, item: T) -> usize {
    table
        .iter()
        .position(|known| *known == item)
        .unwrap_or_else(|| {
            table.push(item);
            table.len() - 1
        })
}

impl Lowering<'_> {
    /// Returns the texture of an attachment, with undefined contents.
    pub(crate) fn attachment(
        &mut self,
        format: TextureFormat,
        size: [u32; 2],
        samples: u32,
        target: PathTarget,
        views: PathViews,
    ) -> Result<TextureTarget, Requirement> {
        let shape = AttachmentTexture::of(target, size);
        let most = match shape.dimension {
            TextureDimension::D2 => self.device.max_texture_2d,
            TextureDimension::D3 => self.device.max_texture_3d,
        };
        if target != PathTarget::Plain && shape.size[0].max(shape.size[1]) > most {
            return Err(Requirement::Path(PathValue::Target(target)));
        }
        let usage = attachment_usages(self.device, format, samples);
        let format = GpuFormat::of(format)?;
        let stored = match views {
            PathViews::Srgb => format.other_srgb(),
            PathViews::Same | PathViews::Uint => None,
        };
        Ok(self.texture(format, stored.unwrap_or(format), shape, samples, usage))
    }

    /// Returns a texture that a fetch renders to, with undefined contents.
    pub(crate) fn scratch(&mut self, format: GpuFormat, size: [u32; 2]) -> TextureTarget {
        let usage = texture_usages(TextureFormat::Rgba8Unorm) | texture_usage::RENDER_ATTACHMENT;
        let shape = AttachmentTexture::of(PathTarget::Plain, size);
        self.texture(format, format, shape, 1, usage)
    }

    fn texture(
        &mut self,
        format: GpuFormat,
        stored: GpuFormat,
        shape: AttachmentTexture,
        samples: u32,
        usage: u32,
    ) -> TextureTarget {
        let codes = || format.without_srgb().filter(|_| samples > 1);
        self.list.textures.push(Texture {
            size: shape.size,
            levels: shape.levels,
            samples,
            dimension: shape.dimension,
            format: stored,
            usage,
            view_format: if stored == format {
                codes()
            } else {
                Some(format)
            },
        });
        TextureTarget {
            texture: self.list.textures.len() - 1,
            format,
            stored,
            samples,
            shape,
        }
    }

    /// Returns the view of all aspects, for passes.
    pub(crate) fn view(&mut self, target: TextureTarget) -> usize {
        self.seen(target, TextureAspect::All, target.format)
    }

    /// Returns the view of colour or depth, for fetches.
    pub(crate) fn fetched(&mut self, target: TextureTarget) -> usize {
        let aspect = if target.format.has_depth() {
            TextureAspect::DepthOnly
        } else {
            TextureAspect::All
        };
        // The samples of an sRGB texture are fetched as codes, without conversion.
        let codes = target.format.without_srgb().filter(|_| target.samples > 1);
        self.seen(target, aspect, codes.unwrap_or(target.format))
    }

    /// Returns the view of stencil, for fetches.
    pub(crate) fn fetched_stencil(&mut self, target: TextureTarget) -> usize {
        self.seen(target, TextureAspect::StencilOnly, target.format)
    }

    fn seen(&mut self, target: TextureTarget, aspect: TextureAspect, format: GpuFormat) -> usize {
        let shape = target.shape;
        let flat = shape.dimension == TextureDimension::D2;
        let view = TextureView {
            texture: target.texture,
            part: flat.then_some([shape.level, shape.layer]),
            aspect,
            format: (format != target.stored).then_some(format),
        };
        place(&mut self.list.views, view)
    }

    /// Returns a buffer with undefined contents.
    pub(crate) fn buffer(&mut self, usage: u32, size: u64) -> usize {
        self.list.buffers.push(Buffer {
            size,
            usage,
            contents: Vec::new(),
        });
        self.list.buffers.len() - 1
    }

    /// Sets the contents of a buffer. Their length must be a multiple of 4.
    pub(crate) fn fill(&mut self, buffer: usize, contents: Vec<u8>) {
        let filled = &mut self.list.buffers[buffer];
        filled.size = filled.size.max(contents.len() as u64);
        filled.contents = contents;
    }

    /// Returns a buffer with these contents, whose length must be a multiple of 4.
    pub(crate) fn filled(&mut self, usage: u32, contents: Vec<u8>) -> usize {
        let buffer = self.buffer(usage | buffer_usage::COPY_DST, 0);
        self.fill(buffer, contents);
        buffer
    }

    /// Returns a shader module. If the device does not promise which vertex gives flat values, the module
    /// must accept either; scenes that depend on the vertex are not lowered for such a device.
    pub(crate) fn shader(&mut self, label: &'static str, mut code: Cow<'static, str>) -> usize {
        let first = Feature::FirstProvokingVertex;
        if !self.device.limits.features.contains(&first) && code.contains(FLAT) {
            code = code.replace(FLAT, "@interpolate(flat, either)").into();
        }
        let label = label.into();
        place(&mut self.list.shaders, Shader { label, code })
    }

    pub(crate) fn layout(&mut self, entries: Vec<LayoutEntry>) -> usize {
        place(&mut self.list.layouts, entries)
    }

    pub(crate) fn sampler(&mut self, sampler: Sampler) -> usize {
        place(&mut self.list.samplers, sampler)
    }

    pub(crate) fn group(&mut self, group: BindGroup) -> usize {
        place(&mut self.list.groups, group)
    }

    pub(crate) fn pipeline(
        &mut self,
        shader: usize,
        layout: Option<usize>,
        state: PipelineState,
    ) -> usize {
        let pipeline = RenderPipeline {
            shader,
            layout,
            state,
        };
        place(&mut self.list.pipelines, pipeline)
    }

    /// Returns how attachments of a format are read by default.
    pub(crate) fn reading(&self, format: TextureFormat) -> ReadingAbility {
        let abilities = self.device.abilities;
        ReadingAbility {
            copies: abilities.copies,
            fetches: read_path(format, abilities) == ReadPath::Shader,
        }
    }
}
