//! True pictures.

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
