//! The words of a colour texel. Channels start at the lowest bits, and a word has as many channels as fit.
//!
//! Words are little-endian in memory, so that 8-bit channels are bytes in order.

use etalon_frame::ChannelEncoding;

/// The words of a texel. Unused words are 0.
pub(crate) type TexelWords = [u32; 4];

/// The number of words of a texel, and the position of each channel in them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WordLayout {
    fields: [ChannelField; 4],
    channels: usize,
    pub(crate) words: usize,
}

/// Where a channel's codes are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ChannelField {
    pub(crate) word: usize,
    shift: u32,
    mask: u32,
}

impl WordLayout {
    /// Returns the layout of texels of these channels.
    pub(crate) fn new(encodings: &[ChannelEncoding]) -> Self {
        let mut fields = [ChannelField::default(); 4];
        let (mut words, mut room) = (0, 0);
        for (field, encoding) in fields.iter_mut().zip(encodings) {
            let bits = encoding.bits();
            if bits > room {
                (words, room) = (words + 1, 32);
            }
            *field = ChannelField {
                word: words - 1,
                shift: 32 - room,
                mask: encoding.mask(),
            };
            room -= bits;
        }
        Self {
            fields,
            channels: encodings.len(),
            words,
        }
    }

    /// Returns true if a texel is a word of four 8-bit channels, which are its bytes.
    #[inline(always)]
    pub(crate) fn is_four_bytes(&self) -> bool {
        let [first, ..] = self.fields;
        self.channels == 4 && self.words == 1 && first.mask == 0xff
    }

    /// Returns where each channel is.
    #[inline(always)]
    pub(crate) fn fields(&self) -> &[ChannelField] {
        &self.fields[..self.channels]
    }

    /// Returns the texel with the codes that a function gives.
    pub(crate) fn texel(&self, code: impl Fn(usize) -> u32) -> TexelWords {
        let mut texel = [0; 4];
        for (c, field) in self.fields().iter().enumerate() {
            texel[field.word] |= field.word_of(code(c));
        }
        texel
    }
}

impl ChannelField {
    /// Returns the code that a word contains.
    #[inline(always)]
    pub(crate) fn code(self, word: u32) -> u32 {
        u32::from_le(word) >> self.shift & self.mask
    }

    /// Returns a word that contains a code and otherwise zeros.
    #[inline(always)]
    pub(crate) fn word_of(self, code: u32) -> u32 {
        ((code & self.mask) << self.shift).to_le()
    }

    /// Returns the word with its code replaced.
    #[inline(always)]
    pub(crate) fn replaced(self, word: u32, code: u32) -> u32 {
        word & !self.word_of(u32::MAX) | self.word_of(code)
    }
}

/// Returns true if all of these channels have 8 bits.
pub(crate) fn are_bytes(encodings: &[ChannelEncoding]) -> bool {
    encodings.iter().all(|e| e.bits() == 8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::TextureFormat;

    #[test]
    fn channels_do_not_overlap_and_keep_their_codes() {
        for format in TextureFormat::ALL {
            let encodings = format.color_channels();
            let layout = WordLayout::new(encodings);
            let bits: u32 = encodings.iter().map(|e| e.bits()).sum();
            assert_eq!(layout.words, bits.div_ceil(32) as usize, "{format}");
            let code = |c: usize| 0x9e37_79b9_u32.rotate_left(c as u32 * 7) & encodings[c].mask();
            let texel = layout.texel(code);
            for (c, field) in layout.fields().iter().enumerate() {
                assert_eq!(field.code(texel[field.word]), code(c), "{format} {c}");
                let other = field.replaced(texel[field.word], !code(c));
                for (d, rest) in layout.fields().iter().enumerate() {
                    let expected = if c == d {
                        !code(c) & encodings[c].mask()
                    } else {
                        code(d)
                    };
                    if rest.word == field.word {
                        assert_eq!(rest.code(other), expected, "{format} {c} {d}");
                    }
                }
            }
        }
    }

    #[test]
    fn channels_of_8_bits_are_bytes_in_memory() {
        let layout = WordLayout::new(TextureFormat::Rgba8Unorm.color_channels());
        let [word, ..] = layout.texel(|c| c as u32 + 1);
        assert_eq!(word.to_ne_bytes(), [1, 2, 3, 4]);
    }
}
