//! Vulkan formats and the layout of their texels in buffers.

use crate::device::Device;
use ash::vk;
use etalon_backend::BackendError;
use etalon_backend::codes::{self, TexelLayout};
use etalon_frame::{Aspect, ChannelEncoding, PathViews, Requirement, TextureFormat};
use std::collections::BTreeMap;

/// The Vulkan format that this device uses for a texture format.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Native {
    pub(crate) raw: vk::Format,
    /// True if the format can be an attachment.
    pub(crate) attachment: bool,
    /// True if attachments of the format can be blended.
    pub(crate) blendable: bool,
}

/// Returns the Vulkan format that the device uses for a texture format.
pub(crate) fn native(
    natives: &BTreeMap<TextureFormat, Native>,
    format: TextureFormat,
) -> Result<Native, BackendError> {
    let native = natives.get(&format).copied();
    native.ok_or(BackendError::NotSupported(Requirement::Format(format)))
}

/// Returns the candidates for a format, best first. They have the same channels with the same widths, in the
/// order that [`layout`] gives. WebGPU leaves open the depth of `depth24plus`, and whether `stencil8` has a
/// depth aspect.
fn candidates(format: TextureFormat) -> &'static [vk::Format] {
    match format {
        TextureFormat::R8Unorm => &[vk::Format::R8_UNORM],
        TextureFormat::Rg8Unorm => &[vk::Format::R8G8_UNORM],
        TextureFormat::R16Unorm => &[vk::Format::R16_UNORM],
        TextureFormat::Rg16Unorm => &[vk::Format::R16G16_UNORM],
        TextureFormat::Rgba16Unorm => &[vk::Format::R16G16B16A16_UNORM],
        TextureFormat::Rgba8Unorm => &[vk::Format::R8G8B8A8_UNORM],
        TextureFormat::Rgba8UnormSrgb => &[vk::Format::R8G8B8A8_SRGB, vk::Format::B8G8R8A8_SRGB],
        TextureFormat::Bgra8Unorm => &[vk::Format::B8G8R8A8_UNORM],
        TextureFormat::Bgra8UnormSrgb => &[vk::Format::B8G8R8A8_SRGB],
        TextureFormat::R8Snorm => &[vk::Format::R8_SNORM],
        TextureFormat::Rg8Snorm => &[vk::Format::R8G8_SNORM],
        TextureFormat::Rgba8Snorm => &[vk::Format::R8G8B8A8_SNORM],
        TextureFormat::Rgb10a2Unorm => &[
            vk::Format::A2B10G10R10_UNORM_PACK32,
            vk::Format::A2R10G10B10_UNORM_PACK32,
        ],
        TextureFormat::B5g6r5Unorm => &[
            vk::Format::R5G6B5_UNORM_PACK16,
            vk::Format::B5G6R5_UNORM_PACK16,
        ],
        TextureFormat::Bgr5a1Unorm => &[
            vk::Format::A1R5G5B5_UNORM_PACK16,
            vk::Format::R5G5B5A1_UNORM_PACK16,
            vk::Format::B5G5R5A1_UNORM_PACK16,
        ],
        TextureFormat::Bgra4Unorm => &[
            vk::Format::B4G4R4A4_UNORM_PACK16,
            vk::Format::R4G4B4A4_UNORM_PACK16,
        ],
        TextureFormat::Rg11b10Ufloat => &[vk::Format::B10G11R11_UFLOAT_PACK32],
        TextureFormat::R8Uint => &[vk::Format::R8_UINT],
        TextureFormat::Rgba8Uint => &[vk::Format::R8G8B8A8_UINT],
        TextureFormat::Rgb10a2Uint => &[vk::Format::A2B10G10R10_UINT_PACK32],
        TextureFormat::R16Uint => &[vk::Format::R16_UINT],
        TextureFormat::Rg16Uint => &[vk::Format::R16G16_UINT],
        TextureFormat::Rgba16Uint => &[vk::Format::R16G16B16A16_UINT],
        TextureFormat::R16Float => &[vk::Format::R16_SFLOAT],
        TextureFormat::Rg16Float => &[vk::Format::R16G16_SFLOAT],
        TextureFormat::Rgba16Float => &[vk::Format::R16G16B16A16_SFLOAT],
        TextureFormat::R32Float => &[vk::Format::R32_SFLOAT],
        TextureFormat::Rg32Float => &[vk::Format::R32G32_SFLOAT],
        TextureFormat::Rgba32Float => &[vk::Format::R32G32B32A32_SFLOAT],
        TextureFormat::Depth16Unorm => &[vk::Format::D16_UNORM],
        TextureFormat::Depth24Plus => &[vk::Format::X8_D24_UNORM_PACK32, vk::Format::D32_SFLOAT],
        TextureFormat::Depth24PlusStencil8 => &[
            vk::Format::D24_UNORM_S8_UINT,
            vk::Format::D32_SFLOAT_S8_UINT,
        ],
        TextureFormat::Depth32Float => &[vk::Format::D32_SFLOAT],
        TextureFormat::Depth32FloatStencil8 => &[vk::Format::D32_SFLOAT_S8_UINT],
        TextureFormat::Stencil8 => &[
            vk::Format::S8_UINT,
            vk::Format::D24_UNORM_S8_UINT,
            vk::Format::D32_SFLOAT_S8_UINT,
        ],
    }
}

