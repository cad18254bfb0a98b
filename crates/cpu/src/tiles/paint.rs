//! Paints: what a source that is constant over a triangle makes of a colour attachment's codes.
//!
//! With a constant source an 8-bit result is a function of the destination's codes, mostly channel by channel. Each
//! function is made by the pipeline's plain arithmetic, over all codes; a linear one is used where it is equal to
//! the function for every one of them.

use super::image::{Texel, word};
use super::lanes::{Lane, select_texels};
use crate::lanes::LANES;
use crate::steps::{Faithful, Steps};
use etalon_frame::ChannelEncoding;
use etalon_pipeline::{Arithmetic, BlendInput, Plain};
use etalon_scene::{
    BlendComponent, BlendFactor, BlendOperation, ColorTarget, Draw, LogicOperation,
};

/// The number of codes of a channel.
const CODES: usize = 256;

/// The bytes of so many texels as there are lanes.
const BYTES: usize = 4 * LANES;

/// A function of a texel's codes, and the samples that it is applied to.
#[derive(Debug)]
pub(crate) struct Paint {
    pub(crate) kernel: Kernel,
    /// Bit `i` is set if sample `i` is drawn.
    pub(crate) samples: u32,
}

/// A function of a texel's codes.
#[derive(Debug)]
pub(crate) enum Kernel {
    /// Leaves them.
    Keep,
    /// Replaces them.
    Store(Texel),
    /// Replaces the channels whose bits are not kept.
    Masked { value: Texel, keep: Texel },
    /// A product and a sum in each channel.
    Linear(Box<Linear>),
    /// A function of each channel's own code.
    Table(Box<[[u8; CODES]; 4]>),
    /// Any function.
    Lanes(Box<Blending>),
}

/// Multiplies codes by 16-bit fractions, adds, subtracts, both saturating, and keeps the upper byte; byte by byte
/// of neighbouring texels.
#[derive(Debug)]
pub(crate) struct Linear {
    factor: [u16; BYTES],
    plus: [u16; BYTES],
    minus: [u16; BYTES],
}

/// The state that colours are blended and stored by, with the source.
#[derive(Clone, Debug)]
pub(crate) struct Blending {
    source: [f32; 4],
    target: ColorTarget,
    constant: [f32; 4],
    logic: Option<LogicOperation>,
    obeys: bool,
    alpha_to_one: bool,
    channels: &'static [ChannelEncoding],
    /// The second source's alpha is 1.
    second_alpha: bool,
}

impl Paint {
    /// Returns the paint of a source; with a function of any kind where no other is to be made.
    #[inline(always)]
    pub(crate) fn new(
        draw: &Draw,
        source: [f32; 4],
        channels: &'static [ChannelEncoding],
        obeys: bool,
        samples: usize,
        quick: bool,
    ) -> Self {
        let state = &draw.multisample;
        let covered = |sample: usize| {
            let covers = || Faithful.alpha_covers([source[3]; LANES], sample, samples)[0];
            Faithful.sample_drawn(state, sample, samples) && (!draw.alpha_to_coverage() || covers())
        };
        let drawn = (0..samples)
            .filter(|s| covered(*s))
            .fold(0, |bits, s| bits | 1 << s);
        let kernel = match draw.targets.first().filter(|_| !channels.is_empty()) {
            None => Kernel::Keep,
            Some(target) => Blending {
                source,
                target: *target,
                constant: draw.blend_constant,
                logic: draw.logic,
                obeys,
                alpha_to_one: draw.alpha_to_one(),
                channels,
                second_alpha: state.alpha_to_one,
            }
            .kernel(quick),
        };
        Self {
            kernel,
            samples: drawn,
        }
    }
}

