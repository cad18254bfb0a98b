//! GL's texel formats.

use crate::codes;
use etalon_frame::{PathViews, TextureFormat};

/// GL's description of a format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GlFormat {
    pub(crate) internal: u32,
    /// The format and type of a client image that every version accepts.
    pub(crate) format: u32,
    pub(crate) kind: u32,
    pub(crate) attachment: u32,
}

/// Returns GL's description of a format. `bgra8unorm` and `bgra8unorm-srgb` have none: GL's `BGRA` is an order
/// in client memory, and the order of channels in a texture is unspecified.
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
        TextureFormat::R16Unorm => color(glow::R16, RED, UNSIGNED_SHORT),
        TextureFormat::Rg16Unorm => color(glow::RG16, RG, UNSIGNED_SHORT),
        TextureFormat::Rgba16Unorm => color(glow::RGBA16, RGBA, UNSIGNED_SHORT),
        TextureFormat::Rgba8Unorm => color(glow::RGBA8, RGBA, UNSIGNED_BYTE),
        TextureFormat::Rgba8UnormSrgb => color(glow::SRGB8_ALPHA8, RGBA, UNSIGNED_BYTE),
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => return None,
        TextureFormat::R8Snorm => color(glow::R8_SNORM, RED, BYTE),
        TextureFormat::Rg8Snorm => color(glow::RG8_SNORM, RG, BYTE),
        TextureFormat::Rgba8Snorm => color(glow::RGBA8_SNORM, RGBA, BYTE),
        TextureFormat::Rgb10a2Unorm => color(glow::RGB10_A2, RGBA, UNSIGNED_INT_2_10_10_10_REV),
        TextureFormat::B5g6r5Unorm => color(glow::RGB565, RGB, UNSIGNED_SHORT_5_6_5),
        TextureFormat::Bgr5a1Unorm => color(glow::RGB5_A1, RGBA, UNSIGNED_SHORT_5_5_5_1),
        TextureFormat::Bgra4Unorm => color(glow::RGBA4, RGBA, UNSIGNED_SHORT_4_4_4_4),
        TextureFormat::Rg11b10Ufloat => {
            color(glow::R11F_G11F_B10F, RGB, UNSIGNED_INT_10F_11F_11F_REV)
        }
        TextureFormat::R8Uint => color(glow::R8UI, glow::RED_INTEGER, UNSIGNED_BYTE),
        TextureFormat::Rgba8Uint => color(glow::RGBA8UI, RGBA_INTEGER, UNSIGNED_BYTE),
        TextureFormat::Rgb10a2Uint => {
            color(glow::RGB10_A2UI, RGBA_INTEGER, UNSIGNED_INT_2_10_10_10_REV)
        }
        TextureFormat::R16Uint => color(glow::R16UI, glow::RED_INTEGER, UNSIGNED_SHORT),
        TextureFormat::Rg16Uint => color(glow::RG16UI, glow::RG_INTEGER, UNSIGNED_SHORT),
        TextureFormat::Rgba16Uint => color(glow::RGBA16UI, RGBA_INTEGER, UNSIGNED_SHORT),
        TextureFormat::R16Float => color(glow::R16F, RED, HALF_FLOAT),
        TextureFormat::Rg16Float => color(glow::RG16F, RG, HALF_FLOAT),
        TextureFormat::Rgba16Float => color(glow::RGBA16F, RGBA, HALF_FLOAT),
        TextureFormat::R32Float => color(glow::R32F, RED, FLOAT),
        TextureFormat::Rg32Float => color(glow::RG32F, RG, FLOAT),
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

/// Returns the internal format of a texture whose attachment view has this format. `None` if the path does
/// not apply to the format (OpenGL 4.6, table 8.22).
pub(crate) fn viewed(format: TextureFormat, views: PathViews) -> Option<u32> {
    let in_class = !matches!(
        format,
        TextureFormat::B5g6r5Unorm | TextureFormat::Bgr5a1Unorm | TextureFormat::Bgra4Unorm
    );
    match views {
        PathViews::Srgb if format == TextureFormat::Rgba8Unorm => Some(glow::SRGB8_ALPHA8),
        PathViews::Srgb if format == TextureFormat::Rgba8UnormSrgb => Some(glow::RGBA8),
        PathViews::Uint if format.is_color() && in_class => match codes::texel_bytes(format) {
            1 => Some(glow::R8UI),
            2 => Some(glow::R16UI),
            4 => Some(glow::R32UI),
            8 => Some(glow::RG32UI),
            16 => Some(glow::RGBA32UI),
            _ => None,
        },
        PathViews::Same | PathViews::Srgb | PathViews::Uint => None,
    }
}

fn color(internal: u32, format: u32, kind: u32) -> (u32, u32, u32, u32) {
    (internal, format, kind, glow::COLOR_ATTACHMENT0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attachments_are_views_of_formats_of_their_class() {
        let srgb = |format| viewed(format, PathViews::Srgb);
        let (unorm, converted) = (TextureFormat::Rgba8Unorm, TextureFormat::Rgba8UnormSrgb);
        assert_eq!(srgb(unorm), gl_format(converted).map(|f| f.internal));
        assert_eq!(srgb(converted), gl_format(unorm).map(|f| f.internal));
        let integers = TextureFormat::ALL.map(|format| viewed(format, PathViews::Uint));
        assert_eq!(integers.iter().flatten().count(), 26);
        assert!(integers.contains(&Some(glow::RGBA32UI)));
        assert_eq!(viewed(unorm, PathViews::Same), None);
    }
}
