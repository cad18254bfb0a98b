//! The events of a story: operations of the reference on one sample, with their values and their effect.
//!
//! Functions, factors, operations, modes and shaders are given by the names that the scene's types have; this
//! crate does not know those types.

use crate::contents::{Codes, Contents, ValueRange};
use crate::format::Aspect;
use serde::{Deserialize, Serialize};

/// An operation on a sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// The scene, in a story about several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<SceneName>,
    /// The part of the scene that causes the operation.
    pub origin: Origin,
    /// The operation, with the operands and results that it had.
    pub step: Step,
    /// The rejection, or the stored or kept contents, that the operation causes.
    #[serde(default, skip_serializing_if = "Effect::is_none")]
    pub effect: Effect,
    /// The section of the specification that permits or demands the outcome.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub citation: Option<String>,
}

/// One of a case's scenes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SceneName {
    /// The case's own scene.
    Own,
    /// The scene of a variant.
    Variant(String),
}

/// One of two pictures that must be the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Side {
    /// The picture of a scene.
    Scene(SceneName),
    /// An attachment of one scene.
    Attachment(String),
}

/// The part of a scene that causes an operation. Passes, draws and primitives are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Origin {
    /// The initial contents of an attachment.
    Attachment(String),
    /// A pass.
    Pass(usize),
    /// The load operations of a pass.
    Load(usize),
    /// The clear commands before a draw of a pass.
    BeforeDraw {
        /// The pass.
        pass: usize,
        /// The draw.
        draw: usize,
    },
    /// The clear commands at the end of a pass.
    PassEnd(usize),
    /// The resolves and store operations after a pass.
    AfterPass(usize),
    /// A draw, or some of its primitives.
    Draw {
        /// The pass.
        pass: usize,
        /// The draw.
        draw: usize,
        /// The primitives in order; empty for all.
        primitives: Vec<u32>,
    },
    /// A primitive's fragment at the sample.
    Fragment {
        /// The pass.
        pass: usize,
        /// The draw.
        draw: usize,
        /// The primitive.
        primitive: u32,
        /// The number of the world, from 1, and the number of worlds; `None` if there is one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        world: Option<[usize; 2]>,
    },
    /// Reading back.
    End {
        /// The number of the world, from 1, and the number of worlds; `None` if there is one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        world: Option<[usize; 2]>,
    },
    /// Two pictures that must be the same.
    Sides([Side; 2]),
}

impl Event {
    /// Returns true if both events have the same position in the same scene. All primitives of a draw count
    /// as one position.
    pub fn is_beside(&self, other: &Self) -> bool {
        let place = match (&self.origin, &other.origin) {
            (Origin::Draw { .. }, Origin::Draw { .. }) => self.origin.draw() == other.origin.draw(),
            (here, there) => here == there,
        };
        place && self.scene == other.scene
    }
}

impl Origin {
    /// Returns the pass and the draw of a draw or a fragment.
    pub fn draw(&self) -> Option<(usize, usize)> {
        match self {
            Self::Draw { pass, draw, .. } | Self::Fragment { pass, draw, .. } => {
                Some((*pass, *draw))
            }
            _ => None,
        }
    }

    /// Returns true for a draw or a fragment that includes the primitive.
    pub fn includes(&self, number: u32) -> bool {
        match self {
            Self::Draw { primitives, .. } => primitives.is_empty() || primitives.contains(&number),
            Self::Fragment { primitive, .. } => *primitive == number,
            _ => false,
        }
    }
}

/// The effect of an operation on the sample.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Effect {
    /// The operation decides nothing about the sample.
    #[default]
    None,
    /// The draw, the primitives or the fragment end here.
    Rejects(Rejection),
    /// The rules leave two outcomes open, and in one of them the fragment ends here.
    MayReject(Rejection),
    /// A fragment that passed leaves an aspect of an attachment unchanged.
    Keeps(Target),
    /// An aspect of an attachment gets new contents.
    Stores(Target),
}

impl Effect {
    /// Returns true if the operation decides nothing about the sample.
    pub fn is_none(&self) -> bool {
        *self == Self::None
    }

    /// Returns the rejection, if the operation rejects or may reject.
    pub fn rejection(&self) -> Option<Rejection> {
        match self {
            Self::Rejects(rejection) | Self::MayReject(rejection) => Some(*rejection),
            Self::None | Self::Keeps(_) | Self::Stores(_) => None,
        }
    }
}

/// One aspect of one attachment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// The attachment's name in the scene.
    pub attachment: String,
    /// Colour, or the depth or the stencil of a depth-stencil attachment.
    pub aspect: Aspect,
}

