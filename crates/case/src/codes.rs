//! Texels that distinguish rows, columns, channels and bits, computed from the format.
//!
//! A table of these texels in a case file would be long, and a missing bit would be easy to overlook.

use crate::error::At;
use etalon_frame::{ChannelEncoding, TextureFormat, srgb_to_linear};

/// The step from one texel's code to the next, per channel: odd, so that every code occurs.
const STEPS: [u32; 4] = [1, 3, 5, 7];

/// Returns a colour for each texel, row by row: its channels have the values of codes of `of`, moved towards
/// the next code by parts of the distance to it. The parts take turns from round to round and channel to
/// channel.
pub(crate) fn beside(
    of: TextureFormat,
    parts: &[f64],
    [width, height]: [u32; 2],
) -> Result<Vec<[f32; 4]>, At> {
    let channels = of.color_channels();
    let near = |part: &f64| part.abs() <= 0.5;
    if parts.is_empty() || !parts.iter().all(near) {
        return Err(At::new("the parts are numbers from -0.5 to 0.5").key("by"));
    }
    let bits = |encoding: &ChannelEncoding| match encoding {
        ChannelEncoding::Unorm(bits) => Ok(*bits),
        ChannelEncoding::Srgb8 => Ok(8),
        _ => Err(At::new(format!("{of} has no codes between 0 and 1")).key("of")),
    };
    let bits: Vec<u8> = channels.iter().map(bits).collect::<Result<_, _>>()?;
    let value = |channel: usize, texel: u32| {
        let round = (texel >> bits[channel]) as usize;
        let code = integer(bits[channel], channel as u32, texel);
        let place = f64::from(code) + parts[(round + channel) % parts.len()];
        let share = (place / f64::from((1_u32 << bits[channel]) - 1)).clamp(0.0, 1.0);
        match channels[channel] {
            ChannelEncoding::Srgb8 => srgb_to_linear(share) as f32,
            _ => share as f32,
        }
    };
    let color = |texel| {
        let mut color = [0.0, 0.0, 0.0, 1.0];
        for (channel, stored) in color.iter_mut().enumerate().take(channels.len()) {
            *stored = value(channel, texel);
        }
        color
    };
    Ok((0..width.saturating_mul(height)).map(color).collect())
}

/// Returns the codes of an attachment, texel by texel, row by row. Integer channels go through all their
/// codes, each at its own pace and from another start in each round. Float channels take normal numbers of
/// every exponent, and of both signs if they have a sign.
pub(crate) fn codes(format: TextureFormat, [width, height]: [u32; 2]) -> Vec<u32> {
    let channels = format.color_channels();
    let texels = 0..width.saturating_mul(height);
    texels
        .flat_map(|texel| {
            let encodings = channels.iter().zip(0..);
            encodings.map(move |(encoding, channel)| code(*encoding, channel, texel))
        })
        .collect()
}

fn code(encoding: ChannelEncoding, channel: u32, texel: u32) -> u32 {
    use ChannelEncoding::{Float16, Float32, Snorm, Srgb8, Ufloat, Uint, Unorm};
    match encoding {
        Unorm(bits) | Uint(bits) => integer(bits, channel, texel),
        Srgb8 => integer(8, channel, texel),
        // -1 has two codes, which an API may exchange. A code that no neighbour has replaces the lower one.
        Snorm(bits) => match integer(bits, channel, texel) {
            lowest if lowest == 1 << (bits - 1) => lowest + (1 << (bits - 2)),
            code => code,
        },
        Float16 => float(FloatLayout::FLOAT16, channel, texel),
        Float32 => float(FloatLayout::FLOAT32, channel, texel),
        Ufloat(mantissa_bits) => float(FloatLayout::ufloat(mantissa_bits), channel, texel),
    }
}

struct FloatLayout {
    exponent_bits: u8,
    mantissa_bits: u8,
    is_signed: bool,
}

impl FloatLayout {
    const FLOAT16: Self = Self {
        exponent_bits: 5,
        mantissa_bits: 10,
        is_signed: true,
    };
    const FLOAT32: Self = Self {
        exponent_bits: 8,
        mantissa_bits: 23,
        is_signed: true,
    };

