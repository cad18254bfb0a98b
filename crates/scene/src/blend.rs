//! Blending, logic operations and write masks.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A factor of a blend equation.
    BlendFactor {
        /// 0.
        Zero = "zero",
        /// 1.
        One = "one",
        /// The source, channel by channel.
        Src = "src",
        /// 1 minus the source.
        OneMinusSrc = "one-minus-src",
        /// The source's alpha.
        SrcAlpha = "src-alpha",
        /// 1 minus the source's alpha.
        OneMinusSrcAlpha = "one-minus-src-alpha",
        /// The destination, channel by channel.
        Dst = "dst",
        /// 1 minus the destination.
        OneMinusDst = "one-minus-dst",
        /// The destination's alpha.
        DstAlpha = "dst-alpha",
        /// 1 minus the destination's alpha.
        OneMinusDstAlpha = "one-minus-dst-alpha",
        /// min(source alpha, 1 - destination alpha); 1 for alpha.
        SrcAlphaSaturated = "src-alpha-saturated",
        /// The blend constant, channel by channel.
        Constant = "constant",
        /// 1 minus the blend constant.
        OneMinusConstant = "one-minus-constant",
        /// The blend constant's alpha.
        ConstantAlpha = "constant-alpha",
        /// 1 minus the blend constant's alpha.
        OneMinusConstantAlpha = "one-minus-constant-alpha",
        /// The second source, channel by channel.
        Src1 = "src1",
        /// 1 minus the second source.
        OneMinusSrc1 = "one-minus-src1",
        /// The second source's alpha.
        Src1Alpha = "src1-alpha",
        /// 1 minus the second source's alpha.
        OneMinusSrc1Alpha = "one-minus-src1-alpha",
    }
}

impl BlendFactor {
    /// Returns true if the factor comes from the second source.
    pub fn is_second_source(self) -> bool {
        matches!(
            self,
            Self::Src1 | Self::OneMinusSrc1 | Self::Src1Alpha | Self::OneMinusSrc1Alpha
        )
    }

    /// Returns true if the factor comes from the blend constant.
    pub fn is_constant(self) -> bool {
        matches!(
            self,
            Self::Constant
                | Self::OneMinusConstant
                | Self::ConstantAlpha
                | Self::OneMinusConstantAlpha
        )
    }
}

state_enum! {
    /// The operation of a blend equation on its two weighted sides.
    BlendOperation {
        /// Source plus destination.
        Add = "add",
        /// Source minus destination.
        Subtract = "subtract",
        /// Destination minus source.
        ReverseSubtract = "reverse-subtract",
        /// The smaller of the two, factors ignored.
        Min = "min",
        /// The larger of the two, factors ignored.
        Max = "max",
    }
}

/// One blend equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendComponent {
    /// The operation that combines source and destination; `min` and `max` ignore the factors.
    pub operation: BlendOperation,
    /// The factor of the shader's output.
    pub src_factor: BlendFactor,
    /// The factor of the attachment's value.
    pub dst_factor: BlendFactor,
}

/// Blending of one attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendState {
    /// Red, green and blue.
    pub color: BlendComponent,
    /// Alpha, which has operation and factors of its own.
    pub alpha: BlendComponent,
}

state_enum! {
    /// A separable mode of advanced blending: a function f of source and destination, each divided by its
    /// alpha. Source and destination are premultiplied. In the part of the pixel that only one of them
    /// covers, that one counts in full.
    AdvancedBlend {
        /// Source times destination.
        Multiply = "multiply",
        /// Inverts source and destination, multiplies them, and inverts the product.
        Screen = "screen",
        /// Multiply or screen at double strength, depending on the destination.
        Overlay = "overlay",
        /// The smaller of the two.
        Darken = "darken",
        /// The larger of the two.
        Lighten = "lighten",
        /// The destination divided by the inverted source.
        ColorDodge = "color-dodge",
        /// The inverted destination divided by the source, inverted.
        ColorBurn = "color-burn",
        /// Multiply or screen at double strength, depending on the source.
        HardLight = "hard-light",
        /// The destination darkened or lightened, depending on the source.
        SoftLight = "soft-light",
        /// The distance between the two.
        Difference = "difference",
        /// Like `difference`, with less contrast.
        Exclusion = "exclusion",
    }
}

/// The state of a draw for one colour attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct ColorTarget {
    /// Blending; `None` turns it off.
    pub blend: Option<BlendState>,
    /// Advanced blending, in place of `blend`; `None` turns it off.
    pub advanced: Option<AdvancedBlend>,
    /// The mask of written channels: bit 0 is red, bit 3 alpha.
    pub write_mask: u8,
}

impl ColorTarget {
    /// Returns true if the stored colour depends on the destination's colour.
    pub fn blends(&self) -> bool {
        self.blend.is_some() || self.advanced.is_some()
    }
}

impl Default for ColorTarget {
    /// Returns a target that writes all channels without blending.
    fn default() -> Self {
        Self {
            blend: None,
            advanced: None,
            write_mask: 0b1111,
        }
    }
}

state_enum! {
    /// A logic operation on the bits of source `s` and destination `d`.
    LogicOperation {
        /// 0.
        Clear = "clear",
        /// `s & d`.
        And = "and",
        /// `s & !d`.
        AndReverse = "and-reverse",
        /// `s`.
        Copy = "copy",
        /// `!s & d`.
        AndInverted = "and-inverted",
        /// `d`.
        Noop = "noop",
        /// `s ^ d`.
        Xor = "xor",
        /// `s | d`.
        Or = "or",
        /// `!(s | d)`.
        Nor = "nor",
        /// `!(s ^ d)`.
        Equivalent = "equivalent",
        /// `!d`.
        Invert = "invert",
        /// `s | !d`.
        OrReverse = "or-reverse",
        /// `!s`.
        CopyInverted = "copy-inverted",
        /// `!s | d`.
        OrInverted = "or-inverted",
        /// `!(s & d)`.
        Nand = "nand",
        /// All bits.
        Set = "set",
    }
}
