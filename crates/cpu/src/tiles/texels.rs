//! Textures whose texels a shader fetches where it draws.

use super::image::{AREA, Image, are_bytes, channel};
use super::plan::Fetched;
use crate::lanes::{Codes, LANES, Real};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

/// What a shader gives for neighbouring texels.
#[derive(Debug)]
pub(crate) struct Sources {
    /// The words of the first texture's texels, if they have one.
    pub(crate) words: Codes,
    pub(crate) first: [Real; 4],
    pub(crate) second: [Real; 4],
}

/// The sources of a shader that fetches nothing.
pub(crate) static NONE: Sources = Sources {
    words: [0; LANES],
    first: [[0.0; LANES]; 4],
    second: [[0.0; LANES]; 4],
};

/// The textures that a draw fetches from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Texels<'a> {
    first: Texture<'a>,
    second: Option<Texture<'a>>,
}

/// A texture as large as the attachments.
#[derive(Clone, Copy, Debug)]
struct Texture<'a> {
    image: &'a Image,
    channels: &'static [ChannelEncoding],
}

impl<'a> Texels<'a> {
    pub(crate) fn new(first: Fetched, second: Option<Fetched>, images: &'a [Image]) -> Self {
        let texture = |fetched: Fetched| Texture {
            image: &images[fetched.index],
            channels: fetched.channels,
        };
        Self {
            first: texture(first),
            second: second.map(texture),
        }
    }

    /// Returns the sources of the texels at a place of a tile's plane: with their values, or the words alone.
    #[inline(always)]
    pub(crate) fn sources(&self, tile: usize, at: usize, values: bool) -> Sources {
        let words = self.first.plane(tile, at, 0);
        if !values {
            return Sources { words, ..NONE };
        }
        Sources {
            words,
            first: self.first.values(tile, at),
            second: match &self.second {
                Some(texture) => texture.values(tile, at),
                None => NONE.second,
            },
        }
    }
}

impl Texture<'_> {
    /// Returns a word of texels at a place of a tile's plane.
    #[inline(always)]
    fn plane(&self, tile: usize, at: usize, word: usize) -> Codes {
        if let Some(clear) = self.image.clear.color {
            return [clear[word]; LANES];
        }
        let start = (tile * self.image.words + word) * AREA + at;
        let (lanes, _) = self.image.color[start..start + LANES].as_chunks();
        lanes[0]
    }

    /// Returns the values of texels at a place of a tile's plane; an alpha that the format lacks is 1.
    #[inline(always)]
    fn values(&self, tile: usize, at: usize) -> [Real; 4] {
        let mut values = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]];
        let bytes = are_bytes(self.channels);
        let words = self.plane(tile, at, 0);
        for (c, (value, encoding)) in values.iter_mut().zip(self.channels).enumerate() {
            let codes = match bytes {
                true => channel(&words, c),
                false => self.plane(tile, at, c),
            };
            *value = Plain::<LANES>.decode(*encoding, codes);
        }
        values
    }
}
