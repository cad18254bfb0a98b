//! Texels that distinguish rows, columns, channels and bits, computed from the format.
//!
//! A table of these texels in a case file would be long, and a missing bit would be easy to overlook.

use etalon_frame::{ChannelEncoding, TextureFormat};

/// The step from one texel's code to the next, per channel: odd, so that every code occurs.
const STEPS: [u32; 4] = [1, 3, 5, 7];

/// Returns the codes of an attachment, texel by texel, row by row. Integer channels go through all their
/// codes, each at its own pace and from another start in each round. Float channels take normal numbers of
/// every exponent, and of both signs if they have a sign.
pub(crate) fn codes(format: TextureFormat, [width, height]: [u32; 2]) -> Vec<u32> {
    let channels = format.color_channels();
    let texels = 0..width.saturating_mul(height);
    texels
        .flat_map(|texel| {
            let each = channels.iter().zip(0..);
            each.map(move |(encoding, channel)| code(*encoding, channel, texel))
        })
        .collect()
}

fn code(encoding: ChannelEncoding, channel: u32, texel: u32) -> u32 {
    use ChannelEncoding::{Float16, Float32, Snorm, Srgb8, Ufloat, Uint, Unorm};
    match encoding {
        Unorm(bits) | Uint(bits) => integer(bits, channel, texel),
        Srgb8 => integer(8, channel, texel),
        // -1 has two codes, which an API may exchange; the lower one is skipped.
        Snorm(bits) => match integer(bits, channel, texel) {
            lowest if lowest == 1 << (bits - 1) => lowest + 1,
            code => code,
        },
        Float16 => float(5, 10, true, channel, texel),
        Float32 => float(8, 23, true, channel, texel),
        Ufloat(mantissa) => float(5, mantissa, false, channel, texel),
    }
}

fn integer(bits: u8, channel: u32, texel: u32) -> u32 {
    let codes = 1 << bits;
    let (round, place) = (texel / codes, texel % codes);
    let step = STEPS[channel as usize % STEPS.len()];
    (place * step + round * 11 + channel * 85) % codes
}

/// Returns a normal number, since the conversion of other numbers is partly open.
fn float(exponent_bits: u8, mantissa_bits: u8, signed: bool, channel: u32, texel: u32) -> u32 {
    let mixed = mixed(texel * STEPS.len() as u32 + channel);
    let mantissa = mixed & ((1 << mantissa_bits) - 1);
    let normal = (1 << exponent_bits) - 2;
    let exponent = 1 + (texel + channel * 11) % normal;
    let sign = u32::from(signed) * (mixed >> 31);
    ((sign << exponent_bits | exponent) << mantissa_bits) | mantissa
}

/// Returns a hash of a number: MurmurHash3's finaliser.
fn mixed(mut n: u32) -> u32 {
    n = (n ^ 0x9e37_79b9).wrapping_mul(0x85eb_ca6b);
    n = (n ^ (n >> 13)).wrapping_mul(0xc2b2_ae35);
    n ^ (n >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// The size that the round-trip test uses.
    const SIZE: [u32; 2] = [37, 29];

    #[test]
    fn every_bit_of_every_channel_is_0_and_1_somewhere_and_every_float_is_normal() {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            let codes = codes(format, SIZE);
            let channels = format.color_channels();
            assert_eq!(codes.len(), (SIZE[0] * SIZE[1]) as usize * channels.len());
            for (c, encoding) in channels.iter().enumerate() {
                let channel_codes = || codes.iter().skip(c).step_by(channels.len()).copied();
                let expected = encoding.mask();
                assert_eq!(
                    channel_codes().fold(0, |a, b| a | b),
                    expected,
                    "{format} {c}: ones"
                );
                assert_eq!(
                    channel_codes().fold(expected, |a, b| a & b),
                    0,
                    "{format} {c}: zeros"
                );
                if encoding.is_float() {
                    for code in channel_codes() {
                        let value = encoding.value_of_order(encoding.order_of_code(code));
                        assert!(value.is_finite() && value != 0.0, "{format} {c}: {code:x}");
                        assert_eq!(encoding.nearest_code(value), code, "{format} {c}");
                    }
                } else {
                    let different = channel_codes().collect::<BTreeSet<_>>().len() as u32;
                    let left_out = matches!(encoding, ChannelEncoding::Snorm(_));
                    assert_eq!(
                        different,
                        expected + 1 - u32::from(left_out),
                        "{format} {c}"
                    );
                }
            }
        }
    }

    #[test]
    fn rows_columns_and_channels_differ() {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            let channels = format.color_channels().len();
            let codes = codes(format, SIZE);
            let [width, height] = SIZE.map(|s| s as usize);
            let texel = |x: usize, y: usize| &codes[(y * width + x) * channels..][..channels];
            let row = |y| (0..width).flat_map(|x| texel(x, y)).collect::<Vec<_>>();
            let column = |x| (0..height).flat_map(|y| texel(x, y)).collect::<Vec<_>>();
            let rows: BTreeSet<_> = (0..height).map(row).collect();
            let columns: BTreeSet<_> = (0..width).map(column).collect();
            assert_eq!((rows.len(), columns.len()), (height, width), "{format}");
            for a in 0..channels {
                for b in 0..a {
                    let same = codes.chunks(channels).all(|t| t[a] == t[b]);
                    assert!(!same, "{format}: channels {a} and {b}");
                }
            }
            // A moved or turned block of two by two texels is noticed at any position.
            for y in 1..height {
                for x in 1..width {
                    assert_ne!(texel(x, y), texel(x - 1, y), "{format} {x},{y}");
                    assert_ne!(texel(x, y), texel(x, y - 1), "{format} {x},{y}");
                }
            }
        }
    }
}