/// Returns the formats that the device supports, with what [`etalon_frame::Limits::formats`] promises.
/// Colours can be copied and fetched, and sampled linearly unless they hold integers or 32-bit floats (Vulkan
/// requires this of each first candidate). Depth and stencil can be copied and attached. A candidate that can
/// be attached is preferred.
pub(crate) fn natives(device: &Device) -> BTreeMap<TextureFormat, Native> {
    let transfer = vk::FormatFeatureFlags::TRANSFER_SRC | vk::FormatFeatureFlags::TRANSFER_DST;
    let mut natives = BTreeMap::new();
    for format in TextureFormat::ALL {
        let (needed, attachment) = if format.is_color() {
            let mut sampled = vk::FormatFeatureFlags::SAMPLED_IMAGE;
            if format.is_filterable() {
                sampled |= vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
            }
            (transfer | sampled, vk::FormatFeatureFlags::COLOR_ATTACHMENT)
        } else {
            let tested = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
            (transfer | tested, tested)
        };
        let mut usable = Vec::new();
        for raw in candidates(format) {
            // SAFETY: the physical device is of this living instance.
            let properties = unsafe {
                device
                    .instance
                    .raw()
                    .get_physical_device_format_properties(device.physical, *raw)
            };
            let has = properties.optimal_tiling_features;
            if has.contains(needed) {
                usable.push(Native {
                    raw: *raw,
                    attachment: has.contains(attachment),
                    blendable: has.contains(vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND),
                });
            }
        }
        let drawn = usable.iter().find(|n| n.attachment);
        if let Some(native) = drawn.or(usable.first()) {
            natives.insert(format, *native);
        }
    }
    natives
}

/// Returns the first bit and the width of each channel of a colour format, red to alpha, in a
/// texel's little-endian bytes (Vulkan, Packed Formats; Byte mappings).
pub(crate) fn layout(raw: vk::Format) -> &'static TexelLayout {
    match raw {
        vk::Format::R8_UNORM | vk::Format::R8_SNORM | vk::Format::R8_UINT => &[(0, 8)],
        vk::Format::R8G8_UNORM | vk::Format::R8G8_SNORM => &[(0, 8), (8, 8)],
        vk::Format::R16_UNORM | vk::Format::R16_UINT | vk::Format::R16_SFLOAT => &[(0, 16)],
        vk::Format::R16G16_UNORM | vk::Format::R16G16_UINT | vk::Format::R16G16_SFLOAT => {
            &[(0, 16), (16, 16)]
        }
        vk::Format::R8G8B8A8_UNORM
        | vk::Format::R8G8B8A8_SRGB
        | vk::Format::R8G8B8A8_SNORM
        | vk::Format::R8G8B8A8_UINT => &[(0, 8), (8, 8), (16, 8), (24, 8)],
        vk::Format::B8G8R8A8_UNORM | vk::Format::B8G8R8A8_SRGB => {
            &[(16, 8), (8, 8), (0, 8), (24, 8)]
        }
        vk::Format::A2B10G10R10_UNORM_PACK32 | vk::Format::A2B10G10R10_UINT_PACK32 => {
            &[(0, 10), (10, 10), (20, 10), (30, 2)]
        }
        vk::Format::A2R10G10B10_UNORM_PACK32 => &[(20, 10), (10, 10), (0, 10), (30, 2)],
        vk::Format::R5G6B5_UNORM_PACK16 => &[(11, 5), (5, 6), (0, 5)],
        vk::Format::B5G6R5_UNORM_PACK16 => &[(0, 5), (5, 6), (11, 5)],
        vk::Format::A1R5G5B5_UNORM_PACK16 => &[(10, 5), (5, 5), (0, 5), (15, 1)],
        vk::Format::R5G5B5A1_UNORM_PACK16 => &[(11, 5), (6, 5), (1, 5), (0, 1)],
        vk::Format::B5G5R5A1_UNORM_PACK16 => &[(1, 5), (6, 5), (11, 5), (0, 1)],
        vk::Format::R4G4B4A4_UNORM_PACK16 => &[(12, 4), (8, 4), (4, 4), (0, 4)],
        vk::Format::B4G4R4A4_UNORM_PACK16 => &[(4, 4), (8, 4), (12, 4), (0, 4)],
        vk::Format::B10G11R11_UFLOAT_PACK32 => &[(0, 11), (11, 11), (22, 10)],
        vk::Format::R16G16B16A16_UNORM
        | vk::Format::R16G16B16A16_UINT
        | vk::Format::R16G16B16A16_SFLOAT => &[(0, 16), (16, 16), (32, 16), (48, 16)],
        vk::Format::R32_SFLOAT => &[(0, 32)],
        vk::Format::R32G32_SFLOAT => &[(0, 32), (32, 32)],
        vk::Format::R32G32B32A32_SFLOAT => &[(0, 32), (32, 32), (64, 32), (96, 32)],
        _ => &[],
    }
}