impl Blending {
    #[inline(always)]
    fn kernel(self, quick: bool) -> Kernel {
        let written = |c: usize| self.target.write_mask & (1 << c) != 0;
        let count = self.channels.len();
        if !(0..count).any(written) {
            return Kernel::Keep;
        }
        if self.target.blend.is_none() && (self.logic.is_none() || !self.obeys) {
            let [value, ..] = self.applied(&[[0; 4]; LANES]);
            let keep = std::array::from_fn(|c| if c < count && !written(c) { 0xff } else { 0 });
            return match keep {
                [0, 0, 0, 0] => Kernel::Store(value),
                keep => Kernel::Masked { value, keep },
            };
        }
        if quick || !self.is_separable() {
            return Kernel::Lanes(Box::new(self));
        }
        let mut table = Box::new([[0; CODES]; 4]);
        for first in (0..CODES).step_by(LANES) {
            let mut codes = [[0; 4]; LANES];
            for (i, texel) in codes.iter_mut().enumerate() {
                *texel = [(first + i) as u8; 4];
            }
            for (i, texel) in self.applied(&codes).into_iter().enumerate() {
                for (table, code) in table.iter_mut().zip(texel) {
                    table[first + i] = code;
                }
            }
        }
        match self.linear(&table) {
            Some(linear) => Kernel::Linear(Box::new(linear)),
            None => Kernel::Table(table),
        }
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

    /// Returns the linear function that is equal to a table, if one was found.
    #[inline(always)]
    fn linear(&self, table: &[[u8; CODES]; 4]) -> Option<Linear> {
        let blended = |code: u8| self.values(&[[code; 4]; LANES]).map(|v| v[0]);
        let (low, high) = (blended(0), blended(255));
        let mut found = [(0, 0, 0); 4];
        for (c, found) in found.iter_mut().enumerate() {
            let slope = match self.channels.get(c) {
                Some(_) if self.target.write_mask & (1 << c) == 0 => 1.0,
                Some(_) => high[c] - low[c],
                None => 0.0,
            };
            *found = fitted(&table[c], slope)?;
        }
        let byte = |part: fn(&(u16, u16, u16)) -> u16| std::array::from_fn(|i| part(&found[i % 4]));
        Some(Linear {
            factor: byte(|f| f.0),
            plus: byte(|f| f.1),
            minus: byte(|f| f.2),
        })
    }

    /// Returns blended colours before they are stored.
    #[inline(always)]
    fn values(&self, texels: &[Texel; LANES]) -> [[f32; LANES]; 4] {
        let mut color = self.source;
        if self.alpha_to_one {
            color[3] = 1.0;
        }
        let color = color.map(|v| [v; LANES]);
        let Some(state) = &self.target.blend else {
            return color;
        };
        let encodings = self.encodings();
        let missing = Faithful.missing_alpha(state);
        // Loops, since closures of arrays would not be inlined.
        let mut dst = [[0.0; LANES]; 4];
        dst[3] = [missing; LANES];
        for (c, dst) in dst.iter_mut().enumerate().take(self.channels.len()) {
            *dst = Faithful.color_value(encodings[c], codes(texels, c));
        }
        let mut src1 = [[0.0; LANES]; 4];
        if self.second_alpha {
            src1[3] = [1.0; LANES];
        }
        let input = BlendInput {
            src: color,
            src1,
            dst,
            constant: self.constant.map(|v| [v; LANES]),
        };
        Faithful.blend(state, encodings, &input)
    }

    #[inline(always)]
    fn encodings(&self) -> [ChannelEncoding; 4] {
        let last = self.channels.len() - 1;
        std::array::from_fn(|c| self.channels[c.min(last)])
    }

    /// Returns texels after the function.
    #[inline(always)]
    fn applied(&self, texels: &[Texel; LANES]) -> [Texel; LANES] {
        let value = self.values(texels);
        let mut result = *texels;
        for (c, encoding) in self.channels.iter().enumerate() {
            if self.target.write_mask & (1 << c) == 0 {
                continue;
            }
            let mut new = Faithful.color_codes(*encoding, value[c]);
            if let Some(operation) = self.logic.filter(|_| self.obeys) {
                new = Plain::<LANES>.logic(*encoding, operation, new, codes(texels, c));
            }
            for (texel, code) in result.iter_mut().zip(new) {
                texel[c] = code as u8;
            }
        }
        result
    }
}

/// Returns the codes of one channel.
#[inline(always)]
fn codes(texels: &[Texel; LANES], channel: usize) -> [u32; LANES] {
    let mut codes = [0; LANES];
    for (code, texel) in codes.iter_mut().zip(texels) {
        *code = u32::from(texel[channel]);
    }
    codes
}

/// Returns factor, summand and subtrahend of a linear function that is equal to a table in all codes, if there is
/// one near a slope.
#[inline(always)]
fn fitted(table: &[u8; CODES], slope: f32) -> Option<(u16, u16, u16)> {
    let near = (f64::from(slope) * 65536.0).round();
    if !(0.0..=65537.0).contains(&near) {
        return None;
    }
    [0, -1, 1, -2, 2, -4, 4, -8, 8].into_iter().find_map(|off| {
        let factor = (near as i64 + off).clamp(0, 65535) as u16;
        let (mut least, mut most) = (-65535, 65535);
        for (code, due) in table.iter().enumerate() {
            let (product, due) = (i32::from(product(code as u8, factor)), i32::from(*due));
            if due > 0 {
                least = least.max(256 * due - product);
            }
            if due < 255 {
                most = most.min(256 * due + 255 - product);
            }
        }
        let sum = (least + most).div_euclid(2);
        let plus = sum.clamp(0, 65535) as u16;
        let minus = (-sum).clamp(0, 65535) as u16;
        let mut all = (0..=255).zip(table);
        let equal = all.all(|(code, due)| linear(code, factor, plus, minus) == *due);
        equal.then_some((factor, plus, minus))
    })
}

/// Returns 256 times a code times a 16-bit fraction.
#[inline(always)]
fn product(code: u8, factor: u16) -> u16 {
    ((u32::from(u16::from(code) << 8) * u32::from(factor)) >> 16) as u16
}

/// Returns a code after a linear function.
#[inline(always)]
fn linear(code: u8, factor: u16, plus: u16, minus: u16) -> u8 {
    let sum = product(code, factor).saturating_add(plus);
    (sum.saturating_sub(minus) >> 8) as u8
}

impl Linear {
    #[inline(always)]
    fn applied(&self, bytes: &[u8; BYTES]) -> [u8; BYTES] {
        let mut result = [0; BYTES];
        for i in 0..BYTES {
            result[i] = linear(bytes[i], self.factor[i], self.plus[i], self.minus[i]);
        }
        result
    }
}

impl Kernel {
    /// Applies the function to the texels that a mask holds.
    #[inline(always)]
    pub(crate) fn masked(&self, words: &mut [u32; LANES], mask: &[Lane; LANES]) {
        let texels: &mut [Texel; LANES] = bytemuck::cast_mut(words);
        match self {
            Self::Keep => {}
            Self::Store(value) => select_texels(texels, mask, &[*value; LANES]),
            Self::Masked { value, keep } => {
                let new = masked(texels, *value, *keep);
                select_texels(texels, mask, &new);
            }
            Self::Linear(linear) => {
                let new = linear.applied(flat(texels));
                let (new, _) = new.as_chunks::<4>();
                if let Ok(new) = new.try_into() {
                    select_texels(texels, mask, new);
                }
            }
            Self::Table(table) => {
                for (texel, covered) in texels.iter_mut().zip(mask) {
                    if *covered != 0 {
                        *texel = std::array::from_fn(|c| table[c][usize::from(texel[c])]);
                    }
                }
            }
            Self::Lanes(blending) => {
                let new = blending.applied(texels);
                select_texels(texels, mask, &new);
            }
        }
    }

