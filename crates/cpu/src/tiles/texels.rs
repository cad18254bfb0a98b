//! Textures whose texels a shader fetches where it draws.

use super::image::{AREA, Image, are_bytes, channel};
use super::plan::Fetched;
use crate::lanes::{Codes, LANES, Real};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

/// The commonest channels.
const UNORM: [ChannelEncoding; 4] = [ChannelEncoding::Unorm(8); 4];

/// Where a shader fetches its sources.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sources<'a> {
    texels: Option<&'a Texels<'a>>,
    tile: usize,
}

impl<'a> Sources<'a> {
    /// Returns those of a tile, of the textures that there are.
    #[inline(always)]
    pub(crate) fn new(texels: Option<&'a Texels<'a>>, tile: usize) -> Self {
        Self { texels, tile }
    }

    /// Returns the words of the first texture's texels at a place of the tile's plane, if they have one.
    #[inline(always)]
    pub(crate) fn words(&self, at: usize) -> Codes {
        match self.texels {
            Some(texels) => texels.first.plane(self.tile, at, 0),
            None => [0; LANES],
        }
    }

    /// Returns the values of the first texture's texels at a place of the tile's plane.
    #[inline(always)]
    pub(crate) fn first(&self, at: usize) -> [Real; 4] {
        match self.texels {
            Some(texels) => texels.first.values(self.tile, at),
            None => [[0.0; LANES]; 4],
        }
    }

    /// The same of the second texture, zeros if there is none.
    #[inline(always)]
    pub(crate) fn second(&self, at: usize) -> [Real; 4] {
        match self.texels.and_then(|t| t.second.as_ref()) {
            Some(texture) => texture.values(self.tile, at),
            None => [[0.0; LANES]; 4],
        }
    }
}

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
        let words = self.plane(tile, at, 0);
        // The commonest encoding is known to the compiler.
        if *self.channels == UNORM {
            for (c, value) in values.iter_mut().enumerate() {
                *value = Plain::<LANES>.decode(UNORM[0], channel(&words, c));
            }
            return values;
        }
        let bytes = are_bytes(self.channels);
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