/// Returns the format of an image whose attachment view has format `raw`. `None` if the path does not apply
/// to the format (Vulkan, Format Compatibility Classes).
pub(crate) fn viewed(raw: vk::Format, views: PathViews) -> Option<vk::Format> {
    if aspect_mask(raw) != vk::ImageAspectFlags::COLOR {
        return None;
    }
    match views {
        PathViews::Same => None,
        PathViews::Srgb => match raw {
            vk::Format::R8G8B8A8_UNORM => Some(vk::Format::R8G8B8A8_SRGB),
            vk::Format::B8G8R8A8_UNORM => Some(vk::Format::B8G8R8A8_SRGB),
            _ => unconverted(raw),
        },
        PathViews::Uint => match texel_bytes(raw, Aspect::Color) {
            1 => Some(vk::Format::R8_UINT),
            2 => Some(vk::Format::R16_UINT),
            4 => Some(vk::Format::R32_UINT),
            8 => Some(vk::Format::R32G32_UINT),
            16 => Some(vk::Format::R32G32B32A32_UINT),
            _ => None,
        },
    }
}

/// Returns the format of a view through which shaders read sRGB codes without conversion.
pub(crate) fn unconverted(raw: vk::Format) -> Option<vk::Format> {
    match raw {
        vk::Format::R8G8B8A8_SRGB => Some(vk::Format::R8G8B8A8_UNORM),
        vk::Format::B8G8R8A8_SRGB => Some(vk::Format::B8G8R8A8_UNORM),
        _ => None,
    }
}

