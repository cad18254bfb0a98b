//! Samples, and the shapes of their attachments.

/// The size and the sample count of attachments.
pub(crate) type Shape = ([u32; 2], u32);

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
}
