//! The plain number system: 32-bit floats in lanes.

use crate::arithmetic::Arithmetic;
use crate::cell_hash::cell_hash;
use crate::half_float::{lengthened, narrowed, shortened, widened};
use crate::logic::logic_operation;
use crate::rounding::{integer_part, unit};
use crate::srgb;
use etalon_frame::ChannelEncoding;
use etalon_scene::LogicOperation;

/// `N` floats, one per lane. Loops run over all lanes without branching on values, so that the
/// compiler turns them into vector instructions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plain<const N: usize>;

/// Maps lane by lane in a loop, because `std::array::from_fn` is not always inlined here.
#[inline(always)]
fn each<const N: usize, T: Copy, U: Copy + Default>(values: [T; N], f: impl Fn(T) -> U) -> [U; N] {
    let mut result = [U::default(); N];
    for (result, value) in result.iter_mut().zip(values) {
        *result = f(value);
    }
    result
}

#[inline(always)]
fn zip<const N: usize>(a: [f32; N], b: [f32; N], f: impl Fn(f32, f32) -> f32) -> [f32; N] {
    let mut result = a;
    for (result, b) in result.iter_mut().zip(b) {
        *result = f(*result, b);
    }
    result
}

impl<const N: usize> Arithmetic for Plain<N> {
    type Real = [f32; N];
    type Code = [u32; N];

    #[inline(always)]
    fn constant(&mut self, value: f32) -> [f32; N] {
        [value; N]
    }

