//! Textures whose texels a shader fetches at the position that it draws.

use super::AREA;
use super::image::TiledImage;
use super::plan::FetchedTexture;
use super::planes::{CodePlane, Plane, decode};
use crate::lanes::{LANES, LaneCodes};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};

/// The textures that a shader fetches from, at a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sources<'a> {
    texels: Option<&'a FetchTextures<'a>>,
    tile: usize,
}

impl<'a> Sources<'a> {
    /// Returns the sources at a tile.
    #[inline(always)]
    pub(crate) fn new(texels: Option<&'a FetchTextures<'a>>, tile: usize) -> Self {
        Self { texels, tile }
    }

    /// Returns the words of the first texture's texels at an index of the tile's plane, which must be one
    /// word each.
    #[inline(always)]
    pub(crate) fn words(&self, offset: usize) -> LaneCodes {
        match self.texels {
            Some(texels) => texels.first.plane(self.tile, offset, 0),
            None => [0; LANES],
        }
    }

    /// Returns whether values of the first and of the second texture can be below 0 or above 1.
    #[inline(always)]
    pub(crate) fn exceed_unit(&self) -> [bool; 2] {
        let texels = self.texels;
        [
            texels.is_some_and(|t| t.first.exceeds_unit()),
            texels.is_some_and(|t| t.second.as_ref().is_some_and(SourceTexture::exceeds_unit)),
        ]
    }

    /// Computes the values of the first texture's texels at indices of the tile's plane, by channel.
    #[inline(always)]
    pub(crate) fn first(&self, places: &[u16], values: &mut [Plane; 4]) {
        if let Some(texels) = self.texels {
            texels.first.values(self.tile, places, values);
        }
    }

    /// Computes the values of the second texture's texels, if there is a second texture.
    #[inline(always)]
    pub(crate) fn second(&self, places: &[u16], values: &mut [Plane; 4]) {
        if let Some(texture) = self.texels.and_then(|t| t.second.as_ref()) {
            texture.values(self.tile, places, values);
        }
    }
}

/// The textures that a draw fetches from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FetchTextures<'a> {
    first: SourceTexture<'a>,
    second: Option<SourceTexture<'a>>,
}

/// A texture of the attachments' size.
#[derive(Clone, Copy, Debug)]
struct SourceTexture<'a> {
    image: &'a TiledImage,
    channels: &'static [ChannelEncoding],
}

impl<'a> FetchTextures<'a> {
    pub(crate) fn new(
        first: FetchedTexture,
        second: Option<FetchedTexture>,
        images: &'a [TiledImage],
    ) -> Self {
        let texture = |fetched: FetchedTexture| SourceTexture {
            image: &images[fetched.index],
            channels: fetched.channels,
        };
        Self {
            first: texture(first),
            second: second.map(texture),
        }
    }
}

impl SourceTexture<'_> {
    /// Returns true if values can be below 0 or above 1.
    #[inline(always)]
    fn exceeds_unit(&self) -> bool {
        use ChannelEncoding::{Srgb8, Unorm};
        !self.channels.iter().all(|e| matches!(e, Unorm(_) | Srgb8))
    }

    /// Returns a word of the texels at an index of a tile's plane.
    #[inline(always)]
    fn plane(&self, tile: usize, offset: usize, word: usize) -> LaneCodes {
        if let Some(clear) = self.image.color.cleared(tile) {
            return [clear[word]; LANES];
        }
        let start = (tile * self.image.layout.words + word) * AREA + offset;
        let (lanes, _) = self.image.color.texels[start..start + LANES].as_chunks();
        lanes[0]
    }

    /// Computes the values of texels at indices of a tile's plane. Channels that the format lacks are 0, and
    /// alpha 1.
    #[inline(always)]
    fn values(&self, tile: usize, places: &[u16], values: &mut [Plane; 4]) {
        let (mut words, mut codes): (CodePlane, CodePlane) = ([0; _], [0; _]);
        let count = places.len() * LANES;
        let fields = self.image.layout.fields();
        let mut last = None;
        for (c, values) in values.iter_mut().enumerate() {
            let (Some(field), Some(encoding)) = (fields.get(c), self.channels.get(c)) else {
                values.fill(if c == 3 { 1.0 } else { 0.0 });
                continue;
            };
            if let Some(clear) = self.image.color.cleared(tile) {
                let code = [field.code(clear[field.word]); LANES];
                values.fill(Plain::<LANES>.decode(*encoding, code)[0]);
                continue;
            }
            if last.replace(field.word) != Some(field.word) {
                for (words, place) in words.as_chunks_mut().0.iter_mut().zip(places) {
                    *words = self.plane(tile, usize::from(*place), field.word);
                }
            }
            for (code, word) in codes.iter_mut().zip(&words) {
                *code = field.code(*word);
            }
            decode(*encoding, &codes[..count], values);
        }
    }
}
