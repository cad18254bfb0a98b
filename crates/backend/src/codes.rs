//! Codes of texels in memory, and of values that a shader fetches.
//!
//! A frame holds codes, and a backend that reads back floats or packed bytes must recover the codes without
//! rounding. The backends share this arithmetic, so that a code means the same on each.

use etalon_frame::{ChannelEncoding, TextureFormat};

/// The first bit and the width of each channel in a little-endian texel, in the order red to alpha.
pub type TexelLayout = [(u32, u32)];

/// Returns the layout of a colour format in WebGPU's buffers; empty if WebGPU lacks the format.
pub fn webgpu_layout(format: TextureFormat) -> &'static TexelLayout {
    match format {
        TextureFormat::R8Unorm | TextureFormat::R8Snorm | TextureFormat::R8Uint => &[(0, 8)],
        TextureFormat::Rg8Unorm | TextureFormat::Rg8Snorm => &[(0, 8), (8, 8)],
        TextureFormat::R16Unorm | TextureFormat::R16Uint | TextureFormat::R16Float => &[(0, 16)],
        TextureFormat::Rg16Unorm | TextureFormat::Rg16Uint | TextureFormat::Rg16Float => {
            &[(0, 16), (16, 16)]
        }
        TextureFormat::Rgba8Unorm
        | TextureFormat::Rgba8UnormSrgb
        | TextureFormat::Rgba8Snorm
        | TextureFormat::Rgba8Uint => &[(0, 8), (8, 8), (16, 8), (24, 8)],
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => {
            &[(16, 8), (8, 8), (0, 8), (24, 8)]
        }
        TextureFormat::Rgb10a2Unorm | TextureFormat::Rgb10a2Uint => {
            &[(0, 10), (10, 10), (20, 10), (30, 2)]
        }
        TextureFormat::Rg11b10Ufloat => &[(0, 11), (11, 11), (22, 10)],
        TextureFormat::Rgba16Unorm | TextureFormat::Rgba16Uint | TextureFormat::Rgba16Float => {
            &[(0, 16), (16, 16), (32, 16), (48, 16)]
        }
        TextureFormat::R32Float => &[(0, 32)],
        TextureFormat::Rg32Float => &[(0, 32), (32, 32)],
        TextureFormat::Rgba32Float => &[(0, 32), (32, 32), (64, 32), (96, 32)],
        _ => &[],
    }
}

/// Returns the size of a texel in bytes.
pub fn texel_bytes(layout: &TexelLayout) -> usize {
    let bits: u32 = layout.iter().map(|(_, width)| width).sum();
    bits.div_ceil(8) as usize
}

/// Appends a texel with these codes.
pub fn pack(layout: &TexelLayout, codes: &[u32], out: &mut Vec<u8>) {
    let channels = layout.iter().zip(codes);
    let texel = channels.fold(0_u128, |texel, ((shift, _), code)| {
        texel | u128::from(*code) << shift
    });
    out.extend_from_slice(&texel.to_le_bytes()[..texel_bytes(layout)]);
}

/// Appends the codes of a texel, which can end with padding.
pub fn unpack(layout: &TexelLayout, texel: &[u8], out: &mut Vec<u32>) {
    if let Ok(word) = <[u8; 4]>::try_from(texel) {
        let word = u32::from_le_bytes(word);
        out.extend(
            layout
                .iter()
                .map(|(shift, width)| word >> shift & u32::MAX >> (32 - width)),
        );
        return;
    }
    let bytes = texel.iter().rev();
    let bits = bytes.fold(0_u128, |bits, byte| bits << 8 | u128::from(*byte));
    out.extend(layout.iter().map(|(shift, width)| {
        let mask = u128::from(u32::MAX >> (32 - width));
        (bits >> shift & mask) as u32
    }));
}

/// Returns texels with these codes, channel by channel.
pub fn pack_all(layout: &TexelLayout, codes: &[u32]) -> Vec<u8> {
    let texels = codes.chunks_exact(layout.len().max(1));
    let mut bytes = Vec::with_capacity(texels.len() * texel_bytes(layout));
    for texel in texels {
        pack(layout, texel, &mut bytes);
    }
    bytes
}

/// Returns the codes of texels of `size` bytes, channel by channel.
pub fn unpack_all(layout: &TexelLayout, size: usize, bytes: &[u8]) -> Vec<u32> {
    let texels = bytes.chunks_exact(size.max(1));
    let mut codes = Vec::with_capacity(texels.len() * layout.len());
    for texel in texels {
        unpack(layout, texel, &mut codes);
    }
    codes
}

