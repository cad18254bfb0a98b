//! Texel formats.

use crate::encoding::ChannelEncoding;
use crate::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A texture format, spelled as WebGPU spells it.
    TextureFormat: array {
        /// One unsigned normalized channel of 8 bits.
        R8Unorm = "r8unorm",
        /// Two unsigned normalized channels of 8 bits.
        Rg8Unorm = "rg8unorm",
        /// One unsigned normalized channel of 16 bits.
        R16Unorm = "r16unorm",
        /// Two unsigned normalized channels of 16 bits.
        Rg16Unorm = "rg16unorm",
        /// Four unsigned normalized channels of 16 bits.
        Rgba16Unorm = "rgba16unorm",
        /// Four unsigned normalized channels of 8 bits.
        Rgba8Unorm = "rgba8unorm",
        /// Four unsigned normalized channels of 8 bits, colour in sRGB.
        Rgba8UnormSrgb = "rgba8unorm-srgb",
        /// [`TextureFormat::Rgba8Unorm`] with red and blue exchanged in memory.
        Bgra8Unorm = "bgra8unorm",
        /// [`TextureFormat::Rgba8UnormSrgb`] with red and blue exchanged in memory.
        Bgra8UnormSrgb = "bgra8unorm-srgb",
        /// One signed normalized channel of 8 bits.
        R8Snorm = "r8snorm",
        /// Two signed normalized channels of 8 bits.
        Rg8Snorm = "rg8snorm",
        /// Four signed normalized channels of 8 bits.
        Rgba8Snorm = "rgba8snorm",
        /// Unsigned normalized channels of 10, 10, 10 and 2 bits.
        Rgb10a2Unorm = "rgb10a2unorm",
        /// Unsigned normalized channels of 5, 6 and 5 bits.
        B5g6r5Unorm = "b5g6r5unorm",
        /// Unsigned normalized channels of 5, 5, 5 and 1 bits.
        Bgr5a1Unorm = "bgr5a1unorm",
        /// Four unsigned normalized channels of 4 bits.
        Bgra4Unorm = "bgra4unorm",
        /// Unsigned floats of 11, 11 and 10 bits.
        Rg11b10Ufloat = "rg11b10ufloat",
        /// One unsigned integer of 8 bits.
        R8Uint = "r8uint",
        /// Four unsigned integers of 8 bits.
        Rgba8Uint = "rgba8uint",
        /// Unsigned integers of 10, 10, 10 and 2 bits.
        Rgb10a2Uint = "rgb10a2uint",
        /// One unsigned integer of 16 bits.
        R16Uint = "r16uint",
        /// Two unsigned integers of 16 bits.
        Rg16Uint = "rg16uint",
        /// Four unsigned integers of 16 bits.
        Rgba16Uint = "rgba16uint",
        /// One 16-bit float.
        R16Float = "r16float",
        /// Two 16-bit floats.
        Rg16Float = "rg16float",
        /// Four 16-bit floats.
        Rgba16Float = "rgba16float",
        /// One 32-bit float.
        R32Float = "r32float",
        /// Two 32-bit floats.
        Rg32Float = "rg32float",
        /// Four 32-bit floats; the suite also uses it as an exact source of values.
        Rgba32Float = "rgba32float",
        /// 16-bit unsigned normalized depth.
        Depth16Unorm = "depth16unorm",
        /// Depth of at least 24 bits: 24-bit unsigned normalized or 32-bit float, depending on the adapter.
        Depth24Plus = "depth24plus",
        /// [`TextureFormat::Depth24Plus`] with 8 bits of stencil.
        Depth24PlusStencil8 = "depth24plus-stencil8",
        /// 32-bit float depth.
        Depth32Float = "depth32float",
        /// 32-bit float depth with 8 bits of stencil.
        Depth32FloatStencil8 = "depth32float-stencil8",
        /// 8 bits of stencil and no depth.
        Stencil8 = "stencil8",
    }
}

impl TextureFormat {
    /// Returns the bytes of one texel, all aspects together and without padding (WebGPU section 26.1, texel
    /// block copy footprints; `depth24plus` as most devices store it).
    pub fn texel_bytes(self) -> u32 {
        match self {
            Self::Stencil8 => 1,
            Self::Depth16Unorm => 2,
            Self::Depth32FloatStencil8 => 5,
            _ if self.is_color() => {
                let channels = self.color_channels().iter();
                channels.map(|channel| channel.bits()).sum::<u32>() / 8
            }
            _ => 4,
        }
    }

    /// Returns true if texels are colours.
    pub fn is_color(self) -> bool {
        !self.has_depth() && !self.has_stencil()
    }

    /// Returns true if texels are colours with alpha and not integers.
    pub fn has_alpha(self) -> bool {
        self.color_channels().len() == 4 && !self.is_integer()
    }