/// The operation that keeps a draw, a primitive or a fragment from affecting a sample, in the order of the
/// pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rejection {
    /// Nothing is rasterized.
    RasterizerDiscard,
    /// The primitive does not cover the sample.
    Coverage,
    /// The sides of the view volume clip the primitive.
    Viewport,
    /// The near or the far plane clips the primitive.
    NearFar,
    /// A clip distance clips the primitive.
    ClipDistance,
    /// All vertices of the primitive have a negative cull distance.
    CullDistance,
    /// The primitive's face is culled.
    Culling,
    /// The scissor rectangle excludes the texel.
    Scissor,
    /// Sample coverage excludes the sample.
    SampleCoverage,
    /// The sample mask excludes the sample.
    SampleMask,
    /// The shader discards the fragment.
    Discard,
    /// The shader's own sample mask excludes the sample.
    ShaderMask,
    /// Alpha to coverage excludes the sample.
    AlphaToCoverage,
    /// The stored depth is out of bounds.
    DepthBounds,
    /// The stencil test fails.
    Stencil,
    /// The depth test fails.
    Depth,
}

/// An operation of the reference with its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Step {
    /// A pass draws to attachments whose size or sample count differs from the sample's.
    OtherAttachments {
        /// Width and height in texels.
        size: [u32; 2],
        /// The sample count.
        samples: u32,
    },
    /// Texels are uploaded to an attachment.
    Upload(Vec<Contents>),
    /// An attachment, or an aspect of one, is cleared.
    Clear(Vec<Contents>),
    /// A clear command whose rectangle excludes the texel.
    ClearElsewhere,
    /// A store operation leaves an aspect of an attachment undefined.
    StoreDiscard(Target),
    /// A colour attachment is resolved.
    Resolve {
        /// The multisampled attachment.
        from: String,
        /// The single-sampled attachment.
        to: String,
        /// The conversion of the samples to one value.
        by: ResolveChoice,
        /// The contents of the samples, channel by channel.
        samples: Vec<Vec<Codes>>,
        /// The possible results, channel by channel.
        results: Vec<Vec<Codes>>,
    },
    /// Depth or stencil is resolved.
    ResolveDepthStencil {
        /// The multisampled attachment.
        from: String,
        /// The single-sampled attachment.
        to: String,
        /// The resolve mode by its name in case files: `sample-zero`.
        mode: String,
        /// The codes that the resolved aspect can have.
        result: Codes,
        /// Depth or stencil.
        aspect: Aspect,
    },
    /// Primitives are discarded before rasterization.
    RasterizerDiscard,
    /// The texel is outside the scissor rectangle `[x, y, width, height]`.
    Scissor([u32; 4]),
    /// Primitives of a draw do not reach the sample; the origin lists them.
    Primitives {
        /// The number of primitives of the draw.
        count: usize,
        /// The viewport `[x, y, width, height]`, if primitives are outside it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        viewport: Option<[f32; 4]>,
    },
    /// A primitive can be clipped away at the sample.
    Clipping,
    /// Coverage of the sample by a primitive.
    Coverage(Coverage),
    /// The contents of the pass's attachments in one world.
    World(Vec<Contents>),
    /// The face of a primitive is culled.
    Culling {
        /// True if the face is a front face.
        front: bool,
        /// The cull mode by its name in case files.
        mode: String,
    },
    /// Sample coverage (a fraction of the samples).
    SampleCoverage {
        /// The fraction of samples that are covered; OpenGL clamps it to 0 to 1.
        share: f32,
        /// True if the coverage is inverted, so that the other samples are drawn.
        inverted: bool,
        /// The sample's number within its texel, from 0.
        sample: u32,
    },
    /// The fragment shader.
    Shade {
        /// True if the fragment's face is a front face.
        front: bool,
        /// The shader by its name in case files; `None` without a fragment shader.
        shader: Option<String>,
        /// The colour that the shader returns.
        color: [ValueRange; 4],
        /// The attachments that the shader reads, and the texel of each.
        texels: Vec<(String, [ValueRange; 4])>,
    },
    /// The sample mask that the shader reads.
    InputMask {
        /// The bits that are set.
        set: u32,
        /// The bits that can be set, including those in `set`.
        possible: u32,
    },
    /// The shader's discard.
    Discard {
        /// The value that is compared.
        value: ValueRange,
        /// The limit that the value must reach.
        limit: ValueRange,
        /// True if the value must exceed the limit.
        strict: bool,
    },
    /// The shader's own sample mask.
    ShaderMask {
        /// The bits that the shader writes.
        bits: ValueRange,
    },
    /// The sample mask of the draw.
    SampleMask {
        /// Bit `i` lets sample `i` be drawn.
        mask: u32,
    },
    /// Alpha to coverage.
    AlphaToCoverage {
        /// The alpha of the shader's first output, which decides the number of samples.
        alpha: ValueRange,
    },
    /// Forced early tests passed, and the fragment is lost afterwards.
    LostAfterEarlyTests,
    /// The depth bounds test.
    DepthBounds {
        /// The stored depth, which the test compares in place of the fragment's.
        stored: ValueRange,
        /// The lower bound, which passes.
        low: ValueRange,
        /// The upper bound, which passes.
        high: ValueRange,
    },
    /// The stencil test. It fails if the effect rejects.
    StencilTest {
        /// The reference before the read mask, on the left of the comparison.
        reference: u8,
        /// True if the shader wrote the reference.
        exported: bool,
        /// The compare function by its name in case files.
        compare: String,
        /// The stored value before the read mask, on the right of the comparison.
        stored: u8,
        /// The bits of both values that are compared.
        read_mask: u8,
        /// True if the stencil test passes and the depth test fails.
        depth_fails: bool,
    },
    /// The stencil operation.
    StencilUpdate {
        /// The stencil operation by its name in case files.
        operation: String,
        /// The bits that the operation can change.
        write_mask: u8,
        /// The stored value before.
        before: u8,
        /// The stored value after.
        after: u8,
    },
    /// The depth test. It passes if it has no effect, fails if the effect rejects, and is open if the effect
    /// may reject.
    DepthTest(DepthTest),
    /// Depth is stored.
    StoreDepth {
        /// The window depth before it is encoded.
        depth: ValueRange,
        /// The stored codes of the depth.
        codes: Codes,
    },
    /// Depth is not stored.
    KeepDepth {
        /// True if the draw has a depth test, so that depth writes are off.
        tested: bool,
    },
    /// An advanced blend operation.
    AdvancedBlend {
        /// The mode by its name in case files: `color-burn`.
        operation: String,
        /// The premultiplied colour of the shader's output.
        src: [ValueRange; 4],
        /// The premultiplied colour of the attachment.
        dst: [ValueRange; 4],
        /// The premultiplied colour before it is encoded.
        result: [ValueRange; 4],
    },
    /// Blending, channel by channel.
    Blend(Box<[BlendedChannel; 4]>),
    /// A logic operation.
    Logic {
        /// The logic operation by its name in case files.
        operation: String,
        /// The codes that the operation combines with those of the shader's output.
        stored: Contents,
    },
    /// Colour is stored.
    StoreColor {
        /// The contents afterwards.
        contents: Contents,
        /// The written channels, bit 0 for red; `None` if all are written.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        write_mask: Option<u8>,
    },
    /// The write mask excludes all channels.
    KeepColor {
        /// The contents that stay.
        contents: Contents,
        /// The written channels, bit 0 for red: none that the format has.
        write_mask: u8,
    },
    /// The shader writes the stencil reference.
    StencilExport {
        /// The number that the shader writes.
        written: i32,
        /// The reference: the lowest 8 bits of the value.
        reference: u8,
        /// The reference of the draw.
        draw: u8,
    },
    /// The stencil reference that the shader writes comes too late for the test.
    LateStencilExport {
        /// The reference of the draw.
        draw: u8,
    },
    /// There are too many worlds, so the sample becomes open.
    GiveUp {
        /// The number of worlds, which is above the limit of the reference.
        worlds: usize,
    },
    /// An attachment is read back.
    ReadBack {
        /// The attachment's name in the scene.
        attachment: String,
        /// The contents of all its aspects.
        contents: Vec<Contents>,
        /// True if a shader reads its depth.
        depth_by_shader: bool,
    },
    /// Two pictures must be the same; the name of the invariance.
    Relation(String),
}

