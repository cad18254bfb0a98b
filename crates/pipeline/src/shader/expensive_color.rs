//! Twin of `shaders/expensive_color.wgsl`. The expensive value is 0 after any number of steps, so the output
//! is that of `flat_color`.
//!
//! [`cost`] does the same work, for a rasterizer whose frame times are measured.

pub(super) use super::flat_color::fragment;

/// Returns the value that the shader adds to its colour, for texels of a row by their columns: 0, after
/// `steps` steps for each. The compiler cannot remove the steps as long as the result is used.
#[inline(always)]
pub fn cost<const N: usize>(columns: [u32; N], row: u32, steps: f32) -> [f32; N] {
    let mut hashes = columns.map(|x| x.wrapping_mul(747_796_405).wrapping_add(row));
    // `as` saturates, and maps NaN to 0.
    for _ in 0..steps as u32 {
        for hash in &mut hashes {
            *hash = hash.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *hash ^= *hash >> 15;
        }
    }
    // One of two consecutive integers is even.
    hashes.map(|hash| (hash.wrapping_mul(hash.wrapping_add(1)) & 1) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expensive_colour_is_always_zero() {
        for steps in [0.0, 1.0, 7.0, 1000.0, -3.0, f32::NAN] {
            assert_eq!(cost([0, 1, 17, u32::MAX], 5, steps), [0.0; 4], "{steps}");
        }
    }
}
