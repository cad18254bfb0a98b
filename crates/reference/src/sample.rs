//! Samples, and the shapes of their attachments.

use crate::snap::units_per_texel;
use etalon_frame::Limits;
use etalon_pipeline::Point;

/// The size and the sample count of attachments.
pub(crate) type SampleShape = ([u32; 2], u32);

/// One sample of the attachments of one shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sample {
    /// The attachments' width and height.
    pub size: [u32; 2],
    /// The samples per texel.
    pub samples: u32,
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Sample within the texel.
    pub sample: u32,
}

impl Sample {
    /// Returns the sample's index among all samples of its shape, row by row.
    pub(crate) fn place(self) -> usize {
        let texel = self.y as usize * self.size[0] as usize + self.x as usize;
        texel * self.samples as usize + self.sample as usize
    }

    /// Returns the sample's position in sub-texel units.
    pub(crate) fn point(self, limits: &Limits) -> Point {
        let positions = limits.sample_positions.get(&self.samples);
        let position = positions.and_then(|positions| positions.get(self.sample as usize));
        let [x, y] = position.copied().unwrap_or([128, 128]);
        let units = units_per_texel(limits);
        let axis =
            |texel: u32, offset: u16| i64::from(texel) * units + i64::from(offset) * units / 256;
        Point {
            x: axis(self.x, x),
            y: axis(self.y, y),
        }
    }
}
