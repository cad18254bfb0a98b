//! Texel formats and the encodings of their channels.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A texture format, spelled as WebGPU spells it.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum TextureFormat {
    /// Four unsigned normalized channels of 8 bits.
    Rgba8Unorm,
    /// Four 32-bit floats; the suite uses it as an exact source of values.
    Rgba32Float,
    /// 16-bit unsigned normalized depth.
    Depth16Unorm,
    /// Depth of at least 24 bits: 24-bit unsigned normalized or 32-bit float, as the adapter has it.
    Depth24Plus,
    /// [`TextureFormat::Depth24Plus`] with 8 bits of stencil.
    #[serde(rename = "depth24plus-stencil8")]
    Depth24PlusStencil8,
    /// 32-bit float depth.
    Depth32Float,
    /// 32-bit float depth with 8 bits of stencil.
    #[serde(rename = "depth32float-stencil8")]
    Depth32FloatStencil8,
    /// 8 bits of stencil and no depth.
    Stencil8,
}

impl TextureFormat {
    /// Every format, in declaration order.
    pub const ALL: [Self; 8] = [
        Self::Rgba8Unorm,
        Self::Rgba32Float,
        Self::Depth16Unorm,
        Self::Depth24Plus,
        Self::Depth24PlusStencil8,
        Self::Depth32Float,
        Self::Depth32FloatStencil8,
        Self::Stencil8,
    ];

    /// WebGPU's name of the format.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rgba8Unorm => "rgba8unorm",
            Self::Rgba32Float => "rgba32float",
            Self::Depth16Unorm => "depth16unorm",
            Self::Depth24Plus => "depth24plus",
            Self::Depth24PlusStencil8 => "depth24plus-stencil8",
            Self::Depth32Float => "depth32float",
            Self::Depth32FloatStencil8 => "depth32float-stencil8",
            Self::Stencil8 => "stencil8",
        }
    }

    /// Whether texels are colours.
    pub fn is_color(self) -> bool {
        !self.has_depth() && !self.has_stencil()
    }

    /// Whether the format has a depth aspect.
    pub fn has_depth(self) -> bool {
        matches!(
            self,
            Self::Depth16Unorm
                | Self::Depth24Plus
                | Self::Depth24PlusStencil8
                | Self::Depth32Float
                | Self::Depth32FloatStencil8
        )
    }

    /// Whether the format has a stencil aspect.
    pub fn has_stencil(self) -> bool {
        matches!(
            self,
            Self::Depth24PlusStencil8 | Self::Depth32FloatStencil8 | Self::Stencil8
        )
    }

    /// The format's aspects, depth before stencil.
    pub fn aspects(self) -> &'static [Aspect] {
        match (self.has_depth(), self.has_stencil()) {
            (false, false) => &[Aspect::Color],
            (true, false) => &[Aspect::Depth],
            (false, true) => &[Aspect::Stencil],
            (true, true) => &[Aspect::Depth, Aspect::Stencil],
        }
    }

    /// The encodings of a colour format's channels in the order red, green, blue, alpha; empty for
    /// depth and stencil formats, whose depth encoding only the adapter knows.
    pub fn color_channels(self) -> &'static [ChannelEncoding] {
        match self {
            Self::Rgba8Unorm => &[ChannelEncoding::Unorm(8); 4],
            Self::Rgba32Float => &[ChannelEncoding::Float32; 4],
            _ => &[],
        }
    }

    /// The depth encodings that the format's definition permits; empty where it has no depth.
    /// WebGPU section 26.1 leaves `depth24plus` open between the two.
    pub fn depth_encodings(self) -> &'static [ChannelEncoding] {
        match self {
            Self::Depth16Unorm => &[ChannelEncoding::Unorm(16)],
            Self::Depth24Plus | Self::Depth24PlusStencil8 => {
                &[ChannelEncoding::Unorm(24), ChannelEncoding::Float32]
            }
            Self::Depth32Float | Self::Depth32FloatStencil8 => &[ChannelEncoding::Float32],
            _ => &[],
        }
    }
}

impl fmt::Display for TextureFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The part of a texel that one image of a frame holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Aspect {
    /// Colour channels.
    Color,
    /// Depth.
    Depth,
    /// Stencil.
    Stencil,
}

