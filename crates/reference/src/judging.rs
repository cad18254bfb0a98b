//! The number system of judging: intervals that contain every value the rules allow.

use crate::interval::Interval;
use crate::range::Range;
use crate::rounding::{
    INTEGER_SLACK, all_codes, ceil, floor, nearest, order_above, order_below, to_codes, to_half,
    to_significand, to_steps, towards_zero,
};
use crate::rules::{
    BlendPrecision, DepthTerms, FactorClamp, FlushedFloats, Rounding, Rules, SignedClamp,
    SmallFloats,
};
use etalon_frame::{ChannelEncoding, CodeInterval, linear_of_half_codes};
use etalon_pipeline::{Arithmetic, cell_hash, logic_operation};
use etalon_scene::LogicOperation;

/// The values to which a blend rounds its results if it does not compute in floating-point.
#[derive(Clone, Copy)]
enum JudgingGrid {
    /// The destination's codes.
    Codes,
    /// Binary fractions with as many bits as the destination's codes.
    Fixed,
}

/// Arithmetic under a set of rules.
#[derive(Clone, Copy, Debug)]
pub struct Judging<'r> {
    /// The rules.
    pub rules: &'r Rules,
    /// True if blends are advanced and may be computed with the precision of 16-bit floats.
    advanced: bool,
    /// True if operands of blends into signed formats are clamped to -1 to 1, false if they are clamped to 0
    /// to 1. If `None`, the rules decide, or both are possible.
    pub(crate) signed_operands: Option<bool>,
    /// The number of steps between 0 and 1 beyond those between codes, if blends are computed in such steps.
    pub(crate) further_steps: Option<u32>,
}

impl<'r> Judging<'r> {
    /// Returns arithmetic under these rules.
    pub fn new(rules: &'r Rules) -> Self {
        Self {
            rules,
            advanced: false,
            signed_operands: None,
            further_steps: None,
        }
    }

    /// Returns arithmetic under these rules for advanced blends.
    pub fn of_advanced_blends(rules: &'r Rules) -> Self {
        Self {
            rules,
            advanced: true,
            signed_operands: None,
            further_steps: None,
        }
    }

    #[inline]
    fn error(&self) -> f64 {
        self.rules.float_error.value()
    }

    /// Returns the results that a shader may compute for an exact result. Values beyond 32-bit floats are
    /// infinite or NaN, and subnormal ones may be flushed to zero.
    fn computed(&self, value: Interval) -> Interval {
        let most = f64::from(f32::MAX);
        if value.low < -most || value.high > most {
            return Interval::EVERYTHING;
        }
        if value.is(0.0) {
            return value;
        }
        let wide = value.widen_relative(self.rules.shader_error.value());
        let tiny = f64::from(f32::MIN_POSITIVE);
        Interval {
            low: if (0.0..tiny).contains(&wide.low) {
                0.0
            } else {
                wide.low
            },
            high: if wide.high <= 0.0 && wide.high > -tiny {
                0.0
            } else {
                wide.high
            },
        }
    }

    /// Returns the results of a shader's binary logarithm: within 3 units in the last place, or within an
    /// absolute error of 2^-21 between a half and 2 (Vulkan, Precision of GLSL.std.450 Instructions; WGSL,
    /// 15.7.4), or within a shader's general precision if that is coarser.
    fn logarithm(&self, value: Interval) -> Interval {
        if value.low <= 0.0 || value.may_be_nan() {
            return Interval::EVERYTHING;
        }
        let exact = value.map_increasing(f64::log2);
        let units = 3.0 * f64::from(f32::EPSILON);
        self.computed(exact.widen(2_f64.powi(-21)).widen_relative(units))
    }

    /// Returns the results of a shader's power of two: within 3 + 2 |x| units in the last place (Vulkan,
    /// Precision of GLSL.std.450 Instructions; WGSL, 15.7.4), or within a shader's general precision if that
    /// is coarser.
    fn power_of_two(&self, value: Interval) -> Interval {
        if value.may_be_nan() {
            return value;
        }
        let largest = value.low.abs().max(value.high.abs());
        let units = 3.0 + 2.0 * largest;
        // Subnormal numbers have the same unit in the last place as the least normal one.
        let least = f64::from(f32::EPSILON) * f64::from(f32::MIN_POSITIVE);
        let wide = value
            .map_increasing(f64::exp2)
            .widen_relative(units * f64::from(f32::EPSILON))
            .widen(units * least);
        self.computed(Interval {
            low: wide.low.max(0.0),
            ..wide
        })
    }

