//! The meaning of the bytes that are read.

use crate::texel;
use etalon_backend::codes::code_of_fetched;
use etalon_frame::{Aspect, ChannelEncoding, Frame, Image, ReadPath, TextureFormat};
use serde::{Deserialize, Serialize};

/// The size of an `rgba32uint` texel in bytes.
const SAMPLE_BYTES: usize = 16;

/// The images and counters in a mapped buffer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MappedReading {
    /// The number of bytes of the buffer that have a meaning.
    pub bytes: u64,
    /// The images.
    pub images: Vec<ImageReading>,
    /// The counters, in the order of the scene's counters.
    pub counters: Vec<CounterReading>,
}

impl MappedReading {
    /// Returns the frame in the bytes of the buffer, or `None` if there are too few bytes.
    pub fn frame(&self, bytes: &[u8]) -> Option<Frame> {
        let bytes = bytes.get(..usize::try_from(self.bytes).ok()?)?;
        Some(Frame {
            images: self.images.iter().map(|image| image.image(bytes)).collect(),
            counters: self
                .counters
                .iter()
                .map(|counter| counter.count(bytes))
                .collect(),
        })
    }
}

/// The results of a counter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CounterReading {
    /// Where the numbers are that add up to the result.
    pub parts: Vec<Place>,
    /// True if the result only says whether the sum is greater than 0, as 1 or 0.
    pub any: bool,
}

/// The place of a little-endian number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// The first byte.
    pub offset: u64,
    /// The number of bytes.
    pub bytes: u64,
}

impl CounterReading {
    fn count(&self, bytes: &[u8]) -> u64 {
        let number = |part: &Place| {
            let place = part.offset as usize..(part.offset + part.bytes) as usize;
            let digits = bytes[place].iter().rev();
            digits.fold(0, |value, byte| value << 8 | u64::from(*byte))
        };
        let sum = self.parts.iter().map(number).fold(0, u64::saturating_add);
        if self.any { u64::from(sum > 0) } else { sum }
    }
}

/// The route by which an aspect reaches the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReadMethod {
    /// Copied from the attachment.
    Copy,
    /// Fetched by a shader, with four values per texel.
    FetchTexel,
    /// Fetched by a shader as the bits of floats.
    FetchDepth,
    /// Fetched by a shader sample by sample. Each sample is an image of four values per texel.
    FetchSamples,
    /// Read by stencil tests bit by bit, with four bits per image. OpenGL has had the texture mode for
    /// fetching stencil only since 4.3 and ES 3.1.
    StencilBits,
}

/// One aspect of an attachment in the buffer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageReading {
    /// The attachment.
    pub attachment: String,
    /// The format of the attachment.
    pub format: TextureFormat,
    /// The aspect.
    pub aspect: Aspect,
    /// Width and height.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// The encodings of the channels.
    pub channels: Vec<ChannelEncoding>,
    /// The read path that the image declares. Multisampling is supported only if a shader returns the codes
    /// of a copy, or a shader also reads single samples; stencil is exact on both paths.
    pub read: ReadPath,
    /// The route by which the image reaches the buffer.
    pub method: ReadMethod,
    /// The first byte.
    pub offset: u64,
    /// The distance between rows, in bytes.
    pub pitch: u32,
}

impl ImageReading {
    /// Returns the size of a texel in the buffer, in bytes.
    pub fn texel_bytes(&self) -> usize {
        match (self.method, self.aspect) {
            (ReadMethod::FetchSamples | ReadMethod::FetchTexel, _) => SAMPLE_BYTES,
            (ReadMethod::FetchDepth | ReadMethod::StencilBits, _) => 4,
            (ReadMethod::Copy, Aspect::Color) => texel::bytes(self.format),
            (ReadMethod::Copy, Aspect::Stencil) => 1,
            (ReadMethod::Copy, Aspect::Depth) => match self.channels.as_slice() {
                [ChannelEncoding::Unorm(16)] => 2,
                _ => 4,
            },
        }
    }

    /// Returns the first bit and the width of each channel in a copied texel.
    pub fn copied_channels(&self) -> Vec<[u32; 2]> {
        match self.aspect {
            Aspect::Color => texel::places(self.format),
            Aspect::Depth | Aspect::Stencil => vec![[0, 8 * self.texel_bytes() as u32]],
        }
    }

    /// Returns the size of one of its images in the buffer, in bytes.
    pub fn image_bytes(&self) -> u64 {
        u64::from(self.pitch) * u64::from(self.size[1])
    }

    /// Returns the size of all of its images in the buffer, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        match self.method {
            ReadMethod::Copy | ReadMethod::FetchDepth | ReadMethod::FetchTexel => {
                self.image_bytes()
            }
            ReadMethod::FetchSamples => u64::from(self.samples) * self.image_bytes(),
            ReadMethod::StencilBits => 2 * self.image_bytes(),
        }
    }

    fn image(&self, bytes: &[u8]) -> Image {
        let codes = match self.method {
            ReadMethod::Copy | ReadMethod::FetchDepth => self.copied(bytes),
            ReadMethod::FetchSamples | ReadMethod::FetchTexel => self.fetched(bytes),
            ReadMethod::StencilBits => {
                let (low, high) = (self.texels(bytes, 0), self.texels(bytes, 1));
                low.zip(high)
                    .map(|(low, high)| {
                        let bits = low.iter().chain(high).rev();
                        bits.fold(0, |value, bit| value << 1 | u32::from(*bit != 0))
                    })
                    .collect()
            }
        };
        Image {
            attachment: self.attachment.clone(),
            aspect: self.aspect,
            size: self.size,
            samples: self.samples,
            channels: self.channels.clone(),
            read: self.read,
            codes,
        }
    }

    /// Returns the texels of the image with this index, row by row.
    fn texels<'b>(&self, bytes: &'b [u8], image: u64) -> impl Iterator<Item = &'b [u8]> + use<'b> {
        let texel = self.texel_bytes();
        let row = self.size[0] as usize * texel;
        let start = self.offset + image * self.image_bytes();
        bytes[start as usize..(start + self.image_bytes()) as usize]
            .chunks(self.pitch as usize)
            .flat_map(move |padded| padded[..row].chunks(texel))
    }

    fn copied(&self, bytes: &[u8]) -> Vec<u32> {
        let mut codes = Vec::new();
        for texel in self.texels(bytes, 0) {
            if self.aspect == Aspect::Color {
                texel::unpack(self.format, texel, &mut codes);
            } else {
                codes.push(word(texel));
            }
        }
        codes
    }

    fn fetched(&self, bytes: &[u8]) -> Vec<u32> {
        let mut images: Vec<_> = (0..self.samples)
            .map(|sample| self.texels(bytes, sample.into()))
            .collect();
        let texels = self.size[0] as usize * self.size[1] as usize;
        let mut codes = Vec::with_capacity(texels * images.len() * self.channels.len());
        for _ in 0..texels {
            for texel in images.iter_mut().filter_map(Iterator::next) {
                let channels = texel.chunks(4).zip(&self.channels);
                codes.extend(
                    channels.map(|(bits, encoding)| code_of_fetched(*encoding, word(bits))),
                );
            }
        }
        codes
    }
}

/// Returns the little-endian number in at most four bytes.
fn word(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |value, byte| value << 8 | u32::from(*byte))
}
