//! GL's texel formats.

use etalon_frame::TextureFormat;

/// GL's description of a format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GlFormat {
    pub(crate) internal: u32,
    /// Format and type of a client image that every version accepts.
    pub(crate) format: u32,
    pub(crate) kind: u32,
    pub(crate) attachment: u32,
}

/// Returns GL's description of a format. There is none of `bgra8unorm`: GL's `BGRA` is an order in
/// client memory, and the order of channels in a texture is unspecified.
pub(crate) fn gl_format(format: TextureFormat) -> Option<GlFormat> {
    use glow::{
        BYTE, DEPTH_ATTACHMENT, DEPTH_COMPONENT, DEPTH_STENCIL, DEPTH_STENCIL_ATTACHMENT, FLOAT,
        HALF_FLOAT, RED, RG, RGB, RGBA, RGBA_INTEGER, STENCIL_ATTACHMENT, UNSIGNED_BYTE,
        UNSIGNED_INT, UNSIGNED_INT_2_10_10_10_REV, UNSIGNED_INT_10F_11F_11F_REV, UNSIGNED_SHORT,
        UNSIGNED_SHORT_4_4_4_4, UNSIGNED_SHORT_5_5_5_1, UNSIGNED_SHORT_5_6_5,
    };
    let packed_float_stencil = glow::FLOAT_32_UNSIGNED_INT_24_8_REV;
    let (internal, format, kind, attachment) = match format {
        TextureFormat::R8Unorm => color(glow::R8, RED, UNSIGNED_BYTE),
        TextureFormat::Rg8Unorm => color(glow::RG8, RG, UNSIGNED_BYTE),
        TextureFormat::Rgba8Unorm => color(glow::RGBA8, RGBA, UNSIGNED_BYTE),
        TextureFormat::Rgba8UnormSrgb => color(glow::SRGB8_ALPHA8, RGBA, UNSIGNED_BYTE),
        TextureFormat::Bgra8Unorm => return None,
        TextureFormat::Rgba8Snorm => color(glow::RGBA8_SNORM, RGBA, BYTE),
        TextureFormat::Rgb10a2Unorm => color(glow::RGB10_A2, RGBA, UNSIGNED_INT_2_10_10_10_REV),
        TextureFormat::B5g6r5Unorm => color(glow::RGB565, RGB, UNSIGNED_SHORT_5_6_5),
        TextureFormat::Bgr5a1Unorm => color(glow::RGB5_A1, RGBA, UNSIGNED_SHORT_5_5_5_1),
        TextureFormat::Bgra4Unorm => color(glow::RGBA4, RGBA, UNSIGNED_SHORT_4_4_4_4),
        TextureFormat::Rg11b10Ufloat => {
            color(glow::R11F_G11F_B10F, RGB, UNSIGNED_INT_10F_11F_11F_REV)
        }
        TextureFormat::Rgba8Uint => color(glow::RGBA8UI, RGBA_INTEGER, UNSIGNED_BYTE),
        TextureFormat::Rgba16Float => color(glow::RGBA16F, RGBA, HALF_FLOAT),
        TextureFormat::Rgba32Float => color(glow::RGBA32F, RGBA, FLOAT),
        TextureFormat::Depth16Unorm => (
            glow::DEPTH_COMPONENT16,
            DEPTH_COMPONENT,
            UNSIGNED_SHORT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth24Plus => (
            glow::DEPTH_COMPONENT24,
            DEPTH_COMPONENT,
            UNSIGNED_INT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth24PlusStencil8 => (
            glow::DEPTH24_STENCIL8,
            DEPTH_STENCIL,
            glow::UNSIGNED_INT_24_8,
            DEPTH_STENCIL_ATTACHMENT,
        ),
        TextureFormat::Depth32Float => (
            glow::DEPTH_COMPONENT32F,
            DEPTH_COMPONENT,
            FLOAT,
            DEPTH_ATTACHMENT,
        ),
        TextureFormat::Depth32FloatStencil8 => (
            glow::DEPTH32F_STENCIL8,
            DEPTH_STENCIL,
            packed_float_stencil,
            DEPTH_STENCIL_ATTACHMENT,
        ),
        TextureFormat::Stencil8 => (
            glow::STENCIL_INDEX8,
            glow::STENCIL_INDEX,
            UNSIGNED_BYTE,
            STENCIL_ATTACHMENT,
        ),
    };
    Some(GlFormat {
        internal,
        format,
        kind,
        attachment,
    })
}

fn color(internal: u32, format: u32, kind: u32) -> (u32, u32, u32, u32) {
    (internal, format, kind, glow::COLOR_ATTACHMENT0)
}
