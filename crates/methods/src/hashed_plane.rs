//! The plane whose cells are hashed for alpha tests (Wyman and McGuire 2017).

use etalon_scene::Params;

/// The number of surfaces in a row of the plane, and of rows.
const ROW: usize = 16;

/// Returns the place of a surface in the plane, in widths of the picture; surfaces of up to two widths do not meet, until
/// all places are taken: places far from the origin are too coarse in 32-bit floats.
pub(crate) fn place(number: usize) -> [f64; 2] {
    [number % ROW, number / ROW % ROW].map(|place| 2.0 * place as f64)
}

/// Returns parameters with a hashed cell for each texel of a picture of this size.
pub(crate) fn cells_per_texel(size: [u32; 2]) -> Params {
    let [width, height] = size.map(|side| side as f32);
    Params {
        color: [width, height, 0.0, 0.0],
        back_color: [0.0; 4],
    }
}