impl Aspect {
    /// The aspect's name in ids, records and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Stencil => "stencil",
        }
    }
}

impl fmt::Display for Aspect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How one channel's code stands for a value.
///
/// A *code* is the channel's bit pattern in the low bits of a `u32`. Its *order* is an integer that
/// grows with the value the code stands for, one step per neighbouring code, so that intervals of
/// values are intervals of integers and distances are counted in codes (ULPs for floats).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChannelEncoding {
    /// Unsigned normalized integer of so many bits: code `c` stands for `c / (2^bits - 1)`.
    Unorm(u8),
    /// Unsigned integer of so many bits.
    Uint(u8),
    /// IEEE 754 binary32.
    Float32,
}

impl ChannelEncoding {
    /// The largest order of any finite code.
    pub fn max_order(self) -> i64 {
        match self {
            Self::Unorm(bits) | Self::Uint(bits) => (1_i64 << bits) - 1,
            Self::Float32 => i64::from(f32::MAX.to_bits()),
        }
    }

    /// The smallest order of any finite code.
    pub fn min_order(self) -> i64 {
        match self {
            Self::Unorm(_) | Self::Uint(_) => 0,
            Self::Float32 => -self.max_order(),
        }
    }

    /// The order of a code. Both float zeros have order 0: the specifications leave the sign of
    /// zero open (SPIR-V's default float controls; OpenGL 4.6, 2.3.4.1).
    pub fn order_of_code(self, code: u32) -> i64 {
        match self {
            Self::Unorm(_) | Self::Uint(_) => i64::from(code),
            Self::Float32 => {
                let magnitude = i64::from(code & 0x7fff_ffff);
                if code >> 31 == 0 {
                    magnitude
                } else {
                    -magnitude
                }
            }
        }
    }

    /// The code of an order, the inverse of [`ChannelEncoding::order_of_code`].
    pub fn code_of_order(self, order: i64) -> u32 {
        let magnitude = u32::try_from(order.unsigned_abs()).unwrap_or(u32::MAX);
        match self {
            Self::Unorm(_) | Self::Uint(_) => magnitude,
            Self::Float32 if order < 0 => magnitude | 0x8000_0000,
            Self::Float32 => magnitude,
        }
    }

    /// The real value that the code of this order stands for.
    pub fn value_of_order(self, order: i64) -> f64 {
        match self {
            Self::Unorm(_) => order as f64 / self.max_order() as f64,
            Self::Uint(_) => order as f64,
            Self::Float32 => f64::from(f32::from_bits(self.code_of_order(order))),
        }
    }

    /// The code whose value is nearest to a real number; the nearest end where it is out of range.
    pub fn nearest_code(self, value: f64) -> u32 {
        match self {
            Self::Unorm(_) | Self::Uint(_) => {
                let scale = match self {
                    Self::Unorm(_) => self.max_order() as f64,
                    _ => 1.0,
                };
                let most = self.max_order() as f64;
                (value * scale).round().clamp(0.0, most) as u32
            }
            Self::Float32 => (value as f32).to_bits(),
        }
    }

    /// Whether the code is a NaN.
    pub fn is_nan(self, code: u32) -> bool {
        self == Self::Float32 && f32::from_bits(code).is_nan()
    }
}

impl fmt::Display for ChannelEncoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unorm(bits) => write!(f, "{bits}-bit unorm"),
            Self::Uint(bits) => write!(f, "{bits}-bit uint"),
            Self::Float32 => f.write_str("32-bit float"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn float_order_is_monotone_and_inverts() {
        let e = ChannelEncoding::Float32;
        let values = [-f32::MAX, -1.0, -1e-40, 0.0, 1e-45, 0.5, 1.0, f32::MAX];
        let orders: Vec<i64> = values
            .iter()
            .map(|v| e.order_of_code(v.to_bits()))
            .collect();
        assert!(orders.is_sorted());
        for (value, order) in values.iter().zip(orders) {
            assert_eq!(e.value_of_order(order), f64::from(*value));
        }
    }

    #[test]
    fn names_are_the_serialized_names() {
        for format in TextureFormat::ALL {
            let json = format!("{format:?}").to_lowercase();
            assert_eq!(format.name().replace('-', ""), json);
        }
    }
}
