//! Attachments in memory, stored tile by tile.

use super::TILE;
use super::layout::{Field, Layout, Words};
use super::threads::on_threads;
use crate::steps::{Faithful, Steps};
use crate::surface::depth_encoding;
use etalon_frame::Aspect;
use etalon_scene::{Attachment, Contents};

/// The codes of a texel's 8-bit colour channels, which are the bytes of a word in memory. Channels that the
/// format lacks are 0.
pub(crate) type Texel = [u8; 4];

/// The texels of a tile.
pub(crate) const AREA: usize = TILE * TILE;

/// The smallest number of codes that several threads read.
const SHARED: usize = 1 << 16;

/// An attachment. Each aspect is stored tile by tile, in rows of tiles. A tile consists of planes, one for
/// each word of each sample, and a plane of its rows. Texels beyond the attachment's edges have no meaning.
#[derive(Debug)]
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The number of tiles in a row of tiles.
    pub(crate) across: usize,
    pub(crate) samples: usize,
    /// The layout of a colour texel in words.
    pub(crate) layout: Layout,
    pub(crate) color: Vec<u32>,
    pub(crate) depth: Vec<u32>,
    pub(crate) stencil: Vec<u8>,
    /// The clear values of aspects that are not in memory yet.
    pub(crate) clear: Clears,
}

/// The values of aspects that were cleared and not written since.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clears {
    pub(crate) color: Option<Words>,
    pub(crate) depth: Option<u32>,
    pub(crate) stencil: Option<u8>,
}

/// Returns the words of a texel, repeated endlessly.
fn cycle(texel: Words, words: usize) -> impl Iterator<Item = u32> {
    (0..words).cycle().map(move |word| texel[word])
}

impl Image {
    /// Returns memory for an attachment, without contents.
    pub(crate) fn new(attachment: &Attachment) -> Self {
        let [width, height] = attachment.size.map(|s| s as usize);
        let (across, down) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let samples = attachment.samples as usize;
        let texels = across * down * samples * AREA;
        let format = attachment.format;
        let layout = Layout::new(format.color_channels());
        let count = |has: bool| if has { texels } else { 0 };
        Self {
            width,
            height,
            across,
            samples,
            layout,
            color: vec![0; layout.words * count(format.is_color())],
            depth: vec![0; count(format.has_depth())],
            stencil: vec![0; count(format.has_stencil())],
            clear: Clears::default(),
        }
    }

    /// Sets the attachment's initial contents.
    pub(crate) fn begin(&mut self, attachment: &Attachment) {
        let encodings = attachment.format.color_channels();
        self.clear = Clears::default();
        match &attachment.contents {
            Contents::Color(value) => {
                let code = |c: usize| Faithful.clear_code(encodings[c], value[c]);
                self.clear.color = Some(self.layout.texel(code));
            }
            Contents::DepthStencil { depth, stencil } => {
                let encoding = depth_encoding(attachment.format);
                self.clear.depth = encoding.map(|e| Faithful.clear_code(e, *depth));
                self.clear.stencil = attachment.format.has_stencil().then_some(*stencil);
            }
            Contents::Texels(codes) => {
                for (i, codes) in codes.chunks_exact(encodings.len()).enumerate() {
                    let (x, y) = (i % self.width, i / self.width);
                    let texel = self.layout.texel(|c| codes[c]);
                    for (word, value) in texel.into_iter().enumerate().take(self.layout.words) {
                        let place = self.color_place(x, y, 0, word);
                        self.color[place] = value;
                    }
                }
            }
        }
    }

    /// Writes the clear values of aspects that were not drawn to.
    pub(crate) fn finish(&mut self) {
        let clear = std::mem::take(&mut self.clear);
        if let Some(value) = clear.color {
            for (plane, value) in self
                .color
                .chunks_exact_mut(AREA)
                .zip(cycle(value, self.layout.words))
            {
                plane.fill(value);
            }
        }
        if let Some(value) = clear.depth {
            self.depth.fill(value);
        }
        if let Some(value) = clear.stencil {
            self.stencil.fill(value);
        }
    }

    /// Returns the index of a word of a texel's sample in the colour memory.
    pub(crate) fn color_place(&self, x: usize, y: usize, sample: usize, word: usize) -> usize {
        let tile = y / TILE * self.across + x / TILE;
        let plane = (tile * self.samples + sample) * self.layout.words + word;
        plane * AREA + y % TILE * TILE + x % TILE
    }

    /// Returns the index of a texel's sample in the memory of depth or stencil.
    pub(crate) fn place(&self, x: usize, y: usize, sample: usize) -> usize {
        let tile = y / TILE * self.across + x / TILE;
        (tile * self.samples + sample) * AREA + y % TILE * TILE + x % TILE
    }

    /// Returns the codes of one aspect in the order of [`etalon_frame::Image`]. This many threads read them.
    pub(crate) fn codes(&self, aspect: Aspect, channels: usize, threads: usize) -> Vec<u32> {
        let row = (self.width * self.samples * channels).max(1);
        let mut codes = vec![0; self.height * row];
        let rows = if codes.len() < SHARED {
            self.height
        } else {
            self.height.div_ceil(threads)
        };
        let jobs: Vec<_> = codes.chunks_mut((rows * row).max(1)).enumerate().collect();
        on_threads(jobs, &|(number, part)| {
            for (y, codes) in part.chunks_exact_mut(row).enumerate() {
                self.tiles_row(aspect, channels, number * rows + y, codes);
            }
        });
        codes
    }

    /// Writes the codes of one row of texels.
    fn tiles_row(&self, aspect: Aspect, channels: usize, y: usize, codes: &mut [u32]) {
        let parts = codes.chunks_mut(TILE * self.samples * channels);
        for (column, part) in parts.enumerate() {
            let tile = y / TILE * self.across + column;
            for sample in 0..self.samples {
                let plane = tile * self.samples + sample;
                let rest = &mut part[sample * channels..];
                self.row(aspect, channels, [plane, y % TILE * TILE], rest);
            }
        }
    }

    /// Writes the codes of one sample of a tile's row, given the sample's plane and the row's position in it.
    fn row(&self, aspect: Aspect, channels: usize, [plane, within]: [usize; 2], codes: &mut [u32]) {
        let step = self.samples * channels;
        let place = plane * AREA + within;
        match aspect {
            Aspect::Color => {
                let words = |field: &Field| {
                    let plane = plane * self.layout.words + field.word;
                    &self.color[plane * AREA + within..][..TILE]
                };
                match (self.layout.fields(), self.samples) {
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
            Aspect::Depth => spread(codes, step, &self.depth[place..][..TILE], |code| *code),
            Aspect::Stencil => {
                let values = &self.stencil[place..][..TILE];
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
