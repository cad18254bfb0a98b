//! Paints: how a source that is constant over a triangle changes the codes of a colour attachment.
//!
//! With a constant source, an 8-bit result is a function of the destination's codes, mostly of each channel
//! alone. The pipeline's plain arithmetic computes each function for all codes; a [linear](LinearCodes) function
//! replaces it if it gives the same result for every code. Other results have few operands that are not
//! constant, so that [affine](Affine) functions and [weights](Weights) express them without branches per
//! texel.

use super::AREA;
use super::affine::{Affine, Join, Term};
use super::bits::Bits;
use super::fragments::Fragments;
use super::image::TexelWord;
use super::lanes::{ALL, LaneBits, lanes, select};
use super::layout::{WordLayout, are_bytes};
use super::linear::{CODES, LinearCodes};
use super::plan::{PassKernels, Shading};
use super::texels::Sources;
use super::varying::TileVarying;
use super::weights::{Constants, Weights};
use crate::lanes::{LANES, LaneCodes, Real};
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::shader::KeepCondition;
use etalon_pipeline::{Arithmetic, BlendInput, Plain};
use etalon_scene::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTarget, Draw, LogicOperation,
};
use fearless_simd::Simd;

/// The encodings of four channels, and the number of channels in use.
type Channels = ([ChannelEncoding; 4], usize);

/// The most common channels.
const UNORM: Channels = ([ChannelEncoding::Unorm(8); 4], 4);

/// A function of a texel's codes, and the samples to which it is applied.
#[derive(Debug)]
pub(crate) struct TexelPaint {
    pub(crate) kernel: Kernel,
    /// The functions of the colour attachments after the first.
    pub(crate) others: Vec<Kernel>,
    /// Bit `i` is set if sample `i` is drawn.
    pub(crate) samples: u32,
}

/// A function of a texel's codes.
#[derive(Debug)]
pub(crate) enum Kernel {
    /// Keeps the codes.
    Keep,
    /// Replaces the codes by a word.
    Store(u32),
    /// Keeps some bits and replaces the others, and then inverts some of the kept bits.
    Bits(Bits),
    /// A product and a sum in each channel.
    Linear(Box<LinearCodes>),
    /// A function of each channel's code alone.
    Table(Box<[[u8; CODES]; 4]>),
    /// A sum of products of a few channels.
    Weighted(Box<Weights>),
    /// A product and a sum in each channel, or the minimum or maximum.
    Affine(Box<Affine>),
    /// Any function.
    Lanes(Box<Blending>),
    /// Replaces the codes by the words of fetched texels.
    Copy,
    /// Any function of the codes and of fetched texels.
    Varying(Box<TileVarying>),
}

/// The source, and the state that blends and stores colours.
#[derive(Clone, Debug)]
pub(crate) struct Blending {
    source: [f32; 4],
    target: ColorTarget,
    constant: [f32; 4],
    /// The logic operation, if it applies to the attachment.
    logic: Option<LogicOperation>,
    alpha_to_one: bool,
    channels: &'static [ChannelEncoding],
    layout: WordLayout,
    /// True if the second source's alpha is 1.
    second_alpha: bool,
}

