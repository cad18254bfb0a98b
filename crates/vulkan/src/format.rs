//! Which Vulkan format stands for which of ours, and how its texels lie in a buffer.

use crate::device::Device;
use ash::vk;
use etalon_frame::{Aspect, ChannelEncoding, TextureFormat};
use std::collections::BTreeMap;

/// A format as this device has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Native {
    pub(crate) raw: vk::Format,
    /// Whether it can be drawn to with every state; `rgba32float` need not.
    pub(crate) attachment: bool,
}

/// The candidates for each format, the best first. WebGPU leaves the depth of `depth24plus` open,
/// and whether `stencil8` has a depth aspect beside it.
fn candidates(format: TextureFormat) -> &'static [vk::Format] {
    match format {
        TextureFormat::Rgba8Unorm => &[vk::Format::R8G8B8A8_UNORM],
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

/// The formats that the device supports, as [`etalon_frame::Limits::formats`] promises them.
pub(crate) fn natives(device: &Device) -> BTreeMap<TextureFormat, Native> {
    let transfer = vk::FormatFeatureFlags::TRANSFER_SRC | vk::FormatFeatureFlags::TRANSFER_DST;
    let sampled = vk::FormatFeatureFlags::SAMPLED_IMAGE;
    let drawn =
        vk::FormatFeatureFlags::COLOR_ATTACHMENT | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
    let tested = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
    let mut natives = BTreeMap::new();
    for format in TextureFormat::ALL {
        let (needed, attachment) = match format {
            TextureFormat::Rgba8Unorm => (transfer | sampled | drawn, drawn),
            TextureFormat::Rgba32Float => (transfer | sampled, drawn),
            _ => (transfer | tested, tested),
        };
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
                let native = Native {
                    raw: *raw,
                    attachment: has.contains(attachment),
                };
                natives.insert(format, native);
                break;
            }
        }
    }
    natives
}

/// All aspects of a Vulkan format, also those that ours does not name.
pub(crate) fn aspect_mask(raw: vk::Format) -> vk::ImageAspectFlags {
    let (depth, stencil) = (vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::STENCIL);
    match raw {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => depth,
        vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => depth | stencil,
        vk::Format::S8_UINT => stencil,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

/// Vulkan's flag of an aspect.
pub(crate) fn aspect_flag(aspect: Aspect) -> vk::ImageAspectFlags {
    match aspect {
        Aspect::Color => vk::ImageAspectFlags::COLOR,
        Aspect::Depth => vk::ImageAspectFlags::DEPTH,
        Aspect::Stencil => vk::ImageAspectFlags::STENCIL,
    }
}

/// The encodings of an aspect's channels.
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

/// The encoding of a Vulkan format's depth.
pub(crate) fn depth_encoding(raw: vk::Format) -> ChannelEncoding {
    match raw {
        vk::Format::D16_UNORM => ChannelEncoding::Unorm(16),
        vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D24_UNORM_S8_UINT => {
            ChannelEncoding::Unorm(24)
        }
        _ => ChannelEncoding::Float32,
    }
}

/// Bytes that one channel takes in a buffer (Vulkan, Copying Data Between Buffers and Images).
pub(crate) fn channel_bytes(encoding: ChannelEncoding) -> usize {
    match encoding {
        ChannelEncoding::Unorm(bits) | ChannelEncoding::Uint(bits) => match bits {
            0..=8 => 1,
            9..=16 => 2,
            _ => 4,
        },
        ChannelEncoding::Float32 => 4,
    }
}

/// Reads codes out of a buffer of little-endian channels.
pub(crate) fn decode(bytes: &[u8], encodings: &[ChannelEncoding]) -> Vec<u32> {
    // All our formats have channels of one encoding.
    let Some(encoding) = encodings.first().copied() else {
        return Vec::new();
    };
    match channel_bytes(encoding) {
        1 => bytes.iter().map(|b| u32::from(*b)).collect(),
        2 => bytes
            .chunks_exact(2)
            .map(|c| u32::from(u16::from_le_bytes([c[0], c[1]])))
            .collect(),
        _ => {
            // The upper bits of a copied 24-bit depth are undefined.
            let mask = match encoding {
                ChannelEncoding::Unorm(24) => 0x00ff_ffff,
                _ => u32::MAX,
            };
            bytes
                .chunks_exact(4)
                .map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]) & mask)
                .collect()
        }
    }
}

/// Writes codes of a colour format as its texels lie in a buffer.
pub(crate) fn encode(codes: &[u32], format: TextureFormat) -> Vec<u8> {
    let encoding = format.color_channels().first().copied();
    let bytes = encoding.map_or(4, channel_bytes);
    let mut out = Vec::with_capacity(codes.len() * bytes);
    for code in codes {
        out.extend_from_slice(&code.to_le_bytes()[..bytes]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copied_24_bit_depth_drops_its_undefined_bits() {
        let codes = decode(&[1, 2, 3, 0xff], &[ChannelEncoding::Unorm(24)]);
        assert_eq!(codes, [0x0003_0201]);
    }

    #[test]
    fn uploads_decode_to_themselves() {
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Rgba32Float] {
            let codes = [0, 1, 127, 255];
            let bytes = encode(&codes, format);
            assert_eq!(decode(&bytes, format.color_channels()), codes);
        }
    }
}