    /// Applies the function to all of some texels, whose number is a multiple of [`LANES`].
    #[inline(always)]
    pub(crate) fn whole(&self, words: &mut [u32]) {
        if let Self::Store(value) = self {
            words.fill(word(*value));
            return;
        }
        let texels: &mut [Texel] = bytemuck::cast_slice_mut(words);
        match self {
            Self::Keep | Self::Store(_) => {}
            Self::Masked { value, keep } => {
                for chunk in texels.as_chunks_mut::<LANES>().0 {
                    *chunk = masked(chunk, *value, *keep);
                }
            }
            Self::Linear(linear) => {
                for chunk in texels.as_flattened_mut().as_chunks_mut::<BYTES>().0 {
                    *chunk = linear.applied(chunk);
                }
            }
            Self::Table(table) => {
                for texel in texels {
                    *texel = std::array::from_fn(|c| table[c][usize::from(texel[c])]);
                }
            }
            Self::Lanes(blending) => {
                for chunk in texels.as_chunks_mut::<LANES>().0 {
                    *chunk = blending.applied(chunk);
                }
            }
        }
    }
}

/// Returns the bytes of texels.
#[inline(always)]
fn flat(texels: &[Texel; LANES]) -> &[u8; BYTES] {
    texels.as_flattened().try_into().unwrap_or(&[0; BYTES])
}

/// Returns texels with a value in the bits that are not kept.
#[inline(always)]
fn masked(texels: &[Texel; LANES], value: Texel, keep: Texel) -> [Texel; LANES] {
    let [value, keep] = [value, keep].map(u32::from_ne_bytes);
    texels.map(|t| (u32::from_ne_bytes(t) & keep | value & !keep).to_ne_bytes())
}