impl TexelPaint {
    /// Returns the paint of a source. If `quick` is true, it makes no tables and uses the general function
    /// instead.
    #[inline(never)]
    pub(crate) fn new<S: Simd>(
        simd: S,
        draw: &Draw,
        shading: Shading,
        source: [f32; 4],
        pass: &PassKernels,
        quick: bool,
    ) -> Self {
        let state = &draw.multisample;
        let samples = pass.positions.len();
        if let Shading::Kept(limit) = shading {
            let kept = KeepCondition::unless_below([source[3]; LANES], [limit; LANES]);
            if !Faithful.kept(&kept)[0] {
                return Self::nothing();
            }
        }
        let covered = |sample: usize| {
            let covers = || Faithful.alpha_covers([source[3]; LANES], sample, samples)[0];
            Faithful.sample_drawn(state, sample, samples) && (!draw.alpha_to_coverage() || covers())
        };
        let drawn = (0..samples)
            .filter(|s| covered(*s))
            .fold(0, |bits, s| bits | 1 << s);
        let kernel = |target: &ColorTarget, channels: &'static [ChannelEncoding], obeys| {
            let blending = Blending {
                source,
                target: ColorTarget {
                    blend: draw.blend_of(target),
                    ..*target
                },
                constant: draw.blend_constant,
                logic: draw.logic.filter(|_| obeys),
                alpha_to_one: draw.alpha_to_one(),
                channels,
                layout: WordLayout::new(channels),
                second_alpha: state.alpha_to_one,
            };
            match shading {
                Shading::Texels(first, _) => blending.varying(first.channels),
                _ => blending.kernel(simd, quick),
            }
        };
        let first = draw.targets.first().filter(|_| !pass.channels.is_empty());
        let first = first.map(|target| kernel(target, pass.channels, pass.logic));
        let others = draw.targets.iter().skip(1).zip(&pass.others);
        let others: Vec<_> = others
            .map(|(target, other)| kernel(target, other.channels, other.logic))
            .collect();
        let kernel = first.unwrap_or(Kernel::Keep);
        Self {
            kernel,
            others,
            samples: drawn,
        }
    }

    /// Returns the paint of a discarded source.
    fn nothing() -> Self {
        Self {
            kernel: Kernel::Keep,
            others: Vec::new(),
            samples: 0,
        }
    }
}

impl Blending {
    fn kernel<S: Simd>(self, simd: S, quick: bool) -> Kernel {
        let written = |c: usize| self.target.write_mask & (1 << c) != 0;
        let count = self.channels.len();
        if !(0..count).any(written) {
            return Kernel::Keep;
        }
        if self.target.blend.is_none() {
            return Kernel::of_bits(self.bits(simd));
        }
        if !are_bytes(self.channels) {
            return match self.affine() {
                Some(affine) => Kernel::Affine(Box::new(affine)),
                None => Kernel::Lanes(Box::new(self)),
            };
        }
        if quick || !self.is_separable() {
            return match self.weights() {
                Some(weights) => Kernel::Weighted(Box::new(weights)),
                None => Kernel::Lanes(Box::new(self)),
            };
        }
        let mut table = Box::new([[0; CODES]; 4]);
        for first in (0..CODES).step_by(LANES) {
            let old = std::array::from_fn(|i| (first + i) as u32);
            for (table, codes) in table.iter_mut().zip(self.codes(simd, &[old; 4])) {
                for (slot, code) in table[first..].iter_mut().zip(codes) {
                    *slot = code as u8;
                }
            }
        }
        // Bytes without a channel are not read.
        table[count..].fill([0; CODES]);
        if let Some(bits) = bits(&table, &self.layout) {
            return Kernel::of_bits(bits);
        }
        let linear = simd.vectorize(
            #[inline(always)]
            || self.linear(&table),
        );
        match linear {
            Some(linear) => Kernel::Linear(Box::new(linear)),
            None => Kernel::Table(table),
        }
    }

    /// Returns the function of texels that are fetched from these channels.
    fn varying(self, fetched: &[ChannelEncoding]) -> Kernel {
        let replaces = self.target.blend.is_none() && self.logic.is_none();
        let writes_all = (0..self.channels.len()).all(|c| self.target.write_mask & (1 << c) != 0);
        // The code of an 8-bit unsigned normalized value determines the value and vice versa.
        let same = fetched == UNORM.0 && *self.channels == UNORM.0;
        if replaces && writes_all && same && !self.alpha_to_one {
            Kernel::Copy
        } else {
            Kernel::Varying(Box::new(TileVarying {
                target: self.target,
                constant: self.constant,
                logic: self.logic,
                opaque: [self.alpha_to_one, self.second_alpha],
                channels: self.channels,
                layout: self.layout,
            }))
        }
    }

    /// Returns the bit function that stores colours without blending, including logic operations.
    fn bits<S: Simd>(&self, simd: S) -> Bits {
        let texel_of = |code: u32| {
            let new = self.codes(simd, &self.channels().0.map(|e| [code & e.mask(); LANES]));
            self.layout.texel(|c| new[c][0])
        };
        Bits::new(&self.layout, texel_of(0), texel_of(u32::MAX))
    }

