//! Conversion of texels between bytes, a shader's floats and codes.

use etalon_frame::{ChannelEncoding, TextureFormat};

/// Returns the first bit and the width of each channel in a texel of little-endian bytes, red to
/// alpha.
fn layout(format: TextureFormat) -> &'static [(u32, u32)] {
    match format {
        TextureFormat::R8Unorm => &[(0, 8)],
        TextureFormat::Rg8Unorm => &[(0, 8), (8, 8)],
        TextureFormat::Rgba8Unorm
        | TextureFormat::Rgba8UnormSrgb
        | TextureFormat::Rgba8Snorm
        | TextureFormat::Rgba8Uint => &[(0, 8), (8, 8), (16, 8), (24, 8)],
        TextureFormat::Bgra8Unorm => &[(16, 8), (8, 8), (0, 8), (24, 8)],
        TextureFormat::Rgb10a2Unorm => &[(0, 10), (10, 10), (20, 10), (30, 2)],
        TextureFormat::Rg11b10Ufloat => &[(0, 11), (11, 11), (22, 10)],
        TextureFormat::Rgba16Float => &[(0, 16), (16, 16), (32, 16), (48, 16)],
        TextureFormat::Rgba32Float => &[(0, 32), (32, 32), (64, 32), (96, 32)],
        _ => &[],
    }
}

/// Returns the size of a colour texel.
pub(crate) fn bytes(format: TextureFormat) -> usize {
    let bits: u32 = layout(format).iter().map(|(_, width)| width).sum();
    bits.div_ceil(8) as usize
}

/// Appends a colour texel with these codes.
pub(crate) fn pack(format: TextureFormat, codes: &[u32], out: &mut Vec<u8>) {
    let channels = layout(format).iter().zip(codes);
    let texel = channels.fold(0_u128, |texel, ((shift, _), code)| {
        texel | u128::from(*code) << shift
    });
    out.extend_from_slice(&texel.to_le_bytes()[..bytes(format)]);
}

/// Appends the codes of a colour texel.
pub(crate) fn unpack(format: TextureFormat, texel: &[u8], out: &mut Vec<u32>) {
    let bits = texel
        .iter()
        .rev()
        .fold(0_u128, |bits, byte| bits << 8 | u128::from(*byte));
    out.extend(layout(format).iter().map(|(shift, width)| {
        let mask = u128::from(u32::MAX >> (32 - width));
        (bits >> shift & mask) as u32
    }));
}

/// Returns the code that a shader fetched as the float of these bits; of an sRGB code it fetched
/// the encoded value.
pub(crate) fn code(encoding: ChannelEncoding, seen: u32) -> u32 {
    match encoding {
        ChannelEncoding::Float32 => seen,
        ChannelEncoding::Float16 => shortened(seen, 10) | seen >> 31 << 15,
        ChannelEncoding::Ufloat(mantissa) => shortened(seen, mantissa.into()),
        ChannelEncoding::Uint(_) => seen,
        ChannelEncoding::Srgb8 => ChannelEncoding::Unorm(8).nearest_code(value(seen)),
        ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_) => encoding.nearest_code(value(seen)),
    }
}

fn value(seen: u32) -> f64 {
    f32::from_bits(seen).into()
}

/// Returns the magnitude of a 32-bit float in a format of 5 exponent bits and this many mantissa
/// bits, which can represent it exactly.
fn shortened(seen: u32, mantissa: u32) -> u32 {
    let (exponent, fraction) = (seen >> 23 & 0xff, seen & 0x7f_ffff);
    match exponent {
        0xff => 31 << mantissa | fraction >> (23 - mantissa) | u32::from(fraction != 0),
        // The bias is 112 less; below the least exponent the mantissa is shifted.
        113.. => (exponent - 112) << mantissa | fraction >> (23 - mantissa),
        _ => (fraction | 0x80_0000)
            .checked_shr(23 - mantissa + 113 - exponent)
            .unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_lie_where_webgpu_puts_them() {
        let mut out = Vec::new();
        pack(TextureFormat::Bgra8Unorm, &[1, 2, 3, 4], &mut out);
        pack(TextureFormat::Rgb10a2Unorm, &[0x3ff, 0, 1, 2], &mut out);
        pack(TextureFormat::Rg11b10Ufloat, &[0x3c0, 0, 0x1e0], &mut out);
        let due = [3, 2, 1, 4, 0xff, 3, 0x10, 0x80, 0xc0, 3, 0, 0x78];
        assert_eq!(out, due);
    }

    #[test]
    fn packing_inverts() {
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

    #[test]
    fn every_code_comes_back_from_its_float() {
        let encodings = [
            ChannelEncoding::Unorm(2),
            ChannelEncoding::Unorm(8),
            ChannelEncoding::Unorm(10),
            ChannelEncoding::Float16,
            ChannelEncoding::Ufloat(6),
            ChannelEncoding::Ufloat(5),
        ];
        for e in encodings {
            for order in e.min_order()..=e.max_order() {
                let seen = (e.value_of_order(order) as f32).to_bits();
                assert_eq!(code(e, seen), e.code_of_order(order), "{e} {order}");
            }
        }
        let infinity = f32::INFINITY.to_bits();
        assert_eq!(code(ChannelEncoding::Float16, infinity), 0x7c00);
        assert_eq!(code(ChannelEncoding::Float16, (-0_f32).to_bits()), 0x8000);
        let nan = code(ChannelEncoding::Ufloat(5), f32::NAN.to_bits());
        assert!(ChannelEncoding::Ufloat(5).is_nan(nan));
    }
}
