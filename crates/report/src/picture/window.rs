//! The part of an image that its pictures show.

use etalon_record::FrameImage;

/// The part of an image that is shown.
#[derive(Clone, Copy)]
pub(super) struct TexelWindow {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl TexelWindow {
    /// Returns the indices of the samples in the window, row by row.
    pub(super) fn samples(self, image: &FrameImage) -> impl Iterator<Item = usize> {
        let (samples, wide) = (image.samples as usize, image.size[0] as usize);
        let rows = self.y as usize..(self.y + self.height) as usize;
        let columns = self.x as usize..(self.x + self.width) as usize;
        let texels = rows.flat_map(move |y| columns.clone().map(move |x| y * wide + x));
        texels.flat_map(move |texel| (0..samples).map(move |sample| texel * samples + sample))
    }

    /// Returns the column, row and sample of the first wrong sample within the window: one that fails, else any.
    pub(super) fn first_wrong(self, image: &FrameImage) -> Option<[u32; 3]> {
        let wrong = |index: &usize| image.wrong[*index] != FrameImage::FINE;
        let fails = |index: &usize| wrong(index) && image.wrong[*index] != FrameImage::IMPRECISE;
        let found = self.samples(image).find(fails);
        let index = found.or_else(|| self.samples(image).find(wrong))? as u32;
        let (texel, sample) = (index / image.samples, index % image.samples);
        let (x, y) = (texel % image.size[0], texel / image.size[0]);
        Some([x - self.x, y - self.y, sample])
    }
}