    fn ufloat(mantissa_bits: u8) -> Self {
        Self {
            exponent_bits: 5,
            mantissa_bits,
            is_signed: false,
        }
    }
}

fn integer(bits: u8, channel: u32, texel: u32) -> u32 {
    let codes = 1 << bits;
    let (round, place) = (texel / codes, texel % codes);
    let step = STEPS[channel as usize % STEPS.len()];
    // Few texels meet the high bits of wide channels too. The factor is odd, so that every code occurs.
    let stride = (codes >> 10) | 1;
    // Rounds and channels start at different codes, so that neither repeats another.
    (place * step * stride + round * 11 + channel * 85) % codes
}

/// Returns the code of a normal number: the conversion of other numbers is partly open.
fn float(layout: FloatLayout, channel: u32, texel: u32) -> u32 {
    let FloatLayout {
        exponent_bits,
        mantissa_bits,
        is_signed,
    } = layout;
    let hash = mixed(texel * STEPS.len() as u32 + channel);
    let mantissa = hash & ((1 << mantissa_bits) - 1);
    let normal = (1 << exponent_bits) - 2;
    let exponent = 1 + (texel + channel * 11) % normal;
    let sign = u32::from(is_signed) * (hash >> 31);
    ((sign << exponent_bits | exponent) << mantissa_bits) | mantissa
}

/// A variant of MurmurHash3's finaliser. It begins with a constant, so that 0 does not stay 0.
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

    /// Calls `check` with each channel of each colour format: a name, the encoding, and the codes.
    fn for_each_channel(check: impl Fn(&str, ChannelEncoding, &[u32])) {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            let codes = codes(format, SIZE);
            let channels = format.color_channels();
            assert_eq!(codes.len(), (SIZE[0] * SIZE[1]) as usize * channels.len());
            for (c, encoding) in channels.iter().enumerate() {
                let codes = codes.iter().skip(c).step_by(channels.len());
                let codes: Vec<u32> = codes.copied().collect();
                check(&format!("{format} {c}"), *encoding, &codes);
            }
        }
    }

    #[test]
    fn every_bit_of_every_channel_is_seen_both_ways() {
        for_each_channel(|name, encoding, codes| {
            let mask = encoding.mask();
            let ones = codes.iter().fold(0, |a, b| a | b);
            let zeros = codes.iter().fold(mask, |a, b| a & b);
            assert_eq!((ones, zeros), (mask, 0), "{name}");
        });
    }

    #[test]
    fn every_float_is_normal() {
        for_each_channel(|name, encoding, codes| {
            for code in codes.iter().copied().filter(|_| encoding.is_float()) {
                let value = encoding.value_of_order(encoding.order_of_code(code));
                assert!(value.is_finite() && value != 0.0, "{name}: {code:x}");
                assert_eq!(encoding.nearest_code(value), code, "{name}");
            }
        });
    }

    #[test]
    fn every_integer_code_occurs_that_the_texels_can_hold() {
        for_each_channel(|name, encoding, codes| {
            if encoding.is_float() {
                return;
            }
            let different = codes.iter().collect::<BTreeSet<_>>().len() as u32;
            let skipped = matches!(encoding, ChannelEncoding::Snorm(_));
            let all = encoding.mask() + 1 - u32::from(skipped);
            assert_eq!(different, all.min(codes.len() as u32), "{name}");
        });
    }

    #[test]
    fn values_are_beside_every_code_on_both_sides() {
        for format in [TextureFormat::Rgb10a2Unorm, TextureFormat::Rgba8UnormSrgb] {
            let colors = beside(format, &[-0.02, 0.02], [64, 32]).expect("its codes have values");
            for (channel, encoding) in format.color_channels().iter().enumerate() {
                let sides = |color: &[f32; 4]| {
                    let value = f64::from(color[channel]);
                    let code = encoding.nearest_code(value);
                    (code, encoding.value_of_order(i64::from(code)) < value)
                };
                let met: BTreeSet<_> = colors.iter().map(sides).collect();
                // Nothing is below the first code and above the last.
                let most = encoding.mask();
                let all = (1..most).flat_map(|code| [(code, false), (code, true)]);
                assert!(
                    all.into_iter().all(|side| met.contains(&side)),
                    "{format} {channel}"
                );
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