    #[inline(always)]
    fn add(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn div(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn min(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(&mut self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn rounded(&mut self, value: [f32; N]) -> [f32; N] {
        value
    }

    #[inline(always)]
    fn log2(&mut self, value: [f32; N]) -> [f32; N] {
        each(value, f32::log2)
    }

    #[inline(always)]
    fn exp2(&mut self, value: [f32; N]) -> [f32; N] {
        each(value, f32::exp2)
    }

    #[inline(always)]
    fn sqrt(&mut self, value: [f32; N]) -> [f32; N] {
        each(value, f32::sqrt)
    }

    #[inline(always)]
    fn cell_hash(&mut self, [x, y]: [[f32; N]; 2]) -> [f32; N] {
        zip(x, y, |x, y| cell_hash([x as u32, y as u32]))
    }

    #[inline(always)]
    fn select_less(
        &mut self,
        a: [f32; N],
        b: [f32; N],
        less: [f32; N],
        otherwise: [f32; N],
    ) -> [f32; N] {
        let mut result = otherwise;
        for i in 0..N {
            result[i] = if a[i] < b[i] { less[i] } else { otherwise[i] };
        }
        result
    }

    #[inline(always)]
    fn always_less(&mut self, a: [f32; N], b: [f32; N]) -> bool {
        a.iter().zip(b).all(|(a, b)| *a < b)
    }

    #[inline(always)]
    fn window_coordinate(&mut self, value: [f32; N], _length: f32) -> [f32; N] {
        value
    }

    #[inline(always)]
    fn window_depth(&mut self, value: [f32; N], _range: [f32; 2]) -> [f32; N] {
        value
    }

    #[inline(always)]
    fn decode(&mut self, encoding: ChannelEncoding, code: [u32; N]) -> [f32; N] {
        match encoding {
            ChannelEncoding::Unorm(8) => each(code, of_byte),
            ChannelEncoding::Unorm(bits) if bits <= 16 => {
                let scale = encoding.max_order() as f32;
                each(code, |c| c as f32 / scale)
            }
            ChannelEncoding::Unorm(_) => {
                let scale = encoding.max_order() as f64;
                each(code, |c| (f64::from(c) / scale) as f32)
            }
            ChannelEncoding::Snorm(_) => {
                let scale = encoding.max_order() as f32;
                each(code, |c| {
                    (encoding.order_of_code(c) as f32 / scale).max(-1.0)
                })
            }
            ChannelEncoding::Srgb8 => {
                let values = &*srgb::VALUES;
                each(code, |c| values[(c & 0xff) as usize])
            }
            ChannelEncoding::Uint(_) => each(code, |c| c as f32),
            ChannelEncoding::Float16 => each(code, widened),
            ChannelEncoding::Float32 => each(code, f32::from_bits),
            ChannelEncoding::Ufloat(mantissa) => each(code, |c| lengthened(c, mantissa)),
        }
    }

    #[inline(always)]
    fn encode(&mut self, encoding: ChannelEncoding, value: [f32; N]) -> [u32; N] {
        match encoding {
            // For up to 16 bits, the product and the sum are nearly enough exact in 32-bit floats to find the
            // nearest code to within 0.51 codes; a test compares with `nearest_order`.
            ChannelEncoding::Unorm(bits) if bits <= 16 => {
                let scale = encoding.max_order() as f32;
                each(value, |v| integer_part(unit(v) * scale + 0.5))
            }
            ChannelEncoding::Unorm(_) => {
                let scale = encoding.max_order() as f64;
                each(value, |v| {
                    (f64::from(v.clamp(0.0, 1.0)) * scale + 0.5) as u32
                })
            }
            ChannelEncoding::Snorm(_) => {
                let scale = encoding.max_order() as f32;
                each(value, |v| {
                    let order = (v.clamp(-1.0, 1.0) * scale).round() as i64;
                    encoding.code_of_order(order)
                })
            }
            ChannelEncoding::Srgb8 => {
                let codes = &*srgb::CODES;
                each(value, |v| codes.of(v))
            }
            ChannelEncoding::Uint(_) => {
                let most = encoding.max_order() as f32;
                each(value, |v| v.clamp(0.0, most) as u32)
            }
            ChannelEncoding::Float16 => each(value, narrowed),
            ChannelEncoding::Float32 => each(value, f32::to_bits),
            ChannelEncoding::Ufloat(mantissa) => each(value, |v| shortened(v, mantissa)),
        }
    }

    #[inline(always)]
    fn blend_operand(&mut self, encoding: ChannelEncoding, value: [f32; N]) -> [f32; N] {
        match encoding.normalized_range() {
            Some((low, high)) => each(value, |v| v.clamp(low, high)),
            None => value,
        }
    }

    #[inline(always)]
    fn blend_factor(&mut self, encoding: ChannelEncoding, value: [f32; N]) -> [f32; N] {
        self.blend_operand(encoding, value)
    }

    #[inline(always)]
    fn blend_complement(&mut self, _encoding: ChannelEncoding, value: [f32; N]) -> [f32; N] {
        each(value, |v| 1.0 - v)
    }

    #[inline(always)]
    fn blend_product(
        &mut self,
        _encoding: ChannelEncoding,
        operand: [f32; N],
        factor: [f32; N],
    ) -> [f32; N] {
        zip(operand, factor, |a, b| a * b)
    }

    #[inline(always)]
    fn blend_sum(
        &mut self,
        _encoding: ChannelEncoding,
        a: [f32; N],
        b: [f32; N],
        subtract: bool,
    ) -> [f32; N] {
        if subtract {
            zip(a, b, |a, b| a - b)
        } else {
            zip(a, b, |a, b| a + b)
        }
    }

    #[inline(always)]
    fn blend_quotient(
        &mut self,
        _encoding: ChannelEncoding,
        color: [f32; N],
        alpha: [f32; N],
    ) -> [f32; N] {
        zip(color, alpha, |c, a| if a == 0.0 { 0.0 } else { c / a })
    }

    #[inline(always)]
    fn blend_ratio(&mut self, _encoding: ChannelEncoding, a: [f32; N], b: [f32; N]) -> [f32; N] {
        zip(a, b, |a, b| (a / b).min(1.0))
    }

    #[inline(always)]
    fn blend_root(&mut self, _encoding: ChannelEncoding, value: [f32; N]) -> [f32; N] {
        each(value, f32::sqrt)
    }

    #[inline(always)]
    fn blend_select(
        &mut self,
        a: [f32; N],
        b: [f32; N],
        at_most: [f32; N],
        otherwise: [f32; N],
    ) -> [f32; N] {
        let mut result = otherwise;
        for i in 0..N {
            result[i] = if a[i] <= b[i] {
                at_most[i]
            } else {
                otherwise[i]
            };
        }
        result
    }

    #[inline(always)]
    fn logic(
        &mut self,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: [u32; N],
        dst: [u32; N],
    ) -> [u32; N] {
        let mut result = src;
        for (result, dst) in result.iter_mut().zip(dst) {
            *result = logic_operation(encoding, operation, *result, dst);
        }
        result
    }
}

/// Returns the nearest float to a byte divided by 255: the sum of two products, which is faster than a
/// quotient.
#[inline(always)]
fn of_byte(code: u32) -> f32 {
    // The first product is exact; a test compares all sums.
    const REST: f32 = (1.0_f64 / 255.0 - 1.0 / 256.0) as f32;
    let code = code as f32;
    code * (1.0 / 256.0) + code * REST
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_store_the_nearest_code() {
        for bits in [8, 16, 24] {
            let encoding = ChannelEncoding::Unorm(bits);
            for i in 0..=10_000_u32 {
                let value = i as f32 / 10_000.0;
                let lanes = Plain::<1>.encode(encoding, [value])[0];
                let exact = f64::from(value) * encoding.max_order() as f64;
                let off = (f64::from(lanes) - exact).abs();
                assert!(off <= 0.51, "{bits} bits, {value}: {off}");
            }
        }
    }

    #[test]
    fn a_byte_decodes_to_its_quotient_by_255() {
        for code in 0..=255_u32 {
            assert_eq!(of_byte(code), code as f32 / 255.0, "{code}");
        }
    }

    #[test]
    fn every_code_of_8_and_16_bits_survives_a_round_trip() {
        for bits in [8, 16] {
            let encoding = ChannelEncoding::Unorm(bits);
            for code in 0..=encoding.max_order() as u32 {
                let value = Plain::<1>.decode(encoding, [code]);
                assert_eq!(Plain::<1>.encode(encoding, value), [code]);
            }
        }
    }

    #[test]
    fn values_out_of_range_and_nan_are_stored_as_codes_in_range() {
        let encoding = ChannelEncoding::Unorm(8);
        let codes = Plain::<4>.encode(encoding, [-1.0, 2.0, f32::NAN, f32::INFINITY]);
        assert_eq!(codes, [0, 255, 0, 255]);
    }
}
