//! Attachments in memory, stored tile by tile.

use super::layer::Tiles;
use super::layout::{ChannelField, WordLayout};
use super::threads::on_threads;
use super::{AREA, TILE};
use crate::steps::{Faithful, Steps};
use crate::surface::depth_encoding;
use etalon_frame::Aspect;
use etalon_scene::{Attachment, AttachmentContents};
use fearless_simd::{Level, dispatch, prelude::*};

/// The codes of a texel's 8-bit colour channels, which are the bytes of a word in memory. Channels that the
/// format lacks are 0.
pub(crate) type TexelWord = [u8; 4];

/// The smallest number of codes that several threads read.
const SHARED: usize = 1 << 16;

/// An attachment. Texels beyond its edges have no meaning.
#[derive(Debug)]
pub(crate) struct TiledImage {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The number of tiles in a row of tiles.
    pub(crate) across: usize,
    pub(crate) samples: usize,
    /// The layout of a colour texel in words.
    pub(crate) layout: WordLayout,
    pub(crate) color: Tiles<u32>,
    pub(crate) depth: Tiles<u32>,
    pub(crate) stencil: Tiles<u8>,
}

impl TiledImage {
    /// Returns memory for an attachment, without contents.
    pub(crate) fn new(attachment: &Attachment) -> Self {
        let [width, height] = attachment.size.map(|s| s as usize);
        let (across, down) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let samples = attachment.samples as usize;
        let tiles = across * down;
        let format = attachment.format;
        let layout = WordLayout::new(format.color_channels());
        let words = |has: bool| usize::from(has);
        Self {
            width,
            height,
            across,
            samples,
            layout,
            color: Tiles::new(tiles, samples, layout.words),
            depth: Tiles::new(tiles, samples, words(format.has_depth())),
            stencil: Tiles::new(tiles, samples, words(format.has_stencil())),
        }
    }

    /// Sets the attachment's initial contents.
    pub(crate) fn begin(&mut self, attachment: &Attachment) {
        let encodings = attachment.format.color_channels();
        match &attachment.contents {
            AttachmentContents::Color(value) => {
                let code = |c: usize| Faithful.clear_code(encodings[c], value[c]);
                self.color.clear(self.layout.texel(code));
            }
            AttachmentContents::DepthStencil { depth, stencil } => {
                if let Some(encoding) = depth_encoding(attachment.format) {
                    self.depth.clear([Faithful.clear_code(encoding, *depth); 4]);
                }
                self.stencil.clear([*stencil; 4]);
            }
            AttachmentContents::Texels(codes) => {
                self.color.overwrite();
                for (i, codes) in codes.chunks_exact(encodings.len()).enumerate() {
                    let (x, y) = (i % self.width, i / self.width);
                    let texel = self.layout.texel(|c| codes[c]);
                    for (word, value) in texel.into_iter().enumerate().take(self.layout.words) {
                        let place = self.color_place(x, y, 0, word);
                        self.color.texels[place] = value;
                    }
                }
            }
        }
    }

    /// Returns the index of a texel's tile.
    pub(crate) fn tile(&self, x: usize, y: usize) -> usize {
        y / TILE * self.across + x / TILE
    }

    /// Returns the index of a word of a texel's sample in the colour memory.
    pub(crate) fn color_place(&self, x: usize, y: usize, sample: usize, word: usize) -> usize {
        let plane = (self.tile(x, y) * self.samples + sample) * self.layout.words + word;
        plane * AREA + y % TILE * TILE + x % TILE
    }

    /// Returns the index of a texel's sample in the memory of depth or stencil.
    pub(crate) fn place(&self, x: usize, y: usize, sample: usize) -> usize {
        (self.tile(x, y) * self.samples + sample) * AREA + y % TILE * TILE + x % TILE
    }

    /// Returns the codes of one aspect in the order of [`etalon_frame::Image`]. Several threads write them, with
    /// these vector instructions.
    pub(crate) fn codes(
        &self,
        aspect: Aspect,
        channels: usize,
        level: Level,
        threads: usize,
    ) -> Vec<u32> {
        let row = (self.width * self.samples * channels).max(1);
        let mut codes = vec![0; self.height * row];
        let jobs = if codes.len() < SHARED { 1 } else { threads };
        // The rows of a job: whole tiles.
        let rows = self.height.div_ceil(TILE).div_ceil(jobs).max(1) * TILE;
        // Several planes are read in the order of their tiles in memory. One plane is quicker row by row.
        let planes = match aspect {
            Aspect::Color => self.samples * self.layout.words,
            Aspect::Depth | Aspect::Stencil => self.samples,
        };
        let jobs: Vec<_> = codes.chunks_mut(rows * row).enumerate().collect();
        on_threads(jobs, &|(number, part)| {
            dispatch!(level, simd => simd.vectorize(
                #[inline(always)]
                || {
                    let first = number * rows;
                    if planes > 1 {
                        for (band, codes) in part.chunks_mut(TILE * row).enumerate() {
                            self.tiles(aspect, channels, first + band * TILE, codes);
                        }
                    } else {
                        for (y, codes) in part.chunks_exact_mut(row).enumerate() {
                            self.whole_row(aspect, channels, first + y, codes);
                        }
                    }
                },
            ));
        });
        codes
    }