    /// Returns true if texels are integers, which shaders write as integers and which cannot be blended.
    pub fn is_integer(self) -> bool {
        matches!(
            self.color_channels().first(),
            Some(ChannelEncoding::Uint(_))
        )
    }

    /// Returns true if texels are signed normalized colours.
    pub fn is_snorm(self) -> bool {
        matches!(
            self.color_channels().first(),
            Some(ChannelEncoding::Snorm(_))
        )
    }

    /// Returns true if texels are colours that are converted to and from sRGB.
    pub fn is_srgb(self) -> bool {
        self.color_channels().first() == Some(&ChannelEncoding::Srgb8)
    }

    /// Returns true if every device that samples colours of this format can filter them: not integers and 32-bit floats.
    pub fn is_filterable(self) -> bool {
        let first = self.color_channels().first();
        !matches!(
            first,
            None | Some(ChannelEncoding::Uint(_) | ChannelEncoding::Float32)
        )
    }

    /// Returns true if the format has a depth aspect.
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

    /// Returns true if the format has a stencil aspect.
    pub fn has_stencil(self) -> bool {
        matches!(
            self,
            Self::Depth24PlusStencil8 | Self::Depth32FloatStencil8 | Self::Stencil8
        )
    }

    /// Returns the format's aspects, depth before stencil.
    pub fn aspects(self) -> &'static [Aspect] {
        match (self.has_depth(), self.has_stencil()) {
            (false, false) => &[Aspect::Color],
            (true, false) => &[Aspect::Depth],
            (false, true) => &[Aspect::Stencil],
            (true, true) => &[Aspect::Depth, Aspect::Stencil],
        }
    }

    /// Returns the encodings of a colour format's channels in the order red, green, blue, alpha; empty for
    /// depth and stencil formats, whose depth encoding depends on the adapter.
    pub fn color_channels(self) -> &'static [ChannelEncoding] {
        use ChannelEncoding::{Float16, Float32, Snorm, Srgb8, Ufloat, Uint, Unorm};
        match self {
            Self::R8Unorm => &[Unorm(8)],
            Self::Rg8Unorm => &[Unorm(8); 2],
            Self::Rgba8Unorm | Self::Bgra8Unorm => &[Unorm(8); 4],
            Self::R16Unorm => &[Unorm(16)],
            Self::Rg16Unorm => &[Unorm(16); 2],
            Self::Rgba16Unorm => &[Unorm(16); 4],
            Self::Rgba8UnormSrgb | Self::Bgra8UnormSrgb => &[Srgb8, Srgb8, Srgb8, Unorm(8)],
            Self::R8Snorm => &[Snorm(8)],
            Self::Rg8Snorm => &[Snorm(8); 2],
            Self::Rgba8Snorm => &[Snorm(8); 4],
            Self::Rgb10a2Unorm => &[Unorm(10), Unorm(10), Unorm(10), Unorm(2)],
            Self::B5g6r5Unorm => &[Unorm(5), Unorm(6), Unorm(5)],
            Self::Bgr5a1Unorm => &[Unorm(5), Unorm(5), Unorm(5), Unorm(1)],
            Self::Bgra4Unorm => &[Unorm(4); 4],
            Self::Rg11b10Ufloat => &[Ufloat(6), Ufloat(6), Ufloat(5)],
            Self::R8Uint => &[Uint(8)],
            Self::Rgba8Uint => &[Uint(8); 4],
            Self::Rgb10a2Uint => &[Uint(10), Uint(10), Uint(10), Uint(2)],
            Self::R16Uint => &[Uint(16)],
            Self::Rg16Uint => &[Uint(16); 2],
            Self::Rgba16Uint => &[Uint(16); 4],
            Self::R16Float => &[Float16],
            Self::Rg16Float => &[Float16; 2],
            Self::Rgba16Float => &[Float16; 4],
            Self::R32Float => &[Float32],
            Self::Rg32Float => &[Float32; 2],
            Self::Rgba32Float => &[Float32; 4],
            _ => &[],
        }
    }

    /// Returns the depth encodings that the format's definition permits; empty for formats without depth.
    /// WebGPU section 26.1 leaves `depth24plus` open between two.
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

state_enum! {
    /// The part of a texel that one image of a frame contains.
    Aspect {
        /// Colour channels.
        Color = "color",
        /// Depth.
        Depth = "depth",
        /// Stencil.
        Stencil = "stencil",
    }
}

impl Aspect {
    /// Returns the name of a channel: `red` for a colour, the aspect's name otherwise.
    pub fn channel(self, channel: usize) -> &'static str {
        match self {
            Self::Color => ["red", "green", "blue", "alpha"][channel.min(3)],
            other => other.name(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_the_serialized_names() {
        for format in TextureFormat::ALL {
            let json = format!("{format:?}").to_lowercase();
            assert_eq!(format.name().replace('-', ""), json);
        }
    }
}
