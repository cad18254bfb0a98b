//! Blends of fetched texels. They process one channel of several groups at a time, so that encodings, factors
//! and operations are matched once for all of them.
//!
//! The steps and their order are the pipeline's plain arithmetic. Planes are flat, since loops over groups of
//! lanes become gathers and scatters.

use super::AREA;
use super::fragments::Fragments;
use super::lanes::{LaneBits, lanes, select};
use super::layout::WordLayout;
use super::planes::{CodePlane, GROUPS, Plane, TEXELS, decode, encode};
use super::texels::Sources;
use crate::lanes::LANES;
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, Plain};
use etalon_scene::{BlendComponent, BlendFactor, BlendOperation, ColorTarget, LogicOperation};
use fearless_simd::Simd;

/// A function of a texel's codes and of fetched texels.
#[derive(Debug)]
pub(crate) struct TileVarying {
    pub(crate) target: ColorTarget,
    pub(crate) constant: [f32; 4],
    /// The logic operation that replaces blending.
    pub(crate) logic: Option<LogicOperation>,
    /// True if the alpha of the first and of the second source is 1.
    pub(crate) opaque: [bool; 2],
    pub(crate) channels: &'static [ChannelEncoding],
    pub(crate) layout: WordLayout,
}

/// The inputs of a blend by channel: source, second source and destination.
struct BlendInputs {
    source: [Plane; 4],
    second: [Plane; 4],
    stored: [Plane; 4],
}

/// Intermediate results, in memory that is reused and not cleared.
struct Buffers {
    words: [CodePlane; 4],
    /// The destination's codes.
    old: [CodePlane; 4],
    /// The blended values of a channel, and their codes.
    values: Plane,
    codes: CodePlane,
    /// The factors that are not inputs.
    factors: [Plane; 2],
}

