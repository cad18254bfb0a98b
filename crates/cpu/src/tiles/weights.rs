//! Blends of 8-bit unsigned normalized channels whose factors depend on several channels of the destination.
//!
//! Every factor is a constant plus the destination's channel and the destination's alpha, each times 0, 1 or
//! -1, clamped to a limit. All numbers are between 0 and 1, so that products with 0 and sums with 0 change
//! nothing.

use super::image::TexelWord;
use crate::lanes::{LANES, LaneCodes, Real};
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation};
use fearless_simd::Simd;

/// The encoding of all channels.
const UNORM: ChannelEncoding = ChannelEncoding::Unorm(8);

/// A function of a texel's codes.
#[derive(Debug)]
pub(crate) struct Weights {
    /// The weights of each channel.
    channels: [ChannelWeights; 4],
    /// The offset and the scale applied to the stored alpha: 1 and 0 if the format has no alpha, which then
    /// counts as 1.
    alpha: [f32; 2],
    /// The mask of bits that are not written.
    keep: u32,
}

/// The function of one channel: the sum of the source and the destination, each times its factor.
#[derive(Clone, Copy, Debug)]
struct ChannelWeights {
    source: f32,
    of_source: Weight,
    of_destination: Weight,
}

/// A factor.
#[derive(Clone, Copy, Debug)]
struct Weight {
    constant: f32,
    own: f32,
    alpha: f32,
    most: f32,
    /// 1, or -1 if the product is subtracted.
    sign: f32,
}

/// The constant inputs of a blend.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    pub(crate) source: [f32; 4],
    pub(crate) second: [f32; 4],
    pub(crate) constant: [f32; 4],
}

impl Weights {
    /// Returns the function of a blend with two components and this many channels, if the operations are
    /// sums.
    pub(crate) fn new(
        [color, alpha]: [BlendComponent; 2],
        constants: &Constants,
        channels: usize,
        write_mask: u8,
    ) -> Option<Self> {
        let held = |values: [f32; 4]| values.map(|v| v.clamp(0.0, 1.0));
        let constants = Constants {
            source: held(constants.source),
            second: held(constants.second),
            constant: held(constants.constant),
        };
        let finite = |values: [f32; 4]| values.iter().all(|v| v.is_finite());
        if !(finite(constants.source) && finite(constants.second) && finite(constants.constant)) {
            return None;
        }
        let mut slots = [None; 4];
        for (c, channel) in slots.iter_mut().enumerate() {
            let component = if c == 3 { &alpha } else { &color };
            let (source, destination) = match component.operation {
                BlendOperation::Add => (1.0, 1.0),
                BlendOperation::Subtract => (1.0, -1.0),
                BlendOperation::ReverseSubtract => (-1.0, 1.0),
                BlendOperation::Min | BlendOperation::Max => return None,
            };
            let weight = |factor, sign| Weight::new(factor, &constants, c, sign);
            *channel = Some(ChannelWeights {
                source: constants.source[c],
                of_source: weight(component.src_factor, source),
                of_destination: weight(component.dst_factor, destination),
            });
        }
        let [Some(r), Some(g), Some(b), Some(a)] = slots else {
            return None;
        };
        let mut keep = 0;
        for c in 0..4 {
            if c >= channels || write_mask & (1 << c) == 0 {
                keep |= 0xff << (8 * c);
            }
        }
        Some(Self {
            channels: [r, g, b, a],
            alpha: if channels == 4 {
                [0.0, 1.0]
            } else {
                [1.0, 0.0]
            },
            keep,
        })
    }

    /// Applies the function to texels. It is large, so it is not inlined.
    #[inline(never)]
    pub(crate) fn apply<S: Simd>(&self, simd: S, texels: &mut [[TexelWord; LANES]]) {
        simd.vectorize(
            #[inline(always)]
            || {
                for texels in texels {
                    *texels = self.applied(texels);
                }
            },
        );
    }