    /// Returns true if each channel's result depends on no other channel of the destination.
    fn is_separable(&self) -> bool {
        let Some(blend) = self.target.blend else {
            return true;
        };
        let BlendComponent {
            operation,
            src_factor,
            dst_factor,
        } = blend.color;
        use BlendFactor::{DstAlpha, OneMinusDstAlpha, SrcAlphaSaturated};
        let other = |f| matches!(f, DstAlpha | OneMinusDstAlpha | SrcAlphaSaturated);
        matches!(operation, BlendOperation::Min | BlendOperation::Max)
            || !(other(src_factor) || other(dst_factor))
    }

    /// Returns the linear function that equals a table, if one was found.
    #[inline(always)]
    fn linear(&self, table: &[[u8; CODES]; 4]) -> Option<LinearCodes> {
        let blended = |code: u32| {
            self.values(self.channels(), &[[code; LANES]; 4])
                .map(|v| v[0])
        };
        let (low, high) = (blended(0), blended(255));
        let slopes = std::array::from_fn(|c| match self.channels.get(c) {
            Some(_) if self.target.write_mask & (1 << c) == 0 => 1.0,
            Some(_) => high[c] - low[c],
            None => 0.0,
        });
        LinearCodes::fitted(table, slopes)
    }

    /// Returns the blend as weights, if weights can express it and each channel has 8 unsigned normalized
    /// bits.
    fn weights(&self) -> Option<Weights> {
        let blend = self.target.blend?;
        let unorm = self.channels.iter().all(|e| *e == UNORM.0[0]);
        let parts = [blend.color, blend.alpha];
        Weights::new(
            parts,
            &self.constants(),
            self.channels.len(),
            self.target.write_mask,
        )
        .filter(|_| unorm)
    }

    /// Returns the blend as an affine function, if an affine function can express it.
    fn affine(&self) -> Option<Affine> {
        let blend = self.target.blend?;
        let mut terms = [None; 4];
        for (c, (term, encoding)) in terms.iter_mut().zip(self.channels).enumerate() {
            if self.target.write_mask & (1 << c) != 0 {
                let component = if c == 3 { blend.alpha } else { blend.color };
                *term = Some(self.term(c, *encoding, component)?);
            }
        }
        Some(Affine { terms })
    }

    /// Returns the function of a channel, if it is affine.
    fn term(&self, c: usize, encoding: ChannelEncoding, component: BlendComponent) -> Option<Term> {
        use BlendFactor::{
            Dst, DstAlpha, One, OneMinusDst, OneMinusDstAlpha, SrcAlphaSaturated, Zero,
        };
        let BlendComponent {
            operation,
            src_factor,
            dst_factor,
        } = component;
        // If one of two numbers is 0, the plain arithmetic gives the other, with its sign.
        let alone = |operation, src_factor, dst_factor, stored: f32| {
            let component = BlendComponent {
                operation,
                src_factor,
                dst_factor,
            };
            let state = BlendState {
                color: component,
                alpha: component,
            };
            let input = BlendInput {
                dst: [[stored; LANES]; 4],
                ..self.input()
            };
            Faithful.blend(&state, self.channels().0, &input)[c][0]
        };
        let join = match operation {
            BlendOperation::Min => Join::Least,
            BlendOperation::Max => Join::Most,
            _ => Join::Sum,
        };
        let varies = |f| {
            matches!(
                f,
                Dst | OneMinusDst | DstAlpha | OneMinusDstAlpha | SrcAlphaSaturated
            )
        };
        let source_factor = if join == Join::Sum { src_factor } else { One };
        let stored_factor = if join == Join::Sum { dst_factor } else { One };
        if varies(source_factor) || varies(stored_factor) {
            return None;
        }
        let reads = stored_factor != Zero;
        let source = alone(BlendOperation::Subtract, source_factor, Zero, 0.0);
        let factor = if reads {
            alone(BlendOperation::ReverseSubtract, Zero, stored_factor, 1.0)
        } else {
            1.0
        };
        let (source, factor) = match operation {
            BlendOperation::Subtract => (source, -factor),
            BlendOperation::ReverseSubtract => (-source, factor),
            _ => (source, factor),
        };
        let finite = source.is_finite() && factor.is_finite();
        finite.then_some(Term {
            field: self.layout.fields()[c],
            encoding,
            join,
            reads,
            factor,
            source,
        })
    }

