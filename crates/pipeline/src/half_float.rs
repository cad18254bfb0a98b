//! Conversions of 16-bit floats, and of floats without a sign or their lowest bits. They have no branches, so
//! that the compiler turns them into vector instructions.

/// Returns the value of a 16-bit float (IEEE 754 binary16). NaN is quiet.
#[inline(always)]
pub(crate) fn widened(code: u32) -> f32 {
    // The exponents' biases differ by 112. The product of a subnormal number is exact.
    const BIAS: f32 = f32::from_bits((112 + 127) << 23);
    let magnitude = code & 0x7fff;
    let mut bits = (f32::from_bits(magnitude << 13) * BIAS).to_bits();
    bits |= if magnitude >= 0x7c00 { 0x7f80_0000 } else { 0 };
    bits |= if magnitude > 0x7c00 { 0x0040_0000 } else { 0 };
    f32::from_bits(bits | (code & 0x8000) << 16)
}

/// Returns the 16-bit float nearest to a number, the even one of a tie. NaN is quiet and keeps the upper bits
/// of its payload.
#[inline(always)]
pub(crate) fn narrowed(value: f32) -> u32 {
    /// The bits of the least number whose exponent is beyond 16-bit floats.
    const OVER: u32 = (127 + 16) << 23;
    /// The bits of the least number that is normal in 16 bits.
    const NORMAL: u32 = (127 - 14) << 23;
    /// From here on, the step of 32-bit floats equals the least step of 16-bit floats.
    const STEP: f32 = 0.5;
    const INFINITE: u32 = 0x7f80_0000;
    let bits = value.to_bits();
    let magnitude = bits & 0x7fff_ffff;
    let odd = magnitude >> 13 & 1;
    let normal = magnitude.wrapping_sub(112 << 23).wrapping_add(0xfff + odd) >> 13;
    let sum = f32::from_bits(if magnitude < NORMAL { magnitude } else { 0 }) + STEP;
    let small = sum.to_bits().wrapping_sub(STEP.to_bits());
    let nan = 0x7e00 | magnitude >> 13 & 0x3ff;
    let large = if magnitude > INFINITE { nan } else { 0x7c00 };
    let finite = if magnitude < NORMAL { small } else { normal };
    let result = if magnitude >= OVER { large } else { finite };
    result | bits >> 16 & 0x8000
}

/// Returns the value of an unsigned float with 5 exponent bits and `mantissa` mantissa bits. NaN is quiet.
#[inline(always)]
pub(crate) fn lengthened(code: u32, mantissa: u8) -> f32 {
    widened(code << (10 - u32::from(mantissa)))
}

