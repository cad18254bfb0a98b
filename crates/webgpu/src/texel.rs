//! The layout of colour texels in buffers.

use etalon_backend::codes::{self, webgpu_layout as layout};
use etalon_frame::TextureFormat;

/// Returns the first bit and the width of each channel.
pub(crate) fn places(format: TextureFormat) -> Vec<[u32; 2]> {
    layout(format)
        .iter()
        .map(|(bit, bits)| [*bit, *bits])
        .collect()
}

/// Returns the size of a colour texel in bytes.
pub(crate) fn bytes(format: TextureFormat) -> usize {
    codes::texel_bytes(layout(format))
}

/// Appends a colour texel with these codes.
pub(crate) fn pack(format: TextureFormat, codes: &[u32], out: &mut Vec<u8>) {
    codes::pack(layout(format), codes, out);
}

/// Appends the codes of a colour texel.
pub(crate) fn unpack(format: TextureFormat, texel: &[u8], out: &mut Vec<u32>) {
    codes::unpack(layout(format), texel, out);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_packed_in_webgpus_order() {
        let mut out = Vec::new();
        pack(TextureFormat::Bgra8Unorm, &[1, 2, 3, 4], &mut out);
        pack(TextureFormat::Rgb10a2Unorm, &[0x3ff, 0, 1, 2], &mut out);
        pack(TextureFormat::Rg11b10Ufloat, &[0x3c0, 0, 0x1e0], &mut out);
        let expected = [3, 2, 1, 4, 0xff, 3, 0x10, 0x80, 0xc0, 3, 0, 0x78];
        assert_eq!(out, expected);
    }

    #[test]
    fn packing_and_unpacking_are_inverse() {
        for format in TextureFormat::ALL {
            let codes: Vec<u32> = format
                .color_channels()
                .iter()
                .enumerate()
                .map(|(i, e)| e.code_of_order(e.max_order() - i as i64))
                .collect();
            if layout(format).is_empty() {
                continue;
            }
            let (mut texel, mut back) = (Vec::new(), Vec::new());
            pack(format, &codes, &mut texel);
            assert_eq!(texel.len(), bytes(format), "{format}");
            unpack(format, &texel, &mut back);
            assert_eq!(back, codes, "{format}");
        }
    }
}
