//! The judging number system: intervals that hold every value the rules allow.

use crate::interval::Interval;
use crate::rules::{BlendPrecision, Rounding, Rules};
use etalon_frame::{ChannelEncoding, CodeInterval};
use etalon_pipeline::Arithmetic;

/// Every value that some permitted way of computing arrives at.
///
/// A blend may be computed in floating-point throughout, or with every result rounded to a
/// neighbouring code of the destination. The two are carried side by side: joined early, the error
/// of the one would be added to the rounding of the other, and the set would be wider than either
/// reading of the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// In floating-point.
    pub float: Interval,
    /// Rounded to destination codes at every step.
    pub coarse: Interval,
}

impl Range {
    /// Exactly one value.
    pub fn exact(value: f64) -> Self {
        Self::same(Interval::exact(value))
    }

    /// One interval for both ways of computing.
    pub fn same(interval: Interval) -> Self {
        Self {
            float: interval,
            coarse: interval,
        }
    }

    /// The values of both ways.
    pub fn hull(self) -> Interval {
        self.float.hull(self.coarse)
    }

    fn zip(self, other: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        Self {
            float: f(self.float, other.float),
            coarse: f(self.coarse, other.coarse),
        }
    }
}

/// Arithmetic under a set of rules.
#[derive(Clone, Copy, Debug)]
pub struct Judging<'r> {
    /// The rules.
    pub rules: &'r Rules,
}

/// A code position that is an integer but for the rounding of 64-bit floats counts as one. No 32-bit
/// float times 255 comes this near to an integer without being it (the least distance is 2^-31).
const INTEGER_SLACK: f64 = 1e-10;

impl<'r> Judging<'r> {
    /// Arithmetic under these rules.
    pub fn new(rules: &'r Rules) -> Self {
        Self { rules }
    }

    fn error(&self) -> f64 {
        self.rules.float_error.value
    }

    /// Widens to the destination's codes on either side, where blending may round to them.
    fn round_outward(&self, encoding: ChannelEncoding, value: Interval) -> Interval {
        match (self.rules.blend.value, encoding) {
            (BlendPrecision::DestinationCodes, ChannelEncoding::Unorm(_)) => {
                let scale = encoding.max_order() as f64;
                Interval {
                    low: (value.low * scale + INTEGER_SLACK).floor() / scale,
                    high: (value.high * scale - INTEGER_SLACK).ceil() / scale,
                }
            }
            _ => value,
        }
    }

    fn store(&self, encoding: ChannelEncoding, value: Interval, slack: f64) -> CodeInterval {
        match encoding {
            ChannelEncoding::Unorm(_) => {
                let scale = encoding.max_order() as f64;
                let (low, high) = match self.rules.store.value {
                    Rounding::EitherNeighbour => (
                        (value.low * scale + slack).floor(),
                        (value.high * scale - slack).ceil(),
                    ),
                    Rounding::Within(codes) => (
                        (value.low * scale - codes).ceil(),
                        (value.high * scale + codes).floor(),
                    ),
                };
                let inside = |v: f64| v.clamp(0.0, scale) as i64;
                CodeInterval::new(inside(low), inside(high))
            }
            ChannelEncoding::Uint(_) => {
                CodeInterval::new(value.low.floor() as i64, value.high.ceil() as i64)
            }
            ChannelEncoding::Float32 => {
                CodeInterval::new(order_below(value.low), order_above(value.high))
            }
        }
    }
}

/// The order of the largest 32-bit float not above a value.
fn order_below(value: f64) -> i64 {
    let encoding = ChannelEncoding::Float32;
    let order = encoding.order_of_code((value as f32).to_bits());
    if encoding.value_of_order(order) > value {
        order - 1
    } else {
        order
    }
}

/// The order of the smallest 32-bit float not below a value.
fn order_above(value: f64) -> i64 {
    let encoding = ChannelEncoding::Float32;
    let order = encoding.order_of_code((value as f32).to_bits());
    if encoding.value_of_order(order) < value {
        order + 1
    } else {
        order
    }
}