    /// Returns the results of a shader's square root. It may be computed as one over the inverse square root,
    /// with errors of 2 and 2.5 units in the last place (Vulkan, Precision of GLSL.std.450 Instructions;
    /// WGSL, 15.7.4).
    fn root(&self, value: Interval) -> Interval {
        if value.low < 0.0 || value.may_be_nan() {
            return Interval::EVERYTHING;
        }
        // A subnormal number may be flushed to 0.
        let counted = |v: f64| {
            if v < f64::from(f32::MIN_POSITIVE) {
                0.0
            } else {
                v
            }
        };
        let exact = Interval {
            low: counted(value.low).sqrt(),
            high: value.high.sqrt(),
        };
        let units = ROOT_UNITS * f64::from(f32::EPSILON);
        self.computed(exact.widen_relative(units))
    }

    /// Returns true if blending may have only the destination's precision.
    #[inline]
    fn is_coarse(&self) -> bool {
        self.blend_precision() != BlendPrecision::Float32
    }

    #[inline]
    fn blend_precision(&self) -> BlendPrecision {
        if self.advanced {
            self.rules.advanced_blend.value()
        } else {
            self.rules.blend.value()
        }
    }

    /// Widens to the values that are less than one code away. Integers are exact, and no rounding passes one.
    fn within_a_code(&self, encoding: ChannelEncoding, value: Interval) -> Interval {
        if encoding == ChannelEncoding::Srgb8 {
            let position = |v: f64| encoding.position(v.max(0.0)).unwrap_or(0.0);
            let linear = |code: f64| linear_of_half_codes(2 * code.clamp(0.0, 255.0) as i64);
            let [low, high] = [value.low, value.high].map(position);
            let is_end = |position: f64| position == 0.0 || position == 255.0;
            let [below, above] = [linear(floor(low) - 1.0), linear(ceil(high) + 1.0)];
            return Interval {
                low: value.low.min(if is_end(low) { value.low } else { below }),
                high: value
                    .high
                    .max(if is_end(high) { value.high } else { above }),
            };
        }
        let step = 1.0 / (self.steps(encoding) - 1.0);
        Interval {
            low: (value.low - step).max(value.low.floor()),
            high: (value.high + step).min(value.high.ceil()),
        }
    }

    /// Widens an operand or an exact result by the rounding to the shortest significand with the
    /// destination's precision. `computed` contains its computed values.
    #[inline]
    fn float_outward(
        &self,
        encoding: ChannelEncoding,
        exact: Interval,
        computed: Interval,
    ) -> Interval {
        // Every step of a blend into floats is rounded to codes instead.
        let Some(bits) = self.bits(encoding) else {
            return computed;
        };
        if !self.is_coarse() || exact.may_be_nan() {
            return computed;
        }
        computed.hull(to_significand(bits, exact))
    }

    /// Returns the least number of bits, without a sign, with which blends into a normalized destination are
    /// computed.
    #[inline]
    fn bits(&self, encoding: ChannelEncoding) -> Option<u32> {
        let bits = match encoding {
            ChannelEncoding::Unorm(bits) => u32::from(bits),
            ChannelEncoding::Snorm(bits) => u32::from(bits) - 1,
            ChannelEncoding::Srgb8 => 8,
            _ => return None,
        };
        Some(if self.advanced {
            bits.min(HALF_SIGNIFICAND)
        } else {
            bits
        })
    }

    /// Returns the number of steps between 0 and 1 in fixed-point arithmetic: a power of two for the least
    /// precision.
    #[inline]
    fn steps(&self, encoding: ChannelEncoding) -> f64 {
        if let Some(further) = self.further_steps {
            let codes = encoding.max_order() as f64;
            return codes + f64::from(further).min(3.0 * codes);
        }
        self.bits(encoding)
            .map_or(1.0, |bits| (1_u64 << bits) as f64)
    }

    /// Returns the numbers of further steps between 0 and 1 with which a blend into these channels may be computed.
    pub(crate) fn uniform_steps(&self, encodings: &[ChannelEncoding]) -> std::ops::Range<u32> {
        if self.blend_precision() != BlendPrecision::UniformSteps {
            return 0..0;
        }
        let few = encodings.iter().filter(|e| has_few_codes(**e));
        let most = few.map(|encoding| encoding.max_order()).max();
        0..most.map_or(0, |codes| 3 * codes as u32 + 1)
    }

    /// Returns the relative error of one step of a blend in floats.
    #[inline]
    fn blend_error(&self, encoding: ChannelEncoding) -> f64 {
        if encoding == ChannelEncoding::Float32 && !self.advanced {
            self.rules.float32_blend_error.value()
        } else {
            self.error()
        }
    }

    /// Returns the floats that one step of a blend may compute for an exact result.
    #[inline]
    fn float_step(&self, encoding: ChannelEncoding, exact: Interval) -> Interval {
        let computed = exact
            .widen_relative(self.blend_error(encoding))
            .may_underflow();
        self.float_outward(encoding, exact, computed)
    }

