//! Attachments in memory: one plane of codes per channel and sample. Rows are padded to whole spans, so that
//! a span loads and stores contiguous codes.

use crate::lanes::LANES;
use etalon_frame::{Aspect, ChannelEncoding, TextureFormat};
use etalon_scene::{Attachment, AttachmentContents, ResolveMode};
use std::ops::Range;

/// An attachment in memory.
#[derive(Clone, Debug)]
pub struct CpuSurface {
    /// The number of texels in a row.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// The distance between rows in texels: the width rounded up to whole spans.
    pub stride: usize,
    /// Samples per texel.
    pub samples: usize,
    /// The planes of the colour channels, or of depth: channel by channel, and sample by sample within a
    /// channel.
    pub planes: Vec<Vec<u32>>,
    /// The planes of stencil, one per sample; empty if the format has no stencil.
    pub stencil: Vec<Vec<u8>>,
    /// The encodings of the colour channels.
    pub encodings: &'static [ChannelEncoding],
    /// The encoding of depth.
    pub depth: Option<ChannelEncoding>,
}

impl CpuSurface {
    /// Returns the attachment with its initial contents. `clear_code` converts a clear value to a code.
    pub(crate) fn new(
        attachment: &Attachment,
        clear_code: impl Fn(ChannelEncoding, f32) -> u32,
    ) -> Self {
        let [width, height] = attachment.size.map(|s| s as usize);
        let stride = width.next_multiple_of(LANES);
        let format = attachment.format;
        let texels = stride * height;
        let samples = attachment.samples as usize;
        let mut surface = Self {
            width,
            height,
            stride,
            samples,
            planes: Vec::new(),
            stencil: Vec::new(),
            encodings: format.color_channels(),
            depth: depth_encoding(format),
        };
        match &attachment.contents {
            AttachmentContents::Color(color) => {
                for (encoding, value) in format.color_channels().iter().zip(color) {
                    let code = clear_code(*encoding, *value);
                    let planes = (0..samples).map(|_| vec![code; texels]);
                    surface.planes.extend(planes);
                }
            }
            AttachmentContents::DepthStencil { depth, stencil } => {
                if let Some(encoding) = depth_encoding(format) {
                    let code = clear_code(encoding, *depth);
                    surface.planes = vec![vec![code; texels]; samples];
                }
                if format.has_stencil() {
                    surface.stencil = vec![vec![*stencil; texels]; samples];
                }
            }
            AttachmentContents::Texels(codes) => {
                let channels = format.color_channels().len();
                for c in 0..channels {
                    let mut plane = vec![0; texels];
                    for (i, texel) in codes.chunks_exact(channels).enumerate() {
                        plane[i / width * stride + i % width] = texel[c];
                    }
                    surface.planes.push(plane);
                }
            }
        }
        surface
    }

    /// Returns the plane of one channel and sample.
    pub fn plane(&self, channel: usize, sample: usize) -> &[u32] {
        &self.planes[channel * self.samples + sample]
    }

    /// Returns the plane of one channel and sample.
    pub(crate) fn plane_mut(&mut self, channel: usize, sample: usize) -> &mut [u32] {
        &mut self.planes[channel * self.samples + sample]
    }

    /// Sets one colour channel, or depth, in a rectangle of all samples.
    pub(crate) fn fill(&mut self, channel: usize, code: u32, rect: Option<[u32; 4]>) {
        let (rows, columns) = self.area(rect);
        for sample in 0..self.samples {
            let stride = self.stride;
            let plane = self.plane_mut(channel, sample);
            for y in rows.clone() {
                plane[y * stride..][columns.clone()].fill(code);
            }
        }
    }

    /// Sets the stencil bits of a mask in a rectangle of all samples.
    pub(crate) fn fill_stencil(&mut self, value: u8, mask: u8, rect: Option<[u32; 4]>) {
        let (rows, columns) = self.area(rect);
        for plane in &mut self.stencil {
            for y in rows.clone() {
                for stored in &mut plane[y * self.stride..][columns.clone()] {
                    *stored = *stored & !mask | value & mask;
                }
            }
        }
    }

    /// Returns the rows and columns of a rectangle; without a rectangle, all rows and columns.
    fn area(&self, rect: Option<[u32; 4]>) -> (Range<usize>, Range<usize>) {
        match rect.map(|r| r.map(|v| v as usize)) {
            Some([x, y, w, h]) => (y..y + h, x..x + w),
            None => (0..self.height, 0..self.width),
        }
    }

    /// Resolves another surface into this one. `resolve` combines the codes of all samples into one.
    pub(crate) fn resolve_from(
        &mut self,
        source: &Self,
        resolve: impl Fn(ChannelEncoding, &[u32]) -> u32,
    ) {
        let mut codes = vec![0; source.samples];
        for (c, encoding) in source.encodings.iter().enumerate() {
            if let ChannelEncoding::Uint(_) = encoding {
                // Integers resolve to one sample.
                self.planes[c].clone_from_slice(source.plane(c, 0));
                continue;
            }
            for offset in 0..self.stride * self.height {
                for (s, code) in codes.iter_mut().enumerate() {
                    *code = source.plane(c, s)[offset];
                }
                self.planes[c][offset] = resolve(*encoding, &codes);
            }
        }
    }

    /// Resolves the depths of another surface into this one. `resolve` combines the codes of all samples into
    /// one.
    pub(crate) fn resolve_depth_from(
        &mut self,
        source: &Self,
        mode: ResolveMode,
        resolve: impl Fn(&[u32]) -> u32,
    ) {
        if mode != ResolveMode::None {
            fold(&source.planes, &mut self.planes[0], resolve);
        }
    }

    /// Resolves the stencil values of another surface into this one.
    pub(crate) fn resolve_stencil_from(
        &mut self,
        source: &Self,
        mode: ResolveMode,
        resolve: impl Fn(&[u8]) -> u8,
    ) {
        if let Some(target) = self.stencil.first_mut()
            && mode != ResolveMode::None
        {
            fold(&source.stencil, target, resolve);
        }
    }

    /// Returns the codes of one aspect in the order of [`etalon_frame::Image`].
    pub(crate) fn codes(&self, aspect: Aspect) -> Vec<u32> {
        let channels = match aspect {
            Aspect::Stencil => 1,
            Aspect::Depth => 1,
            Aspect::Color => self.encodings.len(),
        };
        let count = self.width * self.height * self.samples * channels;
        let mut codes = Vec::with_capacity(count);
        for y in 0..self.height {
            for x in 0..self.width {
                let offset = y * self.stride + x;
                for s in 0..self.samples {
                    match aspect {
                        Aspect::Stencil => codes.push(u32::from(self.stencil[s][offset])),
                        _ => codes.extend((0..channels).map(|c| self.plane(c, s)[offset])),
                    }
                }
            }
        }
        codes
    }
}

/// Sets each value of a plane to a function of the values of all samples.
fn fold<T: Copy>(samples: &[Vec<T>], target: &mut [T], resolve: impl Fn(&[T]) -> T) {
    let mut values = Vec::with_capacity(samples.len());
    for (offset, value) in target.iter_mut().enumerate() {
        values.clear();
        values.extend(samples.iter().map(|plane| plane[offset]));
        *value = resolve(&values);
    }
}

/// Returns the encoding in which the rasterizer stores a format's depth, if the format has depth.
pub(crate) fn depth_encoding(format: TextureFormat) -> Option<ChannelEncoding> {
    format.depth_encodings().first().copied()
}