/// Returns the nearest unsigned float with 5 exponent bits and `mantissa` mantissa bits, the even one of a
/// tie. Numbers below 0 give 0, and numbers above all finite ones give the largest (Vulkan: Unsigned 11-Bit
/// Floating-Point Numbers). NaN is quiet.
#[inline(always)]
pub(crate) fn shortened(value: f32, mantissa: u8) -> u32 {
    /// The bits of the least normal number.
    const NORMAL: u32 = (127 - 14) << 23;
    const INFINITE: u32 = 0x7f80_0000;
    let (bits, mantissa) = (value.to_bits(), u32::from(mantissa));
    let magnitude = bits & 0x7fff_ffff;
    // The number of lowest bits, which are lost.
    let shift = 23 - mantissa;
    let odd = magnitude >> shift & 1;
    let half = (1 << (shift - 1)) - 1;
    let normal = magnitude.wrapping_sub(112 << 23).wrapping_add(half + odd) >> shift;
    // From here on, the step of 32-bit floats equals the least step of the encoding.
    let step = f32::from_bits((127 + 9 - mantissa) << 23);
    let sum = f32::from_bits(if magnitude < NORMAL { magnitude } else { 0 }) + step;
    let small = sum.to_bits().wrapping_sub(step.to_bits());
    let infinite = 31 << mantissa;
    let nan = infinite | 1 << (mantissa - 1);
    let large = if magnitude > INFINITE { nan } else { infinite };
    // If the exponent is too large for the encoding, the number here is beyond the largest finite code.
    let normal = if normal < infinite {
        normal
    } else {
        infinite - 1
    };
    let finite = if magnitude < NORMAL { small } else { normal };
    let result = if magnitude >= INFINITE { large } else { finite };
    // Of negative numbers, only NaN is kept.
    let kept = bits >> 31 == 0 || magnitude > INFINITE;
    if kept { result } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::ChannelEncoding;
    use half::f16;

    #[test]
    fn all_short_floats_have_their_value() {
        for mantissa in [5, 6] {
            let encoding = ChannelEncoding::Ufloat(mantissa);
            for code in 0..32 << mantissa {
                let (value, expected) = (
                    f64::from(lengthened(code, mantissa)),
                    encoding.value_of_order(code.into()),
                );
                assert!(
                    value == expected || value.is_nan() && expected.is_nan(),
                    "{code:#x}: {value} {expected}"
                );
                let again = shortened(value as f32, mantissa);
                assert!(again == code || value.is_nan() && encoding.is_nan(again));
            }
        }
    }

    #[test]
    fn numbers_become_the_nearest_short_float() {
        for mantissa in [5, 6] {
            let encoding = ChannelEncoding::Ufloat(mantissa);
            // Halves of steps, their neighbours and some numbers in between, for each exponent of 16-bit
            // floats and some others.
            let step = 1 << (22 - mantissa);
            for exponent in (90..150).chain([0, 1, 50, 200, 254]) {
                for bits in (0..1_u32 << 23).step_by(step) {
                    for near in [0, 1, 2, 1000, step as u32 - 1] {
                        let value = f32::from_bits(exponent << 23 | bits | near);
                        let code = shortened(value, mantissa);
                        let expected = encoding.nearest_code(value.into());
                        let distance = |code: u32| {
                            let nearest = encoding.value_of_order(code.into());
                            (nearest - f64::from(value)).abs()
                        };
                        let equal = distance(code) == distance(expected);
                        assert!(
                            code == expected || equal && code.is_multiple_of(2),
                            "{value}: {code} {expected}"
                        );
                        assert_eq!(shortened(-value, mantissa), 0);
                    }
                }
            }
            let infinite = 31 << mantissa;
            assert_eq!(shortened(f32::MAX, mantissa), infinite - 1);
            assert_eq!(shortened(f32::INFINITY, mantissa), infinite);
            assert_eq!(shortened(f32::NEG_INFINITY, mantissa), 0);
            assert!(encoding.is_nan(shortened(f32::NAN, mantissa)));
            assert!(encoding.is_nan(shortened(-f32::NAN, mantissa)));
        }
    }

    #[test]
    fn all_16_bit_floats_have_their_value() {
        for code in 0..=u16::MAX {
            let expected = f16::from_bits(code).to_f32();
            assert_eq!(
                widened(code.into()).to_bits(),
                expected.to_bits(),
                "{code:#x}"
            );
        }
    }

    #[test]
    fn numbers_become_the_nearest_16_bit_float() {
        // Each exponent and sign, with the mantissas around every rounding, and some in between.
        let mantissas = (0..1 << 10).flat_map(|m| {
            let middle = m << 13;
            [0, 1, 2, 0xfff, 0x1000, 0x1001, 0x1fff].map(|low| middle | low)
        });
        for mantissa in mantissas.chain((0..1 << 23).step_by(977)) {
            for upper in 0..512_u32 {
                let value = f32::from_bits(upper << 23 | mantissa);
                let expected = u32::from(f16::from_f32(value).to_bits());
                assert_eq!(narrowed(value), expected, "{:#x}", value.to_bits());
            }
        }
    }
}