    /// Returns the results that one step of a blend may compute for an exact result.
    fn rounded_once(&self, encoding: ChannelEncoding, exact: Range) -> Range {
        Range {
            float: self.float_step(encoding, exact.float),
            ..self.on_grids(encoding, exact)
        }
    }

    /// Rounds the results that are not computed in floating-point.
    #[inline]
    fn on_grids(&self, encoding: ChannelEncoding, value: Range) -> Range {
        let codes = self.round_outward(encoding, JudgingGrid::Codes, value.codes);
        let has_fractions = matches!(
            encoding,
            ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_)
        );
        let fixed = if has_fractions || value.fixed != value.codes {
            self.round_outward(encoding, JudgingGrid::Fixed, value.fixed)
        } else {
            codes
        };
        Range {
            float: value.float,
            codes,
            fixed,
        }
    }

    /// Rounds a product or a sum that is not computed in floating-point of 32 bits. The range of a blend may
    /// be the destination's, whose infinity stands for magnitudes beyond the greatest number, and that of
    /// 16-bit floats in advanced blends. "Dynamic range no lower than" (OpenGL 4.6, 17.3.6.1) overrides the
    /// 2^32 of 2.3.4.1, as the precision there overrides 1 part in 10^5.
    #[inline]
    fn result_on_grids(&self, encoding: ChannelEncoding, value: Range) -> Range {
        let rounded = self.on_grids(encoding, value);
        let greatest = match encoding {
            _ if !self.is_coarse() => return rounded,
            ChannelEncoding::Float16 | ChannelEncoding::Ufloat(_) => {
                encoding.value_of_order(encoding.max_order())
            }
            ChannelEncoding::Float32 if self.advanced => {
                let half = ChannelEncoding::Float16;
                half.value_of_order(half.max_order())
            }
            _ => return rounded,
        };
        Range {
            float: rounded.float,
            codes: rounded.codes.may_exceed(greatest),
            fixed: rounded.fixed.may_exceed(greatest),
        }
    }

    /// Returns one over a value; the result does not matter for values of 0 and below.
    fn inverse(&self, encoding: ChannelEncoding, value: Range) -> Range {
        let exact = value.map(|v| {
            let least = f64::from(f32::MIN_POSITIVE);
            if v.may_be_nan() {
                v
            } else {
                Interval::between(1.0 / v.high.max(least), 1.0 / v.low.max(least))
            }
        });
        self.rounded_once(encoding, exact)
    }

    /// Returns the results of a quotient, computed in one step or as a product with the inverse.
    fn divided(
        &self,
        encoding: ChannelEncoding,
        exact: Range,
        dividend: Range,
        divisor: Range,
    ) -> Range {
        if divisor.is_same() && divisor.float.is(1.0) {
            return self.on_grids(encoding, exact);
        }
        let inverse = self.inverse(encoding, divisor);
        let product = dividend.zip(inverse, Interval::times);
        self.rounded_once(encoding, exact)
            .zip(self.rounded_once(encoding, product), Interval::hull)
    }

    /// Widens to the grid's values on either side, if blending may round to them.
    #[inline]
    fn round_outward(
        &self,
        encoding: ChannelEncoding,
        grid: JudgingGrid,
        value: Interval,
    ) -> Interval {
        let is_normalized = encoding.normalized_range().is_some();
        match self.blend_precision() {
            BlendPrecision::Float32 => return value,
            BlendPrecision::AnySteps if is_normalized => {
                return self.within_a_code(encoding, value);
            }
            BlendPrecision::AnySteps
            | BlendPrecision::UniformSteps
            | BlendPrecision::DestinationCodes => {}
        }
        match encoding {
            ChannelEncoding::Float16 | ChannelEncoding::Float32 if self.advanced => to_half(value),
            ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_) => match grid {
                JudgingGrid::Codes => to_codes(encoding, value),
                JudgingGrid::Fixed => to_steps(self.steps(encoding), value),
            },
            // The codes of sRGB are evenly spaced in the encoded value.
            ChannelEncoding::Srgb8 => {
                let position = |v: f64| encoding.position(v).unwrap_or(0.0);
                let linear = |code: f64| linear_of_half_codes(2 * code.clamp(0.0, 255.0) as i64);
                let low = position(value.low.max(0.0));
                let high = if value.high == value.low {
                    low
                } else {
                    position(value.high.max(0.0))
                };
                Interval {
                    low: linear(floor(low + INTEGER_SLACK)).min(value.low),
                    high: linear(ceil(high - INTEGER_SLACK)).max(value.high),
                }
            }
            ChannelEncoding::Float16 | ChannelEncoding::Ufloat(_) => {
                // Blending into a format without a sign may be computed without one, or with one and the
                // format's magnitudes.
                let low = if value.low < encoding.value_of_order(encoding.min_order()) {
                    -encoding.value_of_order(encoding.order_above(-value.low))
                } else {
                    encoding.value_of_order(encoding.order_below(value.low))
                };
                let high = encoding.value_of_order(encoding.order_above(value.high));
                Interval {
                    low: low.min(value.low),
                    high: high.max(value.high),
                }
            }
            ChannelEncoding::Uint(_) | ChannelEncoding::Float32 => value,
        }
    }

    /// Clamps an operand of a blend into a normalized format.
    #[inline]
    fn blend_clamp(&self, encoding: ChannelEncoding, value: Interval) -> Interval {
        let Some((low, high)) = encoding.normalized_range() else {
            return value;
        };
        let clamped = value.clamp_number(f64::from(low), f64::from(high));
        if low >= 0.0 {
            return clamped;
        }
        let clamp = match self.signed_operands {
            Some(true) => SignedClamp::Signed,
            Some(false) => SignedClamp::Unit,
            None => self.rules.signed_clamp.value(),
        };
        match clamp {
            SignedClamp::Signed => clamped,
            SignedClamp::Unit => value.clamp_number(0.0, 1.0),
            SignedClamp::Either => clamped.hull(value.clamp_number(0.0, 1.0)),
        }
    }

    fn store(&self, encoding: ChannelEncoding, value: Interval, slack: f64) -> CodeInterval {
        if value.may_be_nan() && encoding.is_float() {
            return all_codes(encoding);
        }
        let ends = (encoding.min_order() as f64, encoding.max_order() as f64);
        let position = |v: f64| {
            let held = match encoding.normalized_range() {
                Some((low, high)) => v.clamp(f64::from(low), f64::from(high)),
                None => v,
            };
            encoding.position(held)
        };
        if let (Some(low), Some(high)) = (position(value.low), position(value.high)) {
            // The code before rounding, f * (2^b - 1), is itself computed. The specification makes the ends
            // of the range exact, and a value that was already rounded to codes is not a floating-point
            // result.
            let is_computed = slack == 0.0 && encoding.normalized_range().is_some();
            let error = if is_computed { self.error() } else { 0.0 };
            let off = |end: f64| {
                if end == ends.1 || end == -ends.1 {
                    0.0
                } else {
                    end.abs() * error
                }
            };
            let (low, high) = (low - off(low), high + off(high));
            let (low, high) = match self.rules.store.value() {
                Rounding::EitherNeighbour => (floor(low + slack), ceil(high - slack)),
                Rounding::Within(codes) => (ceil(low - codes), floor(high + codes)),
            };
            let least = match encoding {
                // -1 is stored as the code above the lowest.
                ChannelEncoding::Snorm(_) => ends.0 + 1.0,
                _ => ends.0,
            };
            let inside = |v: f64| v.clamp(least, ends.1) as i64;
            return CodeInterval::new(inside(low), inside(high));
        }
        if encoding == ChannelEncoding::Float32 {
            return CodeInterval::new(order_below(value.low), order_above(value.high));
        }
        if matches!(encoding, ChannelEncoding::Ufloat(_))
            && self.rules.small_floats.value() == SmallFloats::NearestOrTowardsZero
        {
            let low = towards_zero(encoding, value.low);
            return self.flushed(encoding, low, nearest(encoding, value.high));
        }
        let limit = encoding.value_of_order(encoding.max_order());
        let beyond = value.high > limit || value.low < -limit;
        if beyond && encoding == ChannelEncoding::Float16 && !self.rules.half_overflows.value() {
            return all_codes(encoding);
        }
        let low = match value.low {
            v if v > limit => encoding.max_order(),
            v => encoding.order_below(v),
        };
        // Above the largest value, either that value or infinity is stored.
        let high = match value.high {
            v if v > limit => encoding.max_order() + 1,
            v => encoding.order_above(v),
        };
        let low = if value.low < -limit && encoding == ChannelEncoding::Float16 {
            encoding.min_order() - 1
        } else {
            low
        };
        self.flushed(encoding, low.min(high), high.max(low))
    }

    /// Returns an interval of 16-bit or smaller floats together with zero, if the rules permit that its ends are
    /// flushed.
    fn flushed(&self, encoding: ChannelEncoding, low: i64, high: i64) -> CodeInterval {
        let rule = self.rules.flushes_small_floats.value();
        let (normal, flushes) = match encoding {
            ChannelEncoding::Ufloat(mantissa) => (1 << mantissa, rule == FlushedFloats::All),
            _ => (1 << 10, rule != FlushedFloats::None),
        };
        let flush = |order: i64, towards: i64| {
            if flushes && order.abs() < normal {
                towards
            } else {
                order
            }
        };
        CodeInterval::new(flush(low, low.min(0)), flush(high, high.max(0)))
    }
}