    #[inline(always)]
    fn applied(&self, texels: &[TexelWord; LANES]) -> [TexelWord; LANES] {
        let words = bytemuck::cast::<_, LaneCodes>(*texels).map(u32::from_le);
        let [r, g, b, a] = &self.channels;
        let last = stored(&words, 24);
        let mut alpha = last;
        for alpha in &mut alpha {
            *alpha = self.alpha[0] + self.alpha[1] * *alpha;
        }
        // Channel by channel, so that shifts are constants.
        let mut new = a.codes(&last, &alpha);
        for code in &mut new {
            *code <<= 24;
        }
        join(&mut new, &b.codes(&stored(&words, 16), &alpha), 16);
        join(&mut new, &g.codes(&stored(&words, 8), &alpha), 8);
        join(&mut new, &r.codes(&stored(&words, 0), &alpha), 0);
        for (new, old) in new.iter_mut().zip(words) {
            *new = (old & self.keep | *new & !self.keep).to_le();
        }
        bytemuck::cast(new)
    }
}

/// Returns the values of the bytes at a bit position.
#[inline(always)]
fn stored(words: &LaneCodes, bit: u32) -> Real {
    Faithful.color_value(UNORM, words.map(|word| word >> bit & 0xff))
}

/// Inserts bytes into words at a bit position.
#[inline(always)]
fn join(words: &mut LaneCodes, codes: &LaneCodes, bit: u32) {
    for (word, code) in words.iter_mut().zip(codes) {
        *word |= code << bit;
    }
}

impl ChannelWeights {
    /// Returns the codes of one channel, from the stored values of the channel and of alpha.
    #[inline(always)]
    fn codes(&self, stored: &Real, alpha: &Real) -> LaneCodes {
        let mut result = *stored;
        for (result, alpha) in result.iter_mut().zip(alpha) {
            let value = *result;
            let source = self.source * self.of_source.at(value, *alpha);
            let destination = value * self.of_destination.at(value, *alpha);
            *result = self.of_source.sign * source + self.of_destination.sign * destination;
        }
        Faithful.color_codes(UNORM, result)
    }
}

impl Weight {
    fn new(factor: BlendFactor, constants: &Constants, channel: usize, sign: f32) -> Self {
        let Constants {
            source,
            second,
            constant,
        } = constants;
        let weights = |constant, of_channel, alpha| Self {
            constant,
            own: of_channel,
            alpha,
            most: f32::INFINITY,
            sign,
        };
        use BlendFactor as F;
        match factor {
            F::Zero => weights(0.0, 0.0, 0.0),
            F::One => weights(1.0, 0.0, 0.0),
            F::Src => weights(source[channel], 0.0, 0.0),
            F::OneMinusSrc => weights(1.0 - source[channel], 0.0, 0.0),
            F::SrcAlpha => weights(source[3], 0.0, 0.0),
            F::OneMinusSrcAlpha => weights(1.0 - source[3], 0.0, 0.0),
            F::Src1 => weights(second[channel], 0.0, 0.0),
            F::OneMinusSrc1 => weights(1.0 - second[channel], 0.0, 0.0),
            F::Src1Alpha => weights(second[3], 0.0, 0.0),
            F::OneMinusSrc1Alpha => weights(1.0 - second[3], 0.0, 0.0),
            F::Constant => weights(constant[channel], 0.0, 0.0),
            F::OneMinusConstant => weights(1.0 - constant[channel], 0.0, 0.0),
            F::ConstantAlpha => weights(constant[3], 0.0, 0.0),
            F::OneMinusConstantAlpha => weights(1.0 - constant[3], 0.0, 0.0),
            F::Dst => weights(0.0, 1.0, 0.0),
            F::OneMinusDst => weights(1.0, -1.0, 0.0),
            F::DstAlpha => weights(0.0, 0.0, 1.0),
            F::OneMinusDstAlpha => weights(1.0, 0.0, -1.0),
            F::SrcAlphaSaturated if channel == 3 => weights(1.0, 0.0, 0.0),
            F::SrcAlphaSaturated => Self {
                most: source[3],
                ..weights(1.0, 0.0, -1.0)
            },
        }
    }

    #[inline(always)]
    fn at(&self, value: f32, alpha: f32) -> f32 {
        let factor = self.constant + self.own * value + self.alpha * alpha;
        if factor < self.most {
            factor
        } else {
            self.most
        }
    }
}
