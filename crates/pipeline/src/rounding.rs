//! Clamping to a range, and truncation, using only operations that have vector instructions.

/// Returns a number clamped to 0 to 1; 0 for NaN.
#[inline(always)]
pub(crate) fn unit(v: f32) -> f32 {
    let v = if v > 0.0 { v } else { 0.0 };
    if v < 1.0 { v } else { 1.0 }
}

/// Returns the integer part of a number from 0 to below 2²². `as` is not vectorized, since it saturates.
#[inline(always)]
pub(crate) fn integer_part(v: f32) -> u32 {
    // From here on floats are integers, so the sum is rounded to one, and its low bits are that integer.
    const WHOLE: f32 = 8_388_608.0;
    let sum = v + WHOLE;
    let up = sum - WHOLE > v;
    (sum.to_bits() & 0x007f_ffff) - u32::from(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integer_part_is_that_of_a_conversion() {
        for i in 0..2_000_000_u32 {
            // Halves, their neighbours, and numbers in between.
            let v = i as f32 / 2.0;
            for v in [v, v.next_up(), v.next_down().max(0.0), v * 0.37] {
                assert_eq!(integer_part(v), v as u32, "{v}");
            }
        }
        let values = [-1.0, -0.0, 0.25, 1.0, 2.0, f32::INFINITY, f32::NEG_INFINITY];
        assert_eq!(values.map(unit), values.map(|v| v.clamp(0.0, 1.0) + 0.0));
        assert_eq!(unit(f32::NAN), 0.0);
    }
}
