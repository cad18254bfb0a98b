//! Pipeline state, spelled as WebGPU spells it and extended where OpenGL and Vulkan have more.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

macro_rules! state_enum {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $variant:ident = $text:literal),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
        pub enum $name { $($(#[$doc])* #[serde(rename = $text)] $variant),+ }

        impl $name {
            /// Every value, in declaration order.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The name in case files and stories.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),+ }
            }
        }
    };
}

pub(crate) use state_enum;

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

state_enum! {
    /// The suite's shaders. Each has a WGSL file in `shaders/` and a twin in the reference.
    Shader {
        /// `params.color` where the first texture coordinate, interpolated inside the primitive, is
        /// not negative; `params.back_color` where it is.
        Centroid = "centroid",
        /// `params.color`; counts its runs.
        CountedColor = "counted_color",
        /// As `flat_color_depth`; counts its runs.
        CountedDepth = "counted_depth",
        /// As `texel_discard`; counts its runs.
        CountedDiscard = "counted_discard",
        /// The vertex colour, flat.
        FlatColor = "flat_color",
        /// `params.color`; writes the vertex colour's red as depth.
        FlatColorDepth = "flat_color_depth",
        /// The vertex colour, flat; writes the fragment's own window depth as depth.
        FragCoordDepth = "frag_coord_depth",
        /// `params.color` on front faces, `params.back_color` on back faces.
        FrontFacing = "front_facing",
        /// `params.color`; writes the number of the sample being shaded plus 1, in 32nds, as depth. Runs
        /// once per sample.
        SampleDepth = "sample_depth",
        /// The number of the sample being shaded in binary: red its lowest bit, alpha 1. Runs once
        /// per sample.
        SampleIndex = "sample_index",
        /// Texture 0 sampled at the interpolated texture coordinates.
        SampledColor = "sampled_color",
        /// The texel of texture 0 under the fragment.
        TexelColor = "texel_color",
        /// The texel of texture 0 under the fragment, to colour locations 0 to 3 alike.
        TexelColorAll = "texel_color_all",
        /// The texel of texture 0 under the fragment; discards where its alpha is below
        /// `params.color`'s.
        TexelDiscard = "texel_discard",
        /// The texel of texture 0 under the fragment as source, that of texture 1 as second source.
        TexelDualSource = "texel_dual_source",
        /// `params.color` as integers.
        UintColor = "uint_color",
        /// `params.color`.
        UniformColor = "uniform_color",
    }
}

impl Shader {
    /// The WGSL text: a vertex entry point `vs` and a fragment entry point `fs`. Vertex inputs are
    /// location 0 position, 1 colour, 2 uv; group 0 holds the parameters at binding 0, textures at
    /// bindings 1 and 2, the counter of runs at binding 3 and a sampler at binding 4.
    pub fn wgsl(self) -> &'static str {
        match self {
            Self::Centroid => include_str!("../../../shaders/centroid.wgsl"),
            Self::CountedColor => include_str!("../../../shaders/counted_color.wgsl"),
            Self::CountedDepth => include_str!("../../../shaders/counted_depth.wgsl"),
            Self::CountedDiscard => include_str!("../../../shaders/counted_discard.wgsl"),
            Self::FlatColor => include_str!("../../../shaders/flat_color.wgsl"),
            Self::FlatColorDepth => include_str!("../../../shaders/flat_color_depth.wgsl"),
            Self::FragCoordDepth => include_str!("../../../shaders/frag_coord_depth.wgsl"),
            Self::FrontFacing => include_str!("../../../shaders/front_facing.wgsl"),
            Self::SampleDepth => include_str!("../../../shaders/sample_depth.wgsl"),
            Self::SampleIndex => include_str!("../../../shaders/sample_index.wgsl"),
            Self::SampledColor => include_str!("../../../shaders/sampled_color.wgsl"),
            Self::TexelColor => include_str!("../../../shaders/texel_color.wgsl"),
            Self::TexelColorAll => include_str!("../../../shaders/texel_color_all.wgsl"),
            Self::TexelDiscard => include_str!("../../../shaders/texel_discard.wgsl"),
            Self::TexelDualSource => include_str!("../../../shaders/texel_dual_source.wgsl"),
            Self::UintColor => include_str!("../../../shaders/uint_color.wgsl"),
            Self::UniformColor => include_str!("../../../shaders/uniform_color.wgsl"),
        }
    }

    /// The WGSL text with the attribute that tells when the fragment tests happen.
    pub fn wgsl_with(self, tests: EarlyTests) -> Cow<'static, str> {
        let text = self.wgsl();
        match tests.attribute() {
            None => Cow::Borrowed(text),
            Some(word) => {
                let attributes = format!("@fragment @early_depth_test({word})");
                Cow::Owned(text.replacen("@fragment", &attributes, 1))
            }
        }
    }

    /// How many textures the shader reads.
    pub fn textures(self) -> usize {
        match self {
            Self::TexelColor
            | Self::TexelColorAll
            | Self::TexelDiscard
            | Self::CountedDiscard
            | Self::SampledColor => 1,
            Self::TexelDualSource => 2,
            _ => 0,
        }
    }

    /// Whether the shader samples its texture instead of fetching single texels.
    pub fn samples_texture(self) -> bool {
        self == Self::SampledColor
    }

    /// Whether the fragment shader replaces the fragment's depth.
    pub fn writes_depth(self) -> bool {
        matches!(
            self,
            Self::FlatColorDepth | Self::CountedDepth | Self::FragCoordDepth | Self::SampleDepth
        )
    }

    /// Whether the depth that the shader writes is the vertex colour's red.
    pub fn depth_from_vertex_color(self) -> bool {
        matches!(self, Self::FlatColorDepth | Self::CountedDepth)
    }

    /// Whether the shader may discard fragments.
    pub fn discards(self) -> bool {
        matches!(self, Self::TexelDiscard | Self::CountedDiscard)
    }

    /// Whether the shader counts its runs in a storage buffer.
    pub fn counts_runs(self) -> bool {
        matches!(
            self,
            Self::CountedColor | Self::CountedDepth | Self::CountedDiscard
        )
    }

    /// Whether the shader writes integers.
    pub fn writes_integers(self) -> bool {
        self == Self::UintColor
    }

    /// How many colour locations the shader writes.
    pub fn outputs(self) -> usize {
        if self == Self::TexelColorAll { 4 } else { 1 }
    }

    /// Whether the shader gives a second source for blending.
    pub fn has_second_source(self) -> bool {
        self == Self::TexelDualSource
    }

    /// Whether the shader runs once per sample.
    pub fn runs_per_sample(self) -> bool {
        matches!(self, Self::SampleIndex | Self::SampleDepth)
    }

    /// Whether the shader reads the parameter block.
    pub fn uses_params(self) -> bool {
        matches!(
            self,
            Self::Centroid
                | Self::CountedColor
                | Self::CountedDepth
                | Self::CountedDiscard
                | Self::FlatColorDepth
                | Self::FrontFacing
                | Self::SampleDepth
                | Self::TexelDiscard
                | Self::UintColor
                | Self::UniformColor
        )
    }
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