    /// Returns the inputs of a blend, with a destination of zeros.
    #[inline(always)]
    fn input(&self) -> BlendInput<Real> {
        let Constants {
            source,
            second,
            constant,
        } = self.constants();
        BlendInput {
            src: source.map(|v| [v; LANES]),
            src1: second.map(|v| [v; LANES]),
            dst: [[0.0; LANES]; 4],
            constant: constant.map(|v| [v; LANES]),
        }
    }

    /// Returns the inputs of a blend that do not depend on the destination.
    #[inline(always)]
    fn constants(&self) -> Constants {
        let mut source = self.source;
        if self.alpha_to_one {
            source[3] = 1.0;
        }
        Constants {
            source,
            second: [0.0, 0.0, 0.0, if self.second_alpha { 1.0 } else { 0.0 }],
            constant: self.constant,
        }
    }

    /// Returns the blended colours before they are stored, from the destination's codes by channel.
    #[inline(always)]
    fn values(&self, (encodings, count): Channels, codes: &[LaneCodes; 4]) -> [Real; 4] {
        let mut input = self.input();
        let Some(state) = &self.target.blend else {
            return input.src;
        };
        // A loop, because closures over arrays would not be inlined.
        input.dst[3] = [Faithful.missing_alpha(state); LANES];
        for (c, dst) in input.dst.iter_mut().enumerate().take(count) {
            *dst = Faithful.color_value(encodings[c], codes[c]);
        }
        Faithful.blend(state, encodings, &input)
    }

    #[inline(always)]
    fn channels(&self) -> Channels {
        let count = self.channels.len();
        let mut channels = [self.channels[count - 1]; 4];
        channels[..count].copy_from_slice(self.channels);
        (channels, count)
    }

    /// Returns the codes after the function, by channel. It is large, so it is not inlined.
    #[inline(never)]
    fn codes<S: Simd>(&self, simd: S, old: &[LaneCodes; 4]) -> [LaneCodes; 4] {
        simd.vectorize(
            #[inline(always)]
            || {
                // All channels have the same encoding, and the compiler knows it.
                if *self.channels == UNORM.0 {
                    self.codes_of(UNORM, old)
                } else {
                    self.codes_of(self.channels(), old)
                }
            },
        )
    }

    #[inline(always)]
    fn codes_of(&self, (encodings, count): Channels, old: &[LaneCodes; 4]) -> [LaneCodes; 4] {
        let value = self.values((encodings, count), old);
        let mut result = *old;
        for c in 0..count {
            if self.target.write_mask & (1 << c) == 0 {
                continue;
            }
            let mut new = Faithful.color_codes(encodings[c], value[c]);
            if let Some(operation) = self.logic {
                new = Plain::<LANES>.logic(encodings[c], operation, new, old[c]);
            }
            result[c] = new;
        }
        result
    }

    /// Applies the function to lanes of a sample's planes, in the lanes of a mask.
    #[inline(always)]
    fn apply<S: Simd>(&self, simd: S, planes: &mut [u32], start: usize, mask: LaneBits) {
        let fields = self.layout.fields();
        let mut old = [[0; LANES]; 4];
        for (old, field) in old.iter_mut().zip(fields) {
            let words = lanes(planes, field.word * AREA + start);
            for (code, word) in old.iter_mut().zip(words) {
                *code = field.code(*word);
            }
        }
        let new = self.codes(simd, &old);
        for word in 0..self.layout.words {
            let stored = lanes(planes, word * AREA + start);
            let mut words = *stored;
            for (field, codes) in fields.iter().zip(&new) {
                if field.word == word {
                    for (word, code) in words.iter_mut().zip(codes) {
                        *word = field.replaced(*word, *code);
                    }
                }
            }
            select(simd, stored, mask, &words);
        }
    }
}

impl Kernel {
    fn of_bits(bits: Bits) -> Self {
        match bits.stored() {
            Some(word) => Self::Store(word),
            None => Self::Bits(bits),
        }
    }