    /// Writes the codes of rows of texels in one row of tiles, from row `y` on, tile by tile.
    #[inline(always)]
    fn tiles(&self, aspect: Aspect, channels: usize, y: usize, codes: &mut [u32]) {
        let texel = self.samples * channels;
        for column in 0..self.across {
            for (y, row) in (y..).zip(codes.chunks_exact_mut(self.width * texel)) {
                let end = row.len().min((column + 1) * TILE * texel);
                let part = &mut row[column * TILE * texel..end];
                self.part(aspect, channels, [column, y], part);
            }
        }
    }

    /// Writes the codes of one row of texels.
    #[inline(always)]
    fn whole_row(&self, aspect: Aspect, channels: usize, y: usize, codes: &mut [u32]) {
        let parts = codes.chunks_mut(TILE * self.samples * channels);
        for (column, part) in parts.enumerate() {
            self.part(aspect, channels, [column, y], part);
        }
    }

    /// Writes the codes of the texels of row `y` that are in a column of tiles.
    #[inline(always)]
    fn part(&self, aspect: Aspect, channels: usize, [column, y]: [usize; 2], codes: &mut [u32]) {
        let tile = y / TILE * self.across + column;
        for sample in 0..self.samples {
            let plane = tile * self.samples + sample;
            let rest = &mut codes[sample * channels..];
            self.row(aspect, channels, [plane, y % TILE * TILE], rest);
        }
    }

    /// Writes the codes of one sample of a tile's row, given the sample's plane and the row's position in it.
    #[inline(always)]
    fn row(&self, aspect: Aspect, channels: usize, [plane, within]: [usize; 2], codes: &mut [u32]) {
        let step = self.samples * channels;
        let place = plane * AREA + within;
        match aspect {
            Aspect::Color => {
                let words = |field: &ChannelField| {
                    let plane = plane * self.layout.words + field.word;
                    &self.color.texels[plane * AREA + within..][..TILE]
                };
                match (self.layout.fields(), self.samples) {
                    ([first, ..], 1) if self.layout.is_four_bytes() => {
                        let bytes: &[u8] = bytemuck::cast_slice(words(first));
                        for (code, byte) in codes.iter_mut().zip(bytes) {
                            *code = u32::from(*byte);
                        }
                    }
                    ([r, g, b, a], 1) => {
                        let pairs = words(r).iter().zip(words(g));
                        let pairs = pairs.zip(words(b).iter().zip(words(a)));
                        let (texels, _) = codes.as_chunks_mut::<4>();
                        for (codes, ((x, y), (z, w))) in texels.iter_mut().zip(pairs) {
                            *codes = [r.code(*x), g.code(*y), b.code(*z), a.code(*w)];
                        }
                    }
                    (fields, _) => {
                        for (c, field) in fields.iter().enumerate() {
                            spread(&mut codes[c..], step, words(field), |w| field.code(*w));
                        }
                    }
                }
            }
            Aspect::Depth => spread(codes, step, &self.depth.texels[place..][..TILE], |code| {
                *code
            }),
            Aspect::Stencil => {
                let values = &self.stencil.texels[place..][..TILE];
                spread(codes, step, values, |value| u32::from(*value));
            }
        }
    }
}

/// Writes a function of each value to every `step`-th code.
#[inline(always)]
fn spread<T>(codes: &mut [u32], step: usize, values: &[T], code: impl Fn(&T) -> u32) {
    for (slot, value) in codes.iter_mut().step_by(step).zip(values) {
        *slot = code(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::TextureFormat;

    #[test]
    fn codes_come_back_in_rows_for_any_layout() {
        let formats = [
            TextureFormat::R8Unorm,
            TextureFormat::Rgba8Unorm,
            TextureFormat::Rgba16Float,
            TextureFormat::Rgba32Float,
        ];
        for (format, samples) in formats.into_iter().flat_map(|f| [(f, 1), (f, 4)]) {
            let attachment = Attachment {
                name: "color".to_owned(),
                format,
                size: [130, 150],
                samples,
                contents: AttachmentContents::Color([0.0; 4]),
            };
            let mut image = TiledImage::new(&attachment);
            let (layout, channels) = (image.layout, format.color_channels());
            let mut expected = Vec::new();
            for (y, x) in (0..150).flat_map(|y| (0..130).map(move |x| (y, x))) {
                for sample in 0..samples as usize {
                    // Differs between neighbours in each direction.
                    let code = |c: usize| {
                        (x * 3 + y * 7 + sample * 31 + c * 57) as u32 & channels[c].mask()
                    };
                    for (word, value) in layout.texel(code).into_iter().enumerate() {
                        if word < layout.words {
                            let place = image.color_place(x, y, sample, word);
                            image.color.texels[place] = value;
                        }
                    }
                    expected.extend((0..channels.len()).map(code));
                }
            }
            for threads in [1, 3] {
                let codes = image.codes(Aspect::Color, channels.len(), Level::new(), threads);
                assert!(
                    codes == expected,
                    "{format}, {samples} samples, {threads} threads"
                );
            }
        }
    }
}