impl Arithmetic for Judging<'_> {
    type Real = Range;
    type Code = CodeInterval;

    fn constant(&mut self, value: f32) -> Range {
        Range::exact(f64::from(value))
    }

    fn add(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, |a, b| a + b))
    }

    fn sub(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, |a, b| a - b))
    }

    fn mul(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, |a, b| a * b))
    }

    fn div(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, |a, b| a / b))
    }

    fn min(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, f64::min))
    }

    fn max(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.corners(b, f64::max))
    }

    /// The terms of the transform are as large as the axis, and so is what their error is relative
    /// to.
    fn window_coordinate(&mut self, value: Range, length: f32) -> Range {
        let largest = value.float.low.abs().max(value.float.high.abs());
        let scale = largest.max(f64::from(length));
        Range::same(value.float.widen(scale * self.error()))
    }

    fn window_depth(&mut self, value: Range) -> Range {
        Range::same(value.float.widen_relative(self.error()).clamp(0.0, 1.0))
    }

    fn decode(&mut self, encoding: ChannelEncoding, code: CodeInterval) -> Range {
        let value = Interval {
            low: encoding.value_of_order(code.low),
            high: encoding.value_of_order(code.high),
        };
        match encoding {
            ChannelEncoding::Unorm(_) => {
                let error = self.rules.decode_error.value;
                let down = |v: f64| if v == 1.0 { v } else { v - v * error };
                let up = |v: f64| if v == 1.0 { v } else { v + v * error };
                Range {
                    float: Interval {
                        low: down(value.low),
                        high: up(value.high),
                    },
                    coarse: value,
                }
            }
            ChannelEncoding::Uint(_) | ChannelEncoding::Float32 => Range::same(value),
        }
    }

    fn encode(&mut self, encoding: ChannelEncoding, value: Range) -> CodeInterval {
        let float = self.store(encoding, value.float, 0.0);
        if value.coarse == value.float {
            return float;
        }
        // Codes divided and multiplied again are integers but for this machine's own rounding.
        float.hull(self.store(encoding, value.coarse, INTEGER_SLACK))
    }

    fn blend_operand(&mut self, encoding: ChannelEncoding, value: Range) -> Range {
        let clamped = match encoding {
            ChannelEncoding::Unorm(_) => Range {
                float: value.float.clamp(0.0, 1.0),
                coarse: value.coarse.clamp(0.0, 1.0),
            },
            _ => value,
        };
        Range {
            float: clamped.float,
            coarse: self.round_outward(encoding, clamped.coarse),
        }
    }

    fn blend_complement(&mut self, _encoding: ChannelEncoding, value: Range) -> Range {
        let one = Range::exact(1.0);
        let exact = one.zip(value, |a, b| a.corners(b, |a, b| a - b));
        let float = if value.float.is(0.0) || value.float.is(1.0) {
            exact.float
        } else {
            exact.float.widen_relative(self.error())
        };
        Range {
            float,
            coarse: exact.coarse,
        }
    }

    fn blend_product(&mut self, encoding: ChannelEncoding, operand: Range, factor: Range) -> Range {
        let product = operand.zip(factor, |a, b| a.corners(b, |a, b| a * b));
        let plain = |v: Interval| v.is(0.0) || v.is(1.0);
        let float = if plain(operand.float) || plain(factor.float) {
            product.float
        } else {
            product.float.widen_relative(self.error())
        };
        Range {
            float,
            coarse: self.round_outward(encoding, product.coarse),
        }
    }

    fn blend_sum(
        &mut self,
        _encoding: ChannelEncoding,
        a: Range,
        b: Range,
        subtract: bool,
    ) -> Range {
        let sum = a.zip(b, |a, b| {
            a.corners(b, |a, b| if subtract { a - b } else { a + b })
        });
        let float = if a.float.is(0.0) || b.float.is(0.0) {
            sum.float
        } else {
            // The error is relative to the sides, of which the sum may be a small difference.
            let largest = [a.float.low, a.float.high, b.float.low, b.float.high]
                .into_iter()
                .fold(0.0, |m: f64, v| m.max(v.abs()));
            sum.float.widen(largest * self.error())
        };
        Range {
            float,
            coarse: sum.coarse,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::Api;

    #[test]
    fn zero_and_one_are_exact_and_other_codes_have_neighbours() {
        let rules = Rules::of(Api::Vulkan);
        let mut a = Judging::new(&rules);
        let e = ChannelEncoding::Unorm(8);
        for (value, low, high) in [(0.0, 0, 0), (1.0, 255, 255), (0.5, 127, 128)] {
            let v = a.constant(value);
            assert_eq!(a.encode(e, v), CodeInterval::new(low, high));
        }
        let back = a.decode(e, CodeInterval::exact(100));
        assert_eq!(a.encode(e, back), CodeInterval::new(99, 101));
    }

    #[test]
    fn the_yardstick_wants_the_nearest_code_and_exact_round_trips() {
        let rules = Rules::yardstick(&crate::judge::tests::limits(Api::Vulkan));
        let mut a = Judging::new(&rules);
        let e = ChannelEncoding::Unorm(8);
        for code in 0..=255 {
            let back = a.decode(e, CodeInterval::exact(code));
            assert_eq!(a.encode(e, back), CodeInterval::exact(code));
        }
        let third = a.constant(1.0 / 3.0);
        assert_eq!(a.encode(e, third), CodeInterval::exact(85));
    }

    #[test]
    fn any_float_is_exact_as_a_float() {
        let rules = Rules::of(Api::OpenGl);
        let mut a = Judging::new(&rules);
        for value in [0.0, 1e-30, 0.3, 0.99999994, 1.0_f32] {
            let v = a.constant(value);
            let due = CodeInterval::exact(i64::from(value.to_bits()));
            assert_eq!(a.encode(ChannelEncoding::Float32, v), due);
        }
    }
}
