//! The plane whose cells are hashed for alpha tests (Wyman and McGuire 2017).

use crate::stage::SIZE;
use etalon_scene::Params;

/// The number of surfaces in a row of the plane.
const ROW: usize = 16;

/// Returns the place of a surface in the plane, in widths of the picture; surfaces of up to two widths do not meet.
pub(crate) fn place(number: usize) -> [f64; 2] {
    [number % ROW, number / ROW].map(|place| 2.0 * place as f64)
}

/// Returns parameters with a hashed cell for each texel of the picture.
pub(crate) fn cells_per_texel() -> Params {
    let [width, height] = SIZE.map(|side| side as f32);
    Params {
        color: [width, height, 0.0, 0.0],
        back_color: [0.0; 4],
    }
}