    /// Returns true if the function keeps every texel.
    pub(crate) fn keeps(&self) -> bool {
        matches!(self, Self::Keep)
    }

    /// Applies the function to fragments of a sample's planes.
    #[inline(always)]
    pub(crate) fn masked<S: Simd>(
        &self,
        simd: S,
        planes: &mut [u32],
        fragments: &Fragments,
        sources: &Sources<'_>,
    ) {
        let texels = bytemuck::cast_slice_mut::<_, TexelWord>;
        match self {
            Self::Keep => {}
            Self::Store(word) => {
                for (start, mask) in fragments.groups() {
                    select(simd, lanes(planes, start), mask, &[*word; LANES]);
                }
            }
            Self::Bits(bits) => bits.masked(simd, planes, fragments),
            Self::Linear(linear) => {
                fragments.replace(simd, planes, |new| {
                    linear.apply(simd, texels(new.as_flattened_mut()))
                });
            }
            Self::Table(table) => {
                for (start, mask) in fragments.groups() {
                    let texels: &mut [TexelWord; LANES] = bytemuck::cast_mut(lanes(planes, start));
                    for (lane, texel) in texels.iter_mut().enumerate() {
                        if mask & (1 << lane) != 0 {
                            *texel = std::array::from_fn(|c| table[c][usize::from(texel[c])]);
                        }
                    }
                }
            }
            Self::Weighted(weights) => {
                fragments.replace(simd, planes, |new| {
                    weights.apply(simd, bytemuck::cast_slice_mut(new))
                });
            }
            Self::Lanes(blending) => {
                for (start, mask) in fragments.groups() {
                    blending.apply(simd, planes, start, mask);
                }
            }
            Self::Affine(affine) => affine.masked(simd, planes, fragments),
            Self::Copy => {
                for (start, mask) in fragments.groups() {
                    select(simd, lanes(planes, start), mask, &sources.words(start));
                }
            }
            Self::Varying(varying) => varying.apply(simd, planes, fragments, sources),
        }
    }

    /// Applies the function to the first texels of a sample's planes. Their number must be a multiple of
    /// [`LANES`]. Functions of fetched texels do nothing here, since these are drawn as fragments.
    #[inline(never)]
    pub(crate) fn whole<S: Simd>(&self, simd: S, planes: &mut [u32], count: usize) {
        simd.vectorize(
            #[inline(always)]
            || self.whole_of(simd, planes, count),
        );
    }

    #[inline(always)]
    fn whole_of<S: Simd>(&self, simd: S, planes: &mut [u32], count: usize) {
        let texels = bytemuck::cast_slice_mut::<_, TexelWord>;
        match self {
            Self::Keep | Self::Copy | Self::Varying(_) => {}
            Self::Store(word) => planes[..count].fill(*word),
            Self::Bits(bits) => bits.whole(planes, count),
            Self::Linear(linear) => linear.apply(simd, texels(&mut planes[..count])),
            Self::Table(table) => {
                for texel in texels(&mut planes[..count]) {
                    *texel = std::array::from_fn(|c| table[c][usize::from(texel[c])]);
                }
            }
            Self::Weighted(weights) => {
                weights.apply(simd, texels(&mut planes[..count]).as_chunks_mut().0);
            }
            Self::Affine(affine) => affine.whole(simd, planes, count),
            Self::Lanes(blending) => {
                for start in (0..count).step_by(LANES) {
                    blending.apply(simd, planes, start, ALL);
                }
            }
        }
    }
}

/// Returns the bit function that equals the tables for all codes, if there is one.
fn bits(tables: &[[u8; CODES]; 4], layout: &WordLayout) -> Option<Bits> {
    let equal = |table: &[u8; CODES]| {
        let (and, xor) = (table[0] ^ table[CODES - 1], table[0]);
        let mut codes = table.iter().zip(0..=u8::MAX);
        codes.all(|(new, old)| *new == old & and ^ xor)
    };
    let texel_of = |code: usize| layout.texel(|c| tables[c][code].into());
    (tables.iter().all(equal)).then(|| Bits::new(layout, texel_of(0), texel_of(CODES - 1)))
}
