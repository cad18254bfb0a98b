//! The facts about a device that lowering needs.

use crate::calls::texture_usage::{COPY_DST, COPY_SRC, RENDER_ATTACHMENT, TEXTURE_BINDING};
use etalon_frame::{ChannelEncoding, Limits, ReadPath, TextureFormat};

/// WebGPU's only sample count above 1 (GPUTextureDescriptor, sampleCount).
pub const SAMPLES: u32 = 4;

/// The facts about a device that lowering uses.
#[derive(Clone, Debug)]
pub struct Device {
    /// The limits and features that scenes can use.
    pub limits: Limits,
    /// Abilities that [`Limits`] do not include.
    pub abilities: Abilities,
    /// The largest side of a 2D texture.
    pub max_texture_2d: u32,
    /// The largest side of a 3D texture.
    pub max_texture_3d: u32,
    /// The alignment of the offset of a bound uniform buffer, in bytes.
    pub uniform_alignment: u32,
    /// The alignment of the offset of a bound storage buffer, in bytes.
    pub storage_alignment: u32,
    /// True if the first instance of an indirect draw can be other than 0 (feature `indirect-first-instance`).
    pub indirect_first_instance: bool,
}

impl Device {
    /// Returns true if attachments of the format can be drawn to.
    pub fn draws(&self, format: TextureFormat) -> bool {
        let support = self.limits.formats.get(&format);
        support.is_some_and(|support| !support.samples.is_empty())
    }
}

/// Abilities of a device that [`Limits`] do not include.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Abilities {
    /// True if depth and stencil can be copied to buffers.
    pub copies: bool,
    /// True if textures can have views of other formats, such as sRGB without conversion.
    pub casts: bool,
    /// True if shaders can read one layer of a texture that has several.
    pub layers: bool,
}

/// Returns the usages that a single-sample texture of this format needs in addition to rendering.
pub fn texture_usages(format: TextureFormat) -> u32 {
    let read = TEXTURE_BINDING | COPY_SRC;
    if format.is_color() {
        read | COPY_DST
    } else {
        read
    }
}

/// Returns the usages of a texture for an attachment.
pub(crate) fn attachment_usages(device: &Device, format: TextureFormat, samples: u32) -> u32 {
    if samples > 1 {
        return TEXTURE_BINDING | RENDER_ATTACHMENT;
    }
    let mut usages = texture_usages(format);
    if device.draws(format) {
        usages |= RENDER_ATTACHMENT;
    }
    // A copy of depth goes to another texture of its format.
    if device.abilities.copies {
        usages |= COPY_DST;
    }
    usages
}

/// Returns how the depth, or else the colour, of a format is read. WebGPU never copies the depth of
/// `depth24plus` (26.1.2).
pub(crate) fn read_path(format: TextureFormat, abilities: Abilities) -> ReadPath {
    match format {
        TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8 => ReadPath::Shader,
        TextureFormat::Depth16Unorm
        | TextureFormat::Depth32Float
        | TextureFormat::Depth32FloatStencil8
            if !abilities.copies =>
        {
            ReadPath::Shader
        }
        _ => ReadPath::Copy,
    }
}

/// Returns true if the codes of multisampled attachments, which only a shader can read, are as exact as
/// [`read_path`] promises.
///
/// Floats are exact. For normalized integers, the API allows an error of one part in 10^5 (Vulkan,
/// Fundamentals; OpenGL 4.6, 2.3.5), which determines codes of up to 10 bits, but not of 16. Two codes of a
/// signed integer mean -1. An sRGB code is exact only in a view without conversion.
pub(crate) fn samples_are_exact(format: TextureFormat, abilities: Abilities) -> bool {
    let exact = |encoding: &ChannelEncoding| match encoding {
        ChannelEncoding::Snorm(_) => false,
        ChannelEncoding::Srgb8 => abilities.casts,
        ChannelEncoding::Unorm(bits) => *bits <= 10,
        _ => true,
    };
    read_path(format, abilities) == ReadPath::Shader
        || format.color_channels().iter().all(exact)
            && (!format.has_depth() || format.depth_encodings() == [ChannelEncoding::Float32])
}