/// Returns true for the channels in which every number of even steps is tried.
fn has_few_codes(encoding: ChannelEncoding) -> bool {
    matches!(encoding, ChannelEncoding::Unorm(bits) | ChannelEncoding::Snorm(bits) if bits <= 8)
}

/// The maximum error of a square root in units in the last place: it may be one over an inverse root.
const ROOT_UNITS: f64 = 5.0;

/// The number of bits in a 16-bit float's significand, including the hidden one.
const HALF_SIGNIFICAND: u32 = 11;

impl Arithmetic for Judging<'_> {
    type Real = Range;
    type Code = CodeInterval;

    fn constant(&mut self, value: f32) -> Range {
        Range::exact(f64::from(value))
    }

    fn add(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, Interval::plus)
    }

    fn sub(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, Interval::minus)
    }

    fn mul(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, Interval::times)
    }

    fn div(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| {
            if b.contains(0.0) {
                return Interval::EVERYTHING;
            }
            a.corners(b, |a, b| a / b)
        })
    }

    fn min(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.selected(b, f64::min))
    }

    fn max(&mut self, a: Range, b: Range) -> Range {
        a.zip(b, |a, b| a.selected(b, f64::max))
    }

    fn rounded(&mut self, value: Range) -> Range {
        value.map(|v| self.computed(v))
    }

    fn log2(&mut self, value: Range) -> Range {
        value.map(|v| self.logarithm(v))
    }

    fn exp2(&mut self, value: Range) -> Range {
        value.map(|v| self.power_of_two(v))
    }

    fn sqrt(&mut self, value: Range) -> Range {
        value.map(|v| self.root(v))
    }

    fn cell_hash(&mut self, point: [Range; 2]) -> Range {
        let [x, y] = point.map(Range::hull);
        let cell = |end: fn(Interval) -> f64| [end(x) as u32, end(y) as u32];
        let cells = [cell(|v| v.low), cell(|v| v.high)];
        if cells[0] != cells[1] || x.may_be_nan() || y.may_be_nan() {
            return Range::same(Interval::between(0.0, 1.0));
        }
        Range::exact(f64::from(cell_hash(cells[0])))
    }

    fn select_less(&mut self, a: Range, b: Range, less: Range, otherwise: Range) -> Range {
        let (a, b) = (a.hull(), b.hull());
        let may = a.low < b.high || a.may_be_nan() || b.may_be_nan();
        let must = a.high < b.low && !a.may_be_nan() && !b.may_be_nan();
        match (may, must) {
            (_, true) => less,
            (false, _) => otherwise,
            _ => less.zip(otherwise, Interval::hull),
        }
    }

    fn always_less(&mut self, a: Range, b: Range) -> bool {
        let (a, b) = (a.hull(), b.hull());
        a.high < b.low && !a.may_be_nan() && !b.may_be_nan()
    }

    /// The terms of the transform are as large as the axis, and the error is relative to that.
    fn window_coordinate(&mut self, value: Range, length: f32) -> Range {
        let largest = value.float.low.abs().max(value.float.high.abs());
        let scale = largest.max(f64::from(length));
        Range::same(value.float.widen(scale * self.error() * 2.0))
    }

    /// The terms are as large as the viewport's depths. If the near depth is 0, the form with the near plane
    /// has only one term.
    fn window_depth(&mut self, value: Range, range: [f32; 2]) -> Range {
        let error = self.error();
        let largest = f64::from(range[0].max(range[1]));
        Range::same(match self.rules.depth_terms.value() {
            DepthTerms::NearPlane if range[0] == 0.0 => value.float.widen_relative(error),
            // The difference, the product and the sum are each rounded.
            DepthTerms::NearPlane => value.float.widen(largest * error * 2.0),
            // The depth from -1 to 1 is rounded too.
            DepthTerms::Middle => value.float.widen(largest * error * 3.0),
        })
    }

    fn decode(&mut self, encoding: ChannelEncoding, code: CodeInterval) -> Range {
        let value = Interval::of_codes(encoding, code);
        match encoding {
            ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_) => {
                let error = self.rules.decode_error.value();
                let exact = |v: f64| v.abs() == 1.0;
                let down = |v: f64| if exact(v) { v } else { v - v.abs() * error };
                let up = |v: f64| if exact(v) { v } else { v + v.abs() * error };
                Range {
                    float: Interval {
                        low: down(value.low),
                        high: up(value.high),
                    },
                    ..Range::same(value)
                }
            }
            // Within half a code of the encoded value (Direct3D 11.3, 3.2.3.7); no other specification is
            // tighter.
            ChannelEncoding::Srgb8 => {
                let ends = |order: i64, half: i64| match order {
                    0 | 255 => linear_of_half_codes(2 * order),
                    _ => linear_of_half_codes(2 * order + half),
                };
                Range::same(Interval {
                    low: ends(code.low, -1),
                    high: ends(code.high, 1),
                })
            }
            ChannelEncoding::Uint(_)
            | ChannelEncoding::Float16
            | ChannelEncoding::Float32
            | ChannelEncoding::Ufloat(_) => Range::same(value),
        }
    }

    fn encode(&mut self, encoding: ChannelEncoding, value: Range) -> CodeInterval {
        let float = self.store(encoding, value.float, 0.0);
        if value.is_same() {
            return float;
        }
        // Codes that were divided and multiplied again are integers, except for the rounding of this
        // computation.
        let codes = float.hull(self.store(encoding, value.codes, INTEGER_SLACK));
        if value.fixed == value.codes {
            return codes;
        }
        codes.hull(self.store(encoding, value.fixed, INTEGER_SLACK))
    }

    fn blend_operand(&mut self, encoding: ChannelEncoding, value: Range) -> Range {
        let clamped = value.map(|v| self.blend_clamp(encoding, v));
        let float = self.float_outward(encoding, clamped.float, clamped.float);
        let rounded = self.on_grids(encoding, clamped);
        Range {
            float: match self.blend_precision() {
                BlendPrecision::UniformSteps if has_few_codes(encoding) => {
                    float.hull(rounded.codes)
                }
                _ => float,
            },
            ..rounded
        }
    }

    fn blend_weight(
        &mut self,
        [to, alpha]: [ChannelEncoding; 2],
        exact: Range,
        operand: Range,
    ) -> Range {
        if self.bits(to) > self.bits(alpha) && self.rules.weights_by_channel.value() {
            self.blend_operand(to, exact)
        } else {
            operand
        }
    }

    fn blend_complement(&mut self, encoding: ChannelEncoding, value: Range) -> Range {
        let one = Range::exact(1.0);
        let exact = one.zip(value, Interval::minus);
        let float = if value.float.is(0.0) || value.float.is(1.0) {
            exact.float
        } else {
            self.float_step(encoding, exact.float)
        };
        let rounded = match encoding {
            // The complement of an integer is an integer.
            ChannelEncoding::Unorm(_) | ChannelEncoding::Snorm(_) if !self.advanced => exact,
            _ => self.on_grids(encoding, exact),
        };
        Range { float, ..rounded }
    }

    fn blend_factor(&mut self, encoding: ChannelEncoding, value: Range) -> Range {
        value.map(|v| {
            let clamped = self.blend_clamp(encoding, v);
            match self.rules.factor_clamp.value() {
                FactorClamp::Clamped => clamped,
                FactorClamp::Either => clamped.hull(v),
            }
        })
    }

    /// No specification says whether a factor of zero is multiplied or its side is left out.
    fn blend_zero(&mut self, operand: Range) -> Range {
        operand.map(|v| {
            if v.low.is_finite() && v.high.is_finite() {
                Interval::exact(0.0)
            } else {
                Interval::EVERYTHING
            }
        })
    }

    fn blend_product(&mut self, encoding: ChannelEncoding, operand: Range, factor: Range) -> Range {
        let product = operand.zip(factor, Interval::times);
        let plain = |v: Interval| v.is(0.0) || v.is(1.0);
        let float = if plain(operand.float) || plain(factor.float) {
            product.float
        } else {
            self.float_step(encoding, product.float)
        };
        Range {
            float: float.may_overflow(),
            ..self.result_on_grids(encoding, product)
        }
    }

    fn blend_sum(
        &mut self,
        encoding: ChannelEncoding,
        a: Range,
        b: Range,
        subtract: bool,
    ) -> Range {
        let sum = a.zip(b, |a, b| if subtract { a.minus(b) } else { a.plus(b) });
        let float = if a.float.is(0.0) || b.float.is(0.0) {
            sum.float
        } else {
            // The error is relative to the sides and their sum, which can be a small difference. An infinite
            // side adds no error.
            let greatest = f64::from(f32::MAX);
            let largest = [a.float, b.float, sum.float]
                .into_iter()
                .flat_map(|v| [v.low, v.high])
                .fold(0.0, |m: f64, v| m.max(v.abs().min(greatest)));
            let computed = sum.float.widen(largest * self.blend_error(encoding));
            self.float_outward(encoding, sum.float, computed)
        };
        let rounded = match encoding {
            // A sum of floats is rounded like any result; one of integers is an integer.
            _ if self.advanced => self.result_on_grids(encoding, sum),
            ChannelEncoding::Float16 | ChannelEncoding::Ufloat(_) | ChannelEncoding::Srgb8 => {
                self.result_on_grids(encoding, sum)
            }
            _ => sum,
        };
        Range {
            float: float.may_overflow(),
            ..rounded
        }
    }

    /// Differences of normalized values are in range, so that each order has the same errors.
    fn blend_mix(
        &mut self,
        encoding: ChannelEncoding,
        in_order: Range,
        by_difference: impl FnOnce(&mut Self) -> Range,
    ) -> Range {
        if !encoding.is_float() || self.rules.blends_in_order.value() {
            return in_order;
        }
        in_order.zip(by_difference(self), Interval::hull)
    }

    /// An exact 0 and a divisor of 1 leave the quotient exact. A nonzero colour with a possibly zero alpha is
    /// undefined (OpenGL ES 3.2, 15.1.5.3: ill-formed). At the precision of a normalized destination,
    /// quotients above 1 can be beyond its range.
    fn blend_quotient(&mut self, encoding: ChannelEncoding, color: Range, alpha: Range) -> Range {
        let exact = color.zip(alpha, |c, a| match (c.is(0.0), a.contains(0.0)) {
            (true, _) => c,
            (false, true) => Interval::EVERYTHING,
            (false, false) => c.corners(a, |c, a| c / a),
        });
        let quotient = self.divided(encoding, exact, color, alpha);
        let held = match encoding.normalized_range() {
            Some((low, high)) => quotient.map(|v| v.hull(v.clamp(f64::from(low), f64::from(high)))),
            None => quotient,
        };
        Range {
            float: quotient.float.may_overflow(),
            ..held
        }
    }

    /// If the divisor can be 0, only its positive values count: no blend divides by 0.
    fn blend_ratio(&mut self, encoding: ChannelEncoding, a: Range, b: Range) -> Range {
        let exact = a.zip(b, |a, b| {
            if a.may_be_nan() || b.may_be_nan() {
                return Interval::EVERYTHING;
            }
            let least = |v: f64| v.clamp(0.0, 1.0);
            let low = least(a.low.max(0.0) / b.high.max(f64::MIN_POSITIVE));
            let high = match (a.high <= 0.0, b.low <= 0.0) {
                (true, _) => 0.0,
                (false, true) => 1.0,
                (false, false) => least(a.high / b.low),
            };
            Interval { low, high }
        });
        let ratio = self.divided(encoding, exact, a, b);
        ratio.map(|v| v.clamp_number(0.0, 1.0))
    }

    fn blend_root(&mut self, encoding: ChannelEncoding, value: Range) -> Range {
        let exact = value.map(|v| {
            if v.may_be_nan() {
                v
            } else {
                v.map_increasing(|v| v.max(0.0).sqrt())
            }
        });
        if matches!(
            encoding,
            ChannelEncoding::Float16 | ChannelEncoding::Float32
        ) && self.is_coarse()
        {
            // The error of a shader's root, in units of 16-bit floats.
            let half = ROOT_UNITS * 2_f64.powi(1 - HALF_SIGNIFICAND as i32);
            let wide = exact.map(|v| v.widen_relative(half));
            return Range {
                float: exact.float.widen_relative(self.error()),
                ..self.on_grids(encoding, wide)
            };
        }
        let inverse = self.inverse(encoding, exact);
        let product = value.zip(inverse, Interval::times);
        self.rounded_once(encoding, exact)
            .zip(self.rounded_once(encoding, product), Interval::hull)
    }

    /// Each permitted way of computing selects separately.
    fn blend_select(&mut self, a: Range, b: Range, at_most: Range, otherwise: Range) -> Range {
        let select = |[a, b, at_most, otherwise]: [Interval; 4]| {
            let unknown = a.may_be_nan() || b.may_be_nan();
            match (a.high <= b.low && !unknown, a.low <= b.high || unknown) {
                (true, _) => at_most,
                (false, false) => otherwise,
                (false, true) => at_most.hull(otherwise),
            }
        };
        let operands = [a, b, at_most, otherwise];
        Range {
            float: select(operands.map(|r| r.float)),
            codes: select(operands.map(|r| r.codes)),
            fixed: select(operands.map(|r| r.fixed)),
        }
    }

    /// The result is exact for exact codes, the hull of all outcomes for a few codes, and otherwise
    /// unbounded.
    fn logic(
        &mut self,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: CodeInterval,
        dst: CodeInterval,
    ) -> CodeInterval {
        if src.count().saturating_mul(dst.count()) > 64 {
            return CodeInterval::new(encoding.min_order(), encoding.max_order());
        }
        let mut result: Option<CodeInterval> = None;
        for s in src.low..=src.high {
            for d in dst.low..=dst.high {
                let (s, d) = (encoding.code_of_order(s), encoding.code_of_order(d));
                let code = logic_operation(encoding, operation, s, d);
                let codes = CodeInterval::exact(encoding.order_of_code(code));
                result = Some(result.map_or(codes, |r| r.hull(codes)));
            }
        }
        result.unwrap_or(dst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::Api;

    #[test]
    fn zero_and_one_are_exact_and_other_codes_have_neighbours() {
        let rules = Rules::of(&crate::test_limits::limits(Api::Vulkan));
        let mut a = Judging::new(&rules);
        let e = ChannelEncoding::Unorm(8);
        for (value, low, high) in [(0.0, 0, 0), (1.0, 255, 255), (0.5, 127, 128)] {
            let v = a.constant(value);
            assert_eq!(a.encode(e, v), CodeInterval::new(low, high));
        }
        let back = a.decode(e, CodeInterval::exact(100));
        assert_eq!(a.encode(e, back), CodeInterval::new(99, 101));
    }

    /// 254/255 is between two 16-bit floats, and 1 minus the lower one exceeds 1 minus 254/255 by an eighth.
    #[test]
    fn a_blend_in_16_bit_floats_is_legal_although_they_lack_the_codes() {
        let rules = Rules::of(&crate::test_limits::limits(Api::Vulkan));
        let mut a = Judging::new(&rules);
        let e = ChannelEncoding::Srgb8;
        let alpha = a.constant(254.0 / 255.0);
        let alpha = a.blend_operand(ChannelEncoding::Unorm(8), alpha);
        let rest = a.blend_complement(ChannelEncoding::Unorm(8), alpha);
        assert!(rest.float.contains(1.0 - 2039.0 / 2048.0));
        let color = a.decode(e, CodeInterval::exact(254));
        let color = a.blend_operand(e, color);
        let product = a.blend_product(e, color, rest);
        assert!(a.encode(e, product).contains(14));
    }

    /// 100/127 is between 100/128 and 101/128, and the product of two such fractions is rounded to one again.
    #[test]
    fn a_blend_in_binary_fractions_is_legal_although_they_lack_the_codes() {
        let rules = Rules::of(&crate::test_limits::limits(Api::OpenGlEs));
        let mut a = Judging::new(&rules);
        let e = ChannelEncoding::Snorm(8);
        let value = a.decode(e, CodeInterval::exact(100));
        let value = a.blend_operand(e, value);
        assert_eq!(value.codes, Interval::exact(100.0 / 127.0));
        let steps = |low: f64, high: f64| Interval::between(low / 128.0, high / 128.0);
        assert_eq!(value.fixed, steps(100.0, 101.0));
        let product = a.blend_product(e, value, value);
        assert_eq!(product.fixed, steps(78.0, 80.0));
        assert_eq!(a.blend_complement(e, value).fixed, steps(27.0, 28.0));
        let one = a.constant(1.0);
        assert_eq!(a.blend_operand(e, one).fixed, Interval::exact(1.0));
    }

    /// 1/3 is 100 of 300 steps, and 100.5 steps are rounded to 100 or 101.
    #[test]
    fn a_blend_in_any_even_steps_is_computed_in_these_alone() {
        let mut rules = Rules::of(&crate::test_limits::limits(Api::Vulkan));
        let e = ChannelEncoding::Unorm(8);
        assert!(Judging::new(&rules).uniform_steps(&[e]).is_empty());
        rules.blend.set(BlendPrecision::UniformSteps);
        let mut a = Judging::new(&rules);
        assert_eq!(a.uniform_steps(&[e; 4]), 0..766);
        assert!(a.uniform_steps(&[ChannelEncoding::Unorm(10)]).is_empty());
        a.further_steps = Some(45);
        let value = a.constant(100.5 / 300.0);
        let value = a.blend_operand(e, value);
        assert_eq!(value.fixed, Interval::between(100.0 / 300.0, 101.0 / 300.0));
        // A channel with fewer codes has at most four times as many steps.
        let e = ChannelEncoding::Unorm(5);
        let value = a.constant(0.5);
        assert_eq!(
            a.blend_operand(e, value).fixed,
            Interval::between(38.0 / 76.0, 38.0 / 76.0)
        );
    }

    #[test]
    fn the_yardstick_requires_the_nearest_code_and_exact_round_trips() {
        let rules = Rules::yardstick(&crate::test_limits::limits(Api::Vulkan));
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
    fn a_float_is_stored_exactly_in_a_float_channel() {
        let rules = Rules::of(&crate::test_limits::limits(Api::OpenGl));
        let mut a = Judging::new(&rules);
        for value in [0.0, 1e-30, 0.3, 0.99999994, 1.0_f32] {
            let v = a.constant(value);
            let expected = CodeInterval::exact(i64::from(value.to_bits()));
            assert_eq!(a.encode(ChannelEncoding::Float32, v), expected);
        }
    }
}