/// A factor that is not multiplied yet.
enum PendingFactor<'a> {
    Zero,
    One,
    Value(&'a [f32]),
    /// 1 minus these values.
    Complement(&'a [f32]),
}

impl TileVarying {
    /// Applies the function to fragments of a sample's planes.
    #[inline(never)]
    pub(crate) fn apply<S: Simd>(
        &self,
        simd: S,
        planes: &mut [u32],
        fragments: &Fragments,
        sources: &Sources<'_>,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                let zeros = [[0.0; TEXELS]; 4];
                let mut inputs = BlendInputs {
                    source: zeros,
                    second: zeros,
                    stored: zeros,
                };
                let mut buffers = Buffers {
                    words: [[0; TEXELS]; 4],
                    old: [[0; TEXELS]; 4],
                    values: [0.0; TEXELS],
                    codes: [0; TEXELS],
                    factors: [[0.0; TEXELS]; 2],
                };
                let (places, masks) = fragments.parts();
                for groups in places.chunks(GROUPS).zip(masks.chunks(GROUPS)) {
                    self.groups(simd, planes, groups, sources, &mut inputs, &mut buffers);
                }
            },
        );
    }

    #[inline(always)]
    fn groups<S: Simd>(
        &self,
        simd: S,
        planes: &mut [u32],
        (places, masks): (&[u16], &[LaneBits]),
        sources: &Sources<'_>,
        inputs: &mut BlendInputs,
        buffers: &mut Buffers,
    ) {
        let Buffers {
            words,
            old,
            values,
            codes,
            factors,
        } = buffers;
        let count = places.len() * LANES;
        let (layout, fields) = (&self.layout, self.layout.fields());
        sources.first(places, &mut inputs.source);
        if self.opaque[0] {
            inputs.source[3].fill(1.0);
        }
        for (word, words) in words.iter_mut().enumerate().take(layout.words) {
            for (words, place) in words.as_chunks_mut().0.iter_mut().zip(places) {
                *words = *lanes(planes, word * AREA + usize::from(*place));
            }
        }
        for (old, field) in old.iter_mut().zip(fields) {
            for (old, word) in old.iter_mut().zip(&words[field.word]) {
                *old = field.code(*word);
            }
        }
        if let Some(state) = &self.target.blend {
            sources.second(places, &mut inputs.second);
            if self.opaque[1] {
                inputs.second[3].fill(1.0);
            }
            inputs.stored[3].fill(Faithful.missing_alpha(state));
            let stored = inputs.stored.iter_mut().zip(&*old);
            for ((stored, codes), encoding) in stored.zip(self.channels) {
                decode(*encoding, &codes[..count], stored);
            }
            self.hold(sources, inputs, count);
        }
        for (c, encoding) in self.channels.iter().enumerate() {
            if self.target.write_mask & (1 << c) == 0 {
                continue;
            }
            let blended = match &self.target.blend {
                None => &inputs.source[c][..count],
                Some(state) => {
                    let values = &mut values[..count];
                    let part = if c == 3 { state.alpha } else { state.color };
                    if self.in_unit(sources, part) {
                        self.blended_in_unit(part, c, inputs, factors, values)
                    } else {
                        self.blended(part, c, inputs, factors, values)
                    }
                    values
                }
            };
            encode(*encoding, blended, codes);
            if let Some(operation) = self.logic {
                for (new, old) in codes[..count].iter_mut().zip(&old[c]) {
                    [*new] = Plain::<1>.logic(*encoding, operation, [*new], [*old]);
                }
            }
            let field = fields[c];
            for (word, code) in words[field.word].iter_mut().zip(&*codes) {
                *word = field.replaced(*word, *code);
            }
        }
        for (word, new) in words.iter().enumerate().take(layout.words) {
            let groups = new.as_chunks().0.iter().zip(places.iter().zip(masks));
            for (new, (place, mask)) in groups {
                let stored = lanes(planes, word * AREA + usize::from(*place));
                select(simd, stored, *mask, new);
            }
        }
    }

    /// Returns the encoding of a channel. Channels that the format lacks have the encoding of the last
    /// channel.
    #[inline(always)]
    fn encoding(&self, c: usize) -> ChannelEncoding {
        self.channels[c.min(self.channels.len() - 1)]
    }

    /// Converts the operands of normalized channels to blending precision, unless they are already in range.
    #[inline(always)]
    fn hold(&self, sources: &Sources<'_>, inputs: &mut BlendInputs, count: usize) {
        let wide = sources.exceed_unit();
        for c in 0..4 {
            let encoding = self.encoding(c);
            if encoding.normalized_range().is_none() {
                continue;
            }
            for (plane, wide) in [&mut inputs.source[c], &mut inputs.second[c]]
                .into_iter()
                .zip(wide)
            {
                if wide {
                    for value in &mut plane[..count] {
                        [*value] = Plain::<1>.blend_operand(encoding, [*value]);
                    }
                }
            }
        }
    }

    /// Returns true if all operands of a channel are between 0 and 1, and its blend is a sum of products.
    #[inline(always)]
    fn in_unit(&self, sources: &Sources<'_>, part: BlendComponent) -> bool {
        use ChannelEncoding::{Srgb8, Unorm};
        let sum = !matches!(part.operation, BlendOperation::Min | BlendOperation::Max);
        let simple = |factor| {
            use BlendFactor as F;
            !matches!(
                factor,
                F::SrcAlphaSaturated
                    | F::Constant
                    | F::OneMinusConstant
                    | F::ConstantAlpha
                    | F::OneMinusConstantAlpha
            )
        };
        let factors = simple(part.src_factor) && simple(part.dst_factor);
        let target = self.channels.iter().all(|e| matches!(e, Unorm(_) | Srgb8));
        sum && factors && target && sources.exceed_unit() == [false; 2]
    }

    /// Computes the blended values of a channel whose operands are between 0 and 1. A factor is then a
    /// constant plus an operand times 0, 1 or -1, so that one loop handles all factors. The sign of a zero is
    /// not stored.
    #[inline(always)]
    fn blended_in_unit(
        &self,
        part: BlendComponent,
        c: usize,
        inputs: &BlendInputs,
        [first, second]: &mut [Plane; 2],
        values: &mut [f32],
    ) {
        let (s, d) = (&inputs.source[c], &inputs.stored[c]);
        let [(a, b, x), (e, f, y)] = [
            (self.factor(part.src_factor, c, inputs, first), s),
            (self.factor(part.dst_factor, c, inputs, second), d),
        ]
        .map(|(factor, any)| match factor {
            PendingFactor::Zero => (0.0, 0.0, &any[..]),
            PendingFactor::One => (1.0, 0.0, &any[..]),
            PendingFactor::Value(factors) => (0.0, 1.0, factors),
            PendingFactor::Complement(factors) => (1.0, -1.0, factors),
        });
        let (plus, minus) = match part.operation {
            BlendOperation::Subtract => (1.0, -1.0),
            BlendOperation::ReverseSubtract => (-1.0, 1.0),
            _ => (1.0, 1.0),
        };
        let operands = s.iter().zip(x).zip(d.iter().zip(y));
        for (value, ((s, x), (d, y))) in values.iter_mut().zip(operands) {
            *value = plus * (s * (a + b * x)) + minus * (d * (e + f * y));
        }
    }

    /// Computes the blended values of a channel.
    #[inline(always)]
    fn blended(
        &self,
        part: BlendComponent,
        c: usize,
        inputs: &BlendInputs,
        [first, second]: &mut [Plane; 2],
        values: &mut [f32],
    ) {
        let encoding = self.encoding(c);
        let count = values.len();
        let (source, stored) = (&inputs.source[c][..count], &inputs.stored[c][..count]);
        let mut plain = Plain::<1>;
        macro_rules! run {
            ($pairs:expr, |$s:ident, $d:ident| $result:expr) => {
                for (value, ($s, $d)) in values.iter_mut().zip($pairs) {
                    let ($s, $d) = ([*$s], [*$d]);
                    [*value] = $result;
                }
            };
        }
        let pairs = source.iter().zip(stored);
        match part.operation {
            BlendOperation::Min => return run!(pairs, |s, d| plain.min(s, d)),
            BlendOperation::Max => return run!(pairs, |s, d| plain.max(s, d)),
            BlendOperation::Add | BlendOperation::Subtract | BlendOperation::ReverseSubtract => {}
        }
        let factors = (
            self.factor(part.src_factor, c, inputs, first),
            self.factor(part.dst_factor, c, inputs, second),
        );
        // For signed channels, the complement of a number below 0 exceeds the normalized range.
        let held = matches!(encoding, ChannelEncoding::Snorm(_));
        let (same, rest) = (|x: f32| x, |x: f32| 1.0 - x);
        match factors {
            (PendingFactor::Value(x), PendingFactor::Value(y)) => {
                summed(part.operation, values, (source, x, same), (stored, y, same));
            }
            (PendingFactor::Value(x), PendingFactor::Complement(y)) if !held => {
                summed(part.operation, values, (source, x, same), (stored, y, rest));
            }
            (PendingFactor::Complement(x), PendingFactor::Value(y)) if !held => {
                summed(part.operation, values, (source, x, rest), (stored, y, same));
            }
            (PendingFactor::Complement(x), PendingFactor::Complement(y)) if !held => {
                summed(part.operation, values, (source, x, rest), (stored, y, rest));
            }
            (x, y) => {
                let mut sides = [[0.0; TEXELS]; 2];
                let [s, d] = &mut sides;
                self.product(x, encoding, source, &mut s[..count]);
                self.product(y, encoding, stored, &mut d[..count]);
                let ones = [1.0; TEXELS];
                summed(part.operation, values, (s, &ones, same), (d, &ones, same));
            }
        }
    }

    /// Computes the products of one side of the equation.
    #[inline(always)]
    fn product(
        &self,
        factor: PendingFactor<'_>,
        encoding: ChannelEncoding,
        operands: &[f32],
        products: &mut [f32],
    ) {
        let mut plain = Plain::<1>;
        match factor {
            PendingFactor::Zero => products.fill(0.0),
            PendingFactor::One => products.copy_from_slice(operands),
            PendingFactor::Value(factors) => {
                let pairs = operands.iter().zip(factors);
                for (product, (operand, factor)) in products.iter_mut().zip(pairs) {
                    [*product] = plain.blend_product(encoding, [*operand], [*factor]);
                }
            }
            PendingFactor::Complement(factors) => {
                let pairs = operands.iter().zip(factors);
                for (product, (operand, factor)) in products.iter_mut().zip(pairs) {
                    let factor = plain.blend_complement(encoding, [*factor]);
                    let factor = plain.blend_factor(encoding, factor);
                    [*product] = plain.blend_product(encoding, [*operand], factor);
                }
            }
        }
    }

    /// Returns a factor of a channel. A factor that is not an input is written to the plane `buffer`.
    #[inline(always)]
    fn factor<'a>(
        &self,
        factor: BlendFactor,
        c: usize,
        inputs: &'a BlendInputs,
        buffer: &'a mut Plane,
    ) -> PendingFactor<'a> {
        use BlendFactor as F;
        let BlendInputs {
            source,
            second,
            stored,
        } = inputs;
        let constant = |channel: usize| {
            let encoding = self.encoding(channel);
            Plain::<1>.blend_operand(encoding, [self.constant[channel]])[0]
        };
        match factor {
            F::Zero => PendingFactor::Zero,
            F::One => PendingFactor::One,
            F::SrcAlphaSaturated if c == 3 => PendingFactor::One,
            F::SrcAlphaSaturated => {
                let mut plain = Plain::<1>;
                let encoding = self.encoding(c);
                for ((slot, source), stored) in buffer.iter_mut().zip(&source[3]).zip(&stored[3]) {
                    let rest = plain.blend_complement(encoding, [*stored]);
                    let least = plain.min([*source], rest);
                    [*slot] = plain.blend_factor(encoding, least);
                }
                PendingFactor::Value(buffer)
            }
            F::Src => PendingFactor::Value(&source[c]),
            F::OneMinusSrc => PendingFactor::Complement(&source[c]),
            F::SrcAlpha => PendingFactor::Value(&source[3]),
            F::OneMinusSrcAlpha => PendingFactor::Complement(&source[3]),
            F::Dst => PendingFactor::Value(&stored[c]),
            F::OneMinusDst => PendingFactor::Complement(&stored[c]),
            F::DstAlpha => PendingFactor::Value(&stored[3]),
            F::OneMinusDstAlpha => PendingFactor::Complement(&stored[3]),
            F::Src1 => PendingFactor::Value(&second[c]),
            F::OneMinusSrc1 => PendingFactor::Complement(&second[c]),
            F::Src1Alpha => PendingFactor::Value(&second[3]),
            F::OneMinusSrc1Alpha => PendingFactor::Complement(&second[3]),
            F::Constant | F::OneMinusConstant => {
                buffer.fill(constant(c));
                match factor {
                    F::Constant => PendingFactor::Value(buffer),
                    _ => PendingFactor::Complement(buffer),
                }
            }
            F::ConstantAlpha | F::OneMinusConstantAlpha => {
                buffer.fill(constant(3));
                match factor {
                    F::ConstantAlpha => PendingFactor::Value(buffer),
                    _ => PendingFactor::Complement(buffer),
                }
            }
        }
    }
}

/// Computes the sum or difference of two sides. Each side has its operands, its factors, and a function to
/// apply to the factors.
#[inline(always)]
fn summed(
    operation: BlendOperation,
    values: &mut [f32],
    (source, x, of_x): (&[f32], &[f32], impl Fn(f32) -> f32),
    (stored, y, of_y): (&[f32], &[f32], impl Fn(f32) -> f32),
) {
    let operands = source.iter().zip(x).zip(stored.iter().zip(y));
    macro_rules! run {
        (|$s:ident, $d:ident| $result:expr) => {
            for (value, ((s, x), (d, y))) in values.iter_mut().zip(operands) {
                let ($s, $d) = (s * of_x(*x), d * of_y(*y));
                *value = $result;
            }
        };
    }
    match operation {
        BlendOperation::Subtract => run!(|s, d| s - d),
        BlendOperation::ReverseSubtract => run!(|s, d| d - s),
        _ => run!(|s, d| s + d),
    }
}
