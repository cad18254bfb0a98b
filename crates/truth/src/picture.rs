//! True pictures, whole or on a lattice.

/// The true picture of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthPicture {
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Red, green and blue of every texel in the attachment's linear values, row by row from the top.
    pub rgb: Vec<[f64; 3]>,
    /// The largest possible error of any channel of any texel, ignoring rounding below 1e-8: 0 if every texel
    /// has a closed form.
    pub error: f64,
}

/// The texels of a frame that are compared with the truth: every `step`-th across and down, from the middle of the
/// first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Width and height of the frame in texels.
    pub size: [u32; 2],
    /// The distance of neighbours in texels: odd, so that the lattice falls into no rhythm with powers of two.
    pub step: u32,
}

impl Lattice {
    /// Returns a lattice of about 8,192 texels, and of all texels of small frames.
    pub fn over(size: [u32; 2]) -> Self {
        const TEXELS: f64 = 8192.0;
        let texels = f64::from(size[0]) * f64::from(size[1]);
        let step = (texels / TEXELS).sqrt() as u32 | 1;
        Self { size, step }
    }

    /// Returns the number of its texels across and down.
    pub fn count(self) -> [u32; 2] {
        self.size.map(|side| (side + self.step / 2) / self.step)
    }

    /// Returns the place in the frame of a column or a row of the lattice.
    pub fn place(self, index: u32) -> u32 {
        index * self.step + self.step / 2
    }
}

/// The true colours of a frame on a lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeTruth {
    /// The lattice.
    pub lattice: Lattice,
    /// Its colours, in a picture of [`Lattice::count`] texels.
    pub picture: TruthPicture,
    /// For each texel, true if it is compared: if no edge crosses it, or if its area counts.
    pub compared: Vec<bool>,
}
