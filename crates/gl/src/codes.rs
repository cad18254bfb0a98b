//! Colour codes in client memory.

use etalon_frame::TextureFormat;

/// The layout of a texel's channels in client memory.
enum ChannelLayout {
    /// One integer of this many bytes per channel.
    Each(usize),
    /// One integer of this many bytes per texel, with the channels at these bits.
    Packed(usize, &'static [u32]),
}

/// Returns the layout of the client format of `gl_format`.
fn layout(format: TextureFormat) -> ChannelLayout {
    match format {
        TextureFormat::Rgb10a2Unorm | TextureFormat::Rgb10a2Uint => {
            ChannelLayout::Packed(4, &[0, 10, 20, 30])
        }
        TextureFormat::Rg11b10Ufloat => ChannelLayout::Packed(4, &[0, 11, 22]),
        TextureFormat::B5g6r5Unorm => ChannelLayout::Packed(2, &[11, 5, 0]),
        TextureFormat::Bgr5a1Unorm => ChannelLayout::Packed(2, &[11, 6, 1, 0]),
        TextureFormat::Bgra4Unorm => ChannelLayout::Packed(2, &[12, 8, 4, 0]),
        _ => {
            let first = format.color_channels().first();
            ChannelLayout::Each(first.map_or(1, |channel| channel.bits() as usize / 8))
        }
    }
}

/// Returns the size of a texel in client memory.
pub(crate) fn texel_bytes(format: TextureFormat) -> usize {
    match layout(format) {
        ChannelLayout::Each(size) => size * format.color_channels().len(),
        ChannelLayout::Packed(size, _) => size,
    }
}

/// Returns, for each channel, its first bit in a texel of client memory and its number of bits.
pub(crate) fn places(format: TextureFormat) -> Vec<[u32; 2]> {
    let channels = (0..).zip(format.color_channels());
    match layout(format) {
        ChannelLayout::Each(size) => channels
            .map(|(c, _)| [c * 8 * size as u32, 8 * size as u32])
            .collect(),
        ChannelLayout::Packed(_, shifts) => channels
            .zip(shifts)
            .map(|((_, e), s)| [*s, e.bits()])
            .collect(),
    }
}

/// Returns codes as a client image.
pub(crate) fn pack(format: TextureFormat, codes: &[u32]) -> Vec<u8> {
    let mut bytes = Vec::new();
    match layout(format) {
        ChannelLayout::Each(size) => {
            for code in codes {
                put(&mut bytes, *code, size);
            }
        }
        ChannelLayout::Packed(size, shifts) => {
            for texel in codes.chunks_exact(shifts.len()) {
                let word = texel.iter().zip(shifts).fold(0, |w, (c, s)| w | c << s);
                put(&mut bytes, word, size);
            }
        }
    }
    bytes
}

/// Returns the codes of a client image.
pub(crate) fn unpack(format: TextureFormat, bytes: &[u8]) -> Vec<u32> {
    match layout(format) {
        ChannelLayout::Each(size) => bytes.chunks_exact(size).map(get).collect(),
        ChannelLayout::Packed(size, shifts) => {
            let masks: Vec<u32> = format.color_channels().iter().map(|e| e.mask()).collect();
            let texels = bytes.chunks_exact(size).map(get);
            texels
                .flat_map(|word| shifts.iter().zip(&masks).map(move |(s, m)| word >> s & m))
                .collect()
        }
    }
}

/// Appends an integer. Client integers have native byte order.
fn put(bytes: &mut Vec<u8>, word: u32, size: usize) {
    match size {
        1 => bytes.push(word as u8),
        2 => bytes.extend_from_slice(&(word as u16).to_ne_bytes()),
        _ => bytes.extend_from_slice(&word.to_ne_bytes()),
    }
}

fn get(bytes: &[u8]) -> u32 {
    match *bytes {
        [a] => u32::from(a),
        [a, b] => u32::from(u16::from_ne_bytes([a, b])),
        [a, b, c, d] => u32::from_ne_bytes([a, b, c, d]),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_and_unpacking_are_inverse() {
        for format in TextureFormat::ALL.into_iter().filter(|f| f.is_color()) {
            let channels = format.color_channels();
            let repeated = channels.iter().cycle().take(channels.len() * 3);
            let codes: Vec<u32> = (0..)
                .zip(repeated)
                .map(|(i, e)| 0x9e37_79b9_u32.rotate_left(i * 7) >> (32 - e.bits()))
                .collect();
            let bytes = pack(format, &codes);
            assert_eq!(bytes.len(), texel_bytes(format) * 3, "{format}");
            assert_eq!(unpack(format, &bytes), codes, "{format}");
        }
    }
}
