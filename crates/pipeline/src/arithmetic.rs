//! The number system over which the pipeline is generic.

use etalon_frame::ChannelEncoding;
use etalon_scene::LogicOperation;

/// A number system. Operations take `&mut self` so that a system can record what it did.
///
/// A step has its own method if the specifications grant it freedom of its own: a store may round to either
/// neighbour, a blend may work at the destination's precision. [`crate::Plain`] computes the single result
/// that the yardstick expects, the judging system all results that are allowed.
pub trait Arithmetic {
    /// One real value, or one per lane.
    type Real: Copy;
    /// Codes of one channel, as the caller stores them.
    type Code: Copy;

    /// Returns a value that is exactly this float.
    fn constant(&mut self, value: f32) -> Self::Real;
    /// Returns the sum.
    fn add(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Returns the difference.
    fn sub(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Returns the product.
    fn mul(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Returns the quotient; infinite or NaN for a divisor of zero.
    fn div(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Returns the smaller of two values.
    fn min(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;
    /// Returns the larger of two values.
    fn max(&mut self, a: Self::Real, b: Self::Real) -> Self::Real;

    /// Returns a result that a shader computed, at the precision of shaders.
    fn rounded(&mut self, value: Self::Real) -> Self::Real;
    /// Returns the binary logarithm as a shader computes it.
    fn log2(&mut self, value: Self::Real) -> Self::Real;
    /// Returns two to the power of a value as a shader computes it.
    fn exp2(&mut self, value: Self::Real) -> Self::Real;
    /// Returns the square root as a shader computes it; NaN if the value is negative.
    fn sqrt(&mut self, value: Self::Real) -> Self::Real;
    /// Returns the hash of the unit square that contains a point ([`crate::cell_hash()`]). The result matters only
    /// if no coordinate is negative.
    fn cell_hash(&mut self, point: [Self::Real; 2]) -> Self::Real;
    /// Returns the third value if the first is less than the second, otherwise the fourth.
    fn select_less(
        &mut self,
        a: Self::Real,
        b: Self::Real,
        less: Self::Real,
        otherwise: Self::Real,
    ) -> Self::Real;

    /// Returns true if the first value is less than the second in every lane, whatever the freedom.
    fn always_less(&mut self, a: Self::Real, b: Self::Real) -> bool;

    /// Returns a window coordinate as the viewport transform computes it, in texels of an axis of `length`.
    fn window_coordinate(&mut self, value: Self::Real, length: f32) -> Self::Real;
    /// Returns a window depth as the viewport transform computes it, within a range of depths.
    fn window_depth(&mut self, value: Self::Real, range: [f32; 2]) -> Self::Real;

    /// Returns the value of a stored code.
    fn decode(&mut self, encoding: ChannelEncoding, code: Self::Code) -> Self::Real;
    /// Returns the code that a value is stored as.
    fn encode(&mut self, encoding: ChannelEncoding, value: Self::Real) -> Self::Code;

    /// Returns a source, destination or constant as it enters a blend into this encoding: clamped to the
    /// encoding's range, at the precision of blending.
    fn blend_operand(&mut self, encoding: ChannelEncoding, value: Self::Real) -> Self::Real;
    /// Returns a source's alpha as it weighs a channel whose encoding is not that of alpha, from the exact alpha and
    /// from the operand that enters the blend of alpha.
    #[inline(always)]
    fn blend_weight(
        &mut self,
        _encodings: [ChannelEncoding; 2],
        _exact: Self::Real,
        operand: Self::Real,
    ) -> Self::Real {
        operand
    }
    /// Returns a blend factor of the form `1 - value`.
    fn blend_complement(&mut self, encoding: ChannelEncoding, value: Self::Real) -> Self::Real;
    /// Returns a factor clamped to the encoding's range, ready to multiply by.
    fn blend_factor(&mut self, encoding: ChannelEncoding, value: Self::Real) -> Self::Real;
    /// Returns one side of a blend equation whose factor is zero: zero, unless the operand is an infinity or
    /// NaN.
    #[inline(always)]
    fn blend_zero(&mut self, _operand: Self::Real) -> Self::Real {
        self.constant(0.0)
    }
    /// Returns one side of a blend equation: operand times factor.
    fn blend_product(
        &mut self,
        encoding: ChannelEncoding,
        operand: Self::Real,
        factor: Self::Real,
    ) -> Self::Real;
    /// Returns the result of a blend equation: `a + b`, or `a - b`.
    fn blend_sum(
        &mut self,
        encoding: ChannelEncoding,
        a: Self::Real,
        b: Self::Real,
        subtract: bool,
    ) -> Self::Real;
    /// Returns the values of a blend that weighs source and destination by a factor and its complement: `in_order`
    /// by the equation, `by_difference` from one operand and the other's difference to it.
    #[inline(always)]
    fn blend_mix(
        &mut self,
        _encoding: ChannelEncoding,
        in_order: Self::Real,
        _by_difference: impl FnOnce(&mut Self) -> Self::Real,
    ) -> Self::Real {
        in_order
    }
    /// Returns a colour divided by its alpha for advanced blending; 0 if alpha is 0.
    fn blend_quotient(
        &mut self,
        encoding: ChannelEncoding,
        color: Self::Real,
        alpha: Self::Real,
    ) -> Self::Real;
    /// Returns the smaller of 1 and `a / b` in advanced blending. The result matters only if neither is
    /// negative and `b` is not 0.
    fn blend_ratio(
        &mut self,
        encoding: ChannelEncoding,
        a: Self::Real,
        b: Self::Real,
    ) -> Self::Real;
    /// Returns a square root in advanced blending. The result matters only if the value is not negative.
    fn blend_root(&mut self, encoding: ChannelEncoding, value: Self::Real) -> Self::Real;
    /// Returns, in advanced blending, the third value if the first is at most the second, otherwise the
    /// fourth.
    fn blend_select(
        &mut self,
        a: Self::Real,
        b: Self::Real,
        at_most: Self::Real,
        otherwise: Self::Real,
    ) -> Self::Real;
    /// Returns the code that a logic operation stores, from the codes of source and destination.
    fn logic(
        &mut self,
        encoding: ChannelEncoding,
        operation: LogicOperation,
        src: Self::Code,
        dst: Self::Code,
    ) -> Self::Code;
}
