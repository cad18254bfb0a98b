//! Pipeline state, spelled as WebGPU spells it and extended where OpenGL and Vulkan have more.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A depth or stencil comparison: incoming (reference) value on the left, stored on the right.
    CompareFunction {
        /// Never true.
        Never = "never",
        /// Incoming below stored.
        Less = "less",
        /// Incoming equals stored.
        Equal = "equal",
        /// Incoming not above stored.
        LessEqual = "less-equal",
        /// Incoming above stored.
        Greater = "greater",
        /// Incoming differs from stored.
        NotEqual = "not-equal",
        /// Incoming not below stored.
        GreaterEqual = "greater-equal",
        /// Always true.
        Always = "always",
    }
}

state_enum! {
    /// What happens to a stored stencil value.
    StencilOperation {
        /// Unchanged.
        Keep = "keep",
        /// Set to 0.
        Zero = "zero",
        /// Set to the reference.
        Replace = "replace",
        /// All bits inverted.
        Invert = "invert",
        /// Plus one, held at the largest value.
        IncrementClamp = "increment-clamp",
        /// Minus one, held at 0.
        DecrementClamp = "decrement-clamp",
        /// Plus one, the largest value becoming 0.
        IncrementWrap = "increment-wrap",
        /// Minus one, 0 becoming the largest value.
        DecrementWrap = "decrement-wrap",
    }
}

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

state_enum! {
    /// How the two weighted sides of a blend equation are joined.
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

state_enum! {
    /// What a logic operation makes of the bits of source `s` and destination `d`.
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

state_enum! {
    /// What becomes of a polygon.
    PolygonMode {
        /// Its inside.
        Fill = "fill",
        /// Its edges, one texel wide.
        Line = "line",
    }
}

state_enum! {
    /// Which faces are culled.
    CullMode {
        /// None.
        None = "none",
        /// Front faces.
        Front = "front",
        /// Back faces.
        Back = "back",
        /// Both; points and lines remain.
        FrontAndBack = "front-and-back",
    }
}

state_enum! {
    /// Which winding is a front face.
    FrontFace {
        /// Counter-clockwise.
        Ccw = "ccw",
        /// Clockwise.
        Cw = "cw",
    }
}

state_enum! {
    /// How vertices become primitives.
    PrimitiveTopology {
        /// Each vertex a point of one texel.
        PointList = "point-list",
        /// Two vertices a line one texel wide.
        LineList = "line-list",
        /// A line from each vertex to the next.
        LineStrip = "line-strip",
        /// Three vertices a triangle.
        TriangleList = "triangle-list",
        /// Each vertex after the second makes a triangle with the two before it.
        TriangleStrip = "triangle-strip",
        /// Each vertex after the second makes a triangle with the first and the one before it.
        TriangleFan = "triangle-fan",
    }
}

state_enum! {
    /// When depth bounds, stencil and depth tests happen: before or after the fragment shader.
    EarlyTests {
        /// As the API says of the shader: in effect afterwards.
        Implicit = "implicit",
        /// Before, whatever the shader does.
        Forced = "forced",
        /// In effect afterwards; the shader promises a depth not below the fragment's own.
        GreaterEqual = "greater-equal",
        /// In effect afterwards; the shader promises a depth not above the fragment's own.
        LessEqual = "less-equal",
        /// In effect afterwards; the shader promises to write the fragment's own depth.
        Unchanged = "unchanged",
    }
}

impl EarlyTests {
    /// The word of WGSL's `early_depth_test` attribute; `None` where the shader has none.
    pub fn attribute(self) -> Option<&'static str> {
        match self {
            Self::Implicit => None,
            Self::Forced => Some("force"),
            Self::GreaterEqual => Some("greater_equal"),
            Self::LessEqual => Some("less_equal"),
            Self::Unchanged => Some("unchanged"),
        }
    }

    /// Whether the shader promises something of the depth that it writes.
    pub fn is_conservative(self) -> bool {
        !matches!(self, Self::Implicit | Self::Forced)
    }
}

state_enum! {
    /// How a sampler makes a value of the texels around a coordinate.
    FilterMode {
        /// The nearest texel.
        Nearest = "nearest",
        /// The weighted average of the four texels around it.
        Linear = "linear",
    }
}

state_enum! {
    /// What a texture coordinate beyond the texture means.
    AddressMode {
        /// The outermost texel.
        ClampToEdge = "clamp-to-edge",
        /// The texture again.
        Repeat = "repeat",
        /// The texture again, every other time mirrored.
        MirrorRepeat = "mirror-repeat",
    }
}

/// How a shader samples its texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sampler {
    /// The filter, for magnification and minification alike.
    pub filter: FilterMode,
    /// Across and down.
    pub address: [AddressMode; 2],
}

impl BlendFactor {
    /// Whether the factor comes from the second source.
    pub fn is_second_source(self) -> bool {
        matches!(
            self,
            Self::Src1 | Self::OneMinusSrc1 | Self::Src1Alpha | Self::OneMinusSrc1Alpha
        )
    }
}

/// One blend equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendComponent {
    /// The operation.
    pub operation: BlendOperation,
    /// The source's factor.
    pub src_factor: BlendFactor,
    /// The destination's factor.
    pub dst_factor: BlendFactor,
}

/// Blending of one attachment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendState {
    /// Red, green and blue.
    pub color: BlendComponent,
    /// Alpha.
    pub alpha: BlendComponent,
}

/// The depth test of a draw. A draw without one neither tests nor writes depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DepthState {
    /// The comparison, incoming depth on the left.
    pub compare: CompareFunction,
    /// Whether passing fragments store their depth.
    pub write: bool,
}

/// What is added to a polygon's depth: `constant * r + slope * m`, where `r` is the least step of
/// the attachment's depth and `m` the polygon's steepest slope, then held to `clamp` where that is
/// not 0. Off when all are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DepthBias {
    /// In least steps; WebGPU wants an integer.
    pub constant: i32,
    /// Per unit of slope.
    pub slope: f32,
    /// The most that is added, or with a minus sign the least.
    pub clamp: f32,
}

/// Where clip space lies in the attachments.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viewport {
    /// Left, top, width and height in texels. With a height below 0 the picture is turned over and
    /// the second number is its bottom (Vulkan, Controlling the Viewport).
    pub rect: [f32; 4],
    /// Window depths of clip depths 0 and 1; reversed when the first is larger.
    pub depth: [f32; 2],
}

impl Viewport {
    /// Left, top, width and height of what the viewport covers, whichever way the picture stands.
    pub fn area(&self) -> [f32; 4] {
        let [x, y, w, h] = self.rect;
        [x, y.min(y + h), w, h.abs()]
    }

    /// Whether the picture is turned over.
    pub fn is_mirrored(&self) -> bool {
        self.rect[3] < 0.0
    }
}

/// Which samples of a fragment are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Multisample {
    /// Bit `i` lets sample `i` through.
    pub mask: u32,
    /// Whether alpha takes samples away.
    pub alpha_to_coverage: bool,
    /// Whether alpha then counts as 1.
    pub alpha_to_one: bool,
}

impl Default for Multisample {
    fn default() -> Self {
        Self {
            mask: u32::MAX,
            alpha_to_coverage: false,
            alpha_to_one: false,
        }
    }
}