/// Returns all aspects of a Vulkan format, including any that the texture format lacks.
pub(crate) fn aspect_mask(raw: vk::Format) -> vk::ImageAspectFlags {
    let (depth, stencil) = (vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::STENCIL);
    match raw {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => depth,
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => depth | stencil,
        vk::Format::S8_UINT => stencil,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// Returns the Vulkan flag of an aspect.
pub(crate) fn aspect_flag(aspect: Aspect) -> vk::ImageAspectFlags {
    match aspect {
        Aspect::Color => vk::ImageAspectFlags::COLOR,
        Aspect::Depth => vk::ImageAspectFlags::DEPTH,
        Aspect::Stencil => vk::ImageAspectFlags::STENCIL,
    }
}

/// Returns the encodings of an aspect's channels.
pub(crate) fn channels(
    format: TextureFormat,
    raw: vk::Format,
    aspect: Aspect,
) -> Vec<ChannelEncoding> {
    match aspect {
        Aspect::Color => format.color_channels().to_vec(),
        Aspect::Depth => vec![depth_encoding(raw)],
        Aspect::Stencil => vec![ChannelEncoding::Uint(8)],
    }
}

/// Returns the encoding of a Vulkan format's depth.
pub(crate) fn depth_encoding(raw: vk::Format) -> ChannelEncoding {
    match raw {
        vk::Format::D16_UNORM => ChannelEncoding::Unorm(16),
        vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => {
            ChannelEncoding::Unorm(24)
        }
        _ => ChannelEncoding::Float32,
    }
}

/// Returns the size of an aspect's texel in a buffer, in bytes (Vulkan, Copying Data Between Buffers and
/// Images).
pub(crate) fn texel_bytes(raw: vk::Format, aspect: Aspect) -> usize {
    match (aspect, depth_encoding(raw)) {
        (Aspect::Color, _) => codes::texel_bytes(layout(raw)),
        (Aspect::Depth, ChannelEncoding::Unorm(16)) => 2,
        (Aspect::Depth, _) => 4,
        (Aspect::Stencil, _) => 1,
    }
}

/// Returns the bits of an aspect's channels in a copied texel. The upper bits of a copied 24-bit
/// depth are undefined.
pub(crate) fn copied_layout(raw: vk::Format, aspect: Aspect) -> &'static TexelLayout {
    match (aspect, depth_encoding(raw)) {
        (Aspect::Color, _) => layout(raw),
        (Aspect::Depth, ChannelEncoding::Unorm(16)) => &[(0, 16)],
        (Aspect::Depth, ChannelEncoding::Unorm(24)) => &[(0, 24)],
        (Aspect::Depth, _) => &[(0, 32)],
        (Aspect::Stencil, _) => &[(0, 8)],
    }
}

/// Returns the codes of copied texels, channel by channel.
pub(crate) fn decode(bytes: &[u8], raw: vk::Format, aspect: Aspect) -> Vec<u32> {
    let size = texel_bytes(raw, aspect);
    codes::unpack_all(copied_layout(raw, aspect), size, bytes)
}

/// Returns colour codes as the bytes of texels in a buffer.
pub(crate) fn encode(codes: &[u32], raw: vk::Format) -> Vec<u8> {
    codes::pack_all(layout(raw), codes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copied_24_bit_depth_drops_its_undefined_bits() {
        let raw = vk::Format::X8_D24_UNORM_PACK32;
        let codes = decode(&[1, 2, 3, 0xff], raw, Aspect::Depth);
        assert_eq!(codes, [0x0003_0201]);
    }

    #[test]
    fn every_candidate_holds_the_channels_of_its_format_without_gap_or_overlap() {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            for raw in candidates(format) {
                let (layout, encodings) = (layout(*raw), format.color_channels());
                assert_eq!(layout.len(), encodings.len(), "{raw:?}");
                let mut seen = 0_u128;
                for ((shift, width), encoding) in layout.iter().zip(encodings) {
                    let codes = encoding.max_order() - encoding.min_order();
                    let sign = u32::from(encoding.min_order() < 0);
                    let bits = match encoding {
                        ChannelEncoding::Float16 | ChannelEncoding::Ufloat(6) => {
                            16 - 5 * (1 - sign)
                        }
                        ChannelEncoding::Ufloat(_) => 10,
                        ChannelEncoding::Float32 => 32,
                        _ => codes.ilog2() + 1,
                    };
                    assert_eq!(*width, bits, "{raw:?}");
                    let mask = ((1_u128 << width) - 1) << shift;
                    assert_eq!(seen & mask, 0, "{raw:?}");
                    seen |= mask;
                }
                let total = 8 * texel_bytes(*raw, Aspect::Color) as u32;
                assert_eq!(seen.trailing_ones(), total, "{raw:?}");
            }
        }
    }

    #[test]
    fn uploads_decode_to_themselves() {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            let order = |i: usize, e: &ChannelEncoding| match i % 3 {
                0 => e.max_order(),
                1 => e.min_order(),
                _ => 1,
            };
            let channels = format.color_channels().iter().enumerate();
            let codes: Vec<u32> = channels
                .map(|(i, e)| e.code_of_order(order(i, e)))
                .collect();
            let two = [codes.clone(), codes].concat();
            for raw in candidates(format) {
                let bytes = encode(&two, *raw);
                assert_eq!(decode(&bytes, *raw, Aspect::Color), two, "{raw:?}");
            }
        }
    }

    #[test]
    fn attachments_are_views_of_formats_of_their_size() {
        let mut pairs = 0;
        for raw in TextureFormat::ALL.into_iter().flat_map(candidates) {
            let viewed = |views| super::viewed(*raw, views);
            assert_eq!(viewed(PathViews::Same), None);
            if let Some(other) = viewed(PathViews::Srgb) {
                assert_eq!(super::viewed(other, PathViews::Srgb), Some(*raw));
                assert_eq!(layout(other), layout(*raw));
                pairs += 1;
            }
            let color = aspect_mask(*raw) == vk::ImageAspectFlags::COLOR;
            assert_eq!(viewed(PathViews::Uint).is_some(), color, "{raw:?}");
        }
        assert_eq!(pairs, 5);
    }

    #[test]
    fn packed_channels_begin_at_the_highest_bit() {
        let codes = [31, 0, 0];
        assert_eq!(encode(&codes, vk::Format::R5G6B5_UNORM_PACK16), [0, 0xf8]);
        assert_eq!(encode(&codes, vk::Format::B5G6R5_UNORM_PACK16), [0x1f, 0]);
        let codes = [0, 0, 0, 1];
        assert_eq!(encode(&codes, vk::Format::A1R5G5B5_UNORM_PACK16), [0, 0x80]);
        let codes = [1, 2, 3, 4];
        assert_eq!(encode(&codes, vk::Format::B8G8R8A8_UNORM), [3, 2, 1, 4]);
        assert_eq!(
            encode(&codes, vk::Format::B4G4R4A4_UNORM_PACK16),
            [0x14, 0x32]
        );
    }
}