/// The conversion of a texel's samples to one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ResolveChoice {
    /// An average of all samples.
    Average,
    /// The first sample.
    First,
    /// The value of any one sample.
    Any,
}

/// Coverage of a sample by one primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Coverage {
    /// The sample is outside.
    Outside,
    /// The sample is outside for one of the primitive's possible facings.
    OutsideOneWay,
    /// The primitive covers the sample this many times.
    Times {
        /// The least number of times.
        least: u32,
        /// The greatest number of times.
        most: u32,
    },
    /// The primitive has no area.
    NoArea,
    /// Snapping can leave the primitive without area.
    PerhapsNoArea,
    /// The sample is on an edge that is neither a top nor a left edge.
    NotTopLeft {
        /// The number of the edge.
        edge: usize,
    },
    /// The sample is on an edge, or within the snapping distance of one.
    Edge {
        /// The number of the edge.
        edge: usize,
        /// True if the sample is exactly on the edge.
        exact: bool,
        /// True if the primitive covers the sample, because the edge's other primitive does not; `None` if
        /// neither is decided.
        covers: Option<bool>,
    },
}

impl Coverage {
    /// Returns true if an edge of the primitive decides.
    pub fn is_edge(self) -> bool {
        matches!(self, Self::NotTopLeft { .. } | Self::Edge { .. })
    }
}

/// A depth test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum DepthTest {
    /// Two depths are compared.
    Compared {
        /// The compare function by its name in case files.
        compare: String,
        /// The fragment's depth, on the left of the comparison.
        incoming: ValueRange,
        /// The stored depth, on the right of the comparison.
        stored: ValueRange,
    },
    /// A depth is compared with itself.
    Same {
        /// The compare function by its name in case files; equality decides it.
        compare: String,
    },
}

/// The blending of one channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlendedChannel {
    /// The value of the shader's output, which `src_factor` multiplies.
    pub src: ValueRange,
    /// The source factor by its name in case files: `one-minus-src-alpha`.
    pub src_factor: String,
    /// The blend operation by its name in case files: `reverse-subtract`.
    pub operation: String,
    /// The decoded value of the attachment, which `dst_factor` multiplies.
    pub dst: ValueRange,
    /// The destination factor by its name in case files.
    pub dst_factor: String,
    /// The blended value before it is encoded.
    pub result: ValueRange,
}