/// Returns the code whose value the 32-bit float with these bits represents, exactly or as nearly as a float
/// can. This undoes a conversion and adds no rounding.
pub fn code_of_float(encoding: ChannelEncoding, float: u32) -> u32 {
    match encoding {
        ChannelEncoding::Float32 => float,
        ChannelEncoding::Float16 => short_float(float, 10),
        ChannelEncoding::Ufloat(mantissa) => short_float(float, mantissa.into()),
        ChannelEncoding::Unorm(_)
        | ChannelEncoding::Snorm(_)
        | ChannelEncoding::Srgb8
        | ChannelEncoding::Uint(_) => encoding.nearest_code(f32::from_bits(float).into()),
    }
}

/// Returns the code of a channel that a shader fetched as these bits through a view without conversion.
/// Integers are codes, and sRGB codes are fetched as normalized values.
pub fn code_of_fetched(encoding: ChannelEncoding, bits: u32) -> u32 {
    match encoding {
        ChannelEncoding::Uint(_) => bits,
        ChannelEncoding::Srgb8 => code_of_float(ChannelEncoding::Unorm(8), bits),
        encoding => code_of_float(encoding, bits),
    }
}

/// Returns the float with 5 exponent bits and this many mantissa bits that has the value of a 32-bit float.
fn short_float(float: u32, mantissa: u32) -> u32 {
    let exponent = (float >> 23 & 0xff) as i32 - 127;
    let fraction = float & 0x7f_ffff;
    let shift = 23 - mantissa;
    let infinity = 31 << mantissa;
    let magnitude = match exponent {
        // A NaN stays a NaN, whichever mantissa bits are lost.
        128 if fraction != 0 => infinity | (fraction >> shift).max(1),
        16.. => infinity,
        -14..=15 => ((exponent + 15) as u32) << mantissa | fraction >> shift,
        // The value is subnormal in the shorter format.
        _ => (0x80_0000 | fraction)
            .checked_shr(shift + (-14 - exponent) as u32)
            .unwrap_or(0),
    };
    (float >> 31) << (5 + mantissa) | magnitude
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENCODINGS: [ChannelEncoding; 11] = [
        ChannelEncoding::Unorm(1),
        ChannelEncoding::Unorm(2),
        ChannelEncoding::Unorm(5),
        ChannelEncoding::Unorm(8),
        ChannelEncoding::Unorm(10),
        ChannelEncoding::Unorm(16),
        ChannelEncoding::Snorm(8),
        ChannelEncoding::Srgb8,
        ChannelEncoding::Float16,
        ChannelEncoding::Ufloat(6),
        ChannelEncoding::Ufloat(5),
    ];

    #[test]
    fn every_code_is_recovered_from_its_float() {
        for encoding in ENCODINGS {
            for order in encoding.min_order()..=encoding.max_order() {
                let value = encoding.value_of_order(order) as f32;
                let code = encoding.code_of_order(order);
                // -1 has two codes.
                if encoding == ChannelEncoding::Snorm(8) && order == encoding.min_order() {
                    assert_eq!(code_of_float(encoding, value.to_bits()), 0x81);
                    continue;
                }
                // The last bits of the conversion of a normalized integer are unspecified.
                let exact = encoding.is_float() || encoding == ChannelEncoding::Srgb8;
                for ulps in if exact { 0..1 } else { -40..41 } {
                    let float = value.to_bits().saturating_add_signed(ulps);
                    assert_eq!(code_of_float(encoding, float), code, "{encoding} {order}");
                }
            }
        }
    }

    #[test]
    fn signs_infinities_and_nan_are_kept() {
        let code = |value: f32, encoding| code_of_float(encoding, value.to_bits());
        assert_eq!(code(-0.0, ChannelEncoding::Float16), 0x8000);
        assert_eq!(code(f32::INFINITY, ChannelEncoding::Float16), 0x7c00);
        assert_eq!(code(f32::NEG_INFINITY, ChannelEncoding::Float16), 0xfc00);
        assert_eq!(code(f32::INFINITY, ChannelEncoding::Ufloat(6)), 0x7c0);
        assert_eq!(code(f32::INFINITY, ChannelEncoding::Ufloat(5)), 31 << 5);
        assert_eq!(code(f32::NAN, ChannelEncoding::Float16), 0x7e00);
        for encoding in [
            ChannelEncoding::Float16,
            ChannelEncoding::Ufloat(6),
            ChannelEncoding::Ufloat(5),
        ] {
            assert!(encoding.is_nan(code(f32::NAN, encoding)));
        }
    }

    #[test]
    fn integers_and_srgb_codes_are_fetched_as_they_are() {
        for code in 0..256_u32 {
            let fetched = code_of_fetched(ChannelEncoding::Uint(8), code);
            assert_eq!(fetched, code);
            let float = (code as f32 / 255.0).to_bits();
            assert_eq!(code_of_fetched(ChannelEncoding::Srgb8, float), code);
        }
    }
}
