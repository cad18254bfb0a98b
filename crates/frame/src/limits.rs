//! What an adapter can do.

use crate::format::{ChannelEncoding, TextureFormat};
use crate::image::ReadPath;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The API whose specification binds an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Api {
    /// Vulkan 1.x.
    Vulkan,
    /// OpenGL, core profile.
    OpenGl,
    /// OpenGL ES.
    OpenGlEs,
    /// WebGPU.
    WebGpu,
}

impl Api {
    /// The name of the API's rules: `vulkan`, `opengl`, `opengl-es`, `webgpu`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vulkan => "vulkan",
            Self::OpenGl => "opengl",
            Self::OpenGlEs => "opengl-es",
            Self::WebGpu => "webgpu",
        }
    }
}

impl fmt::Display for Api {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A capability that not every adapter has and that a scene may need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Feature {
    /// Alpha counting as 1 after alpha to coverage.
    AlphaToOne,
    /// Attributes interpolated inside the part of a texel that a primitive covers.
    CentroidInterpolation,
    /// Shaders that promise on which side of the fragment's own depth theirs lies.
    ConservativeDepth,
    /// The factors `constant-alpha` and `one-minus-constant-alpha` for colour.
    ConstantAlphaBlendFactor,
    /// A limit on depth bias.
    DepthBiasClamp,
    /// Rejecting fragments by the stored depth.
    DepthBounds,
    /// Depths beyond the viewport's range moved to its ends.
    DepthClamp,
    /// Blending with two sources.
    DualSourceBlending,
    /// Shaders that run after the depth and stencil tests, whatever they do.
    ForcedEarlyTests,
    /// Pipeline statistics of fragment shader runs.
    FragmentInvocations,
    /// Culling front and back faces together.
    FrontAndBackCulling,
    /// Blending and write masks that differ between colour attachments.
    IndependentBlend,
    /// Logic operations.
    LogicOperations,
    /// The operations `min` and `max` with factors other than `one` (which they ignore).
    MinMaxBlendFactors,
    /// A viewport of negative height, which turns the picture over.
    MirroredViewport,
    /// Drawing the edges of polygons.
    PolygonModeLine,
    /// Occlusion queries that count samples exactly.
    PreciseOcclusion,
    /// Throwing primitives away before rasterization.
    RasterizerDiscard,
    /// A viewport whose near depth is above its far depth.
    ReversedDepthRange,
    /// Shaders that run once per sample and know which.
    SampleShading,
    /// A scissor rectangle that reaches beyond the attachments.
    ScissorOutside,
    /// Stencil masks or references that differ between front and back faces.
    SeparateStencilMasks,
    /// Fragment shaders that count in storage buffers.
    StorageCounters,
    /// Triangle fans.
    TriangleFans,
    /// A viewport that reaches beyond the attachments.
    ViewportOutside,
}

impl Feature {
    /// Every feature.
    pub const ALL: [Self; 25] = [
        Self::AlphaToOne,
        Self::CentroidInterpolation,
        Self::ConservativeDepth,
        Self::ConstantAlphaBlendFactor,
        Self::DepthBiasClamp,
        Self::DepthBounds,
        Self::DepthClamp,
        Self::DualSourceBlending,
        Self::ForcedEarlyTests,
        Self::FragmentInvocations,
        Self::FrontAndBackCulling,
        Self::IndependentBlend,
        Self::LogicOperations,
        Self::MinMaxBlendFactors,
        Self::MirroredViewport,
        Self::PolygonModeLine,
        Self::PreciseOcclusion,
        Self::RasterizerDiscard,
        Self::ReversedDepthRange,
        Self::SampleShading,
        Self::ScissorOutside,
        Self::SeparateStencilMasks,
        Self::StorageCounters,
        Self::TriangleFans,
        Self::ViewportOutside,
    ];

    /// The feature's name in records and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::AlphaToOne => "alpha-to-one",
            Self::CentroidInterpolation => "centroid-interpolation",
            Self::ConservativeDepth => "conservative-depth",
            Self::ConstantAlphaBlendFactor => "constant-alpha-blend-factor",
            Self::DepthBiasClamp => "depth-bias-clamp",
            Self::DepthBounds => "depth-bounds",
            Self::DepthClamp => "depth-clamp",
            Self::DualSourceBlending => "dual-source-blending",
            Self::ForcedEarlyTests => "forced-early-tests",
            Self::FragmentInvocations => "fragment-invocations",
            Self::FrontAndBackCulling => "front-and-back-culling",
            Self::IndependentBlend => "independent-blend",
            Self::LogicOperations => "logic-operations",
            Self::MinMaxBlendFactors => "min-max-blend-factors",
            Self::MirroredViewport => "mirrored-viewport",
            Self::PolygonModeLine => "polygon-mode-line",
            Self::PreciseOcclusion => "precise-occlusion",
            Self::RasterizerDiscard => "rasterizer-discard",
            Self::ReversedDepthRange => "reversed-depth-range",
            Self::SampleShading => "sample-shading",
            Self::ScissorOutside => "scissor-outside",
            Self::SeparateStencilMasks => "separate-stencil-masks",
            Self::StorageCounters => "storage-counters",
            Self::TriangleFans => "triangle-fans",
            Self::ViewportOutside => "viewport-outside",
        }
    }
}

/// One thing that a scene needs of an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Requirement {
    /// A capability.
    Feature(Feature),
    /// Textures of this format that can be uploaded or cleared, fetched from and read.
    Format(TextureFormat),
    /// Attachments of this format that can be drawn to.
    Drawing(TextureFormat),
    /// Blending into attachments of this format.
    Blending(TextureFormat),
    /// So many colour attachments of one pass.
    ColorAttachments(u32),
    /// So many samples per texel in this format.
    Samples(TextureFormat, u32),
    /// Attachments at least so wide and high.
    Size(u32),
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Feature(feature) => write!(f, "feature {}", feature.name()),
            Self::Format(format) => write!(f, "format {format}"),
            Self::Drawing(format) => write!(f, "drawing to {format}"),
            Self::Blending(format) => write!(f, "blending into {format}"),
            Self::ColorAttachments(n) => write!(f, "{n} colour attachments"),
            Self::Samples(format, n) => write!(f, "{n} samples of {format}"),
            Self::Size(size) => write!(f, "attachments of {size} texels a side"),
        }
    }
}

/// What an adapter does with one format.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FormatSupport {
    /// Sample counts of attachments that can be drawn and read back; empty where the format can
    /// only be uploaded and fetched from.
    pub samples: Vec<u32>,
    /// Whether attachments of the format can be blended into.
    pub blendable: bool,
    /// The real encoding of the depth aspect. More than one where the API does not tell: then all
    /// of a frame is one or the other. Empty for formats without depth.
    pub depth: Vec<ChannelEncoding>,
    /// How the depth aspect (or colour, where there is no depth) is read back.
    pub read: ReadPath,
}

/// What an adapter can do, as far as the suite asks.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Whose rules bind the adapter.
    pub api: Api,
    /// Bits of sub-pixel precision in vertex positions; the API's minimum where it does not tell.
    pub sub_pixel_bits: u8,
    /// The largest width and height of an attachment.
    pub max_size: u32,
    /// The most colour attachments of one pass.
    pub max_color_attachments: u32,
    /// Formats, and what can be done with them.
    pub formats: BTreeMap<TextureFormat, FormatSupport>,
    /// Features.
    pub features: BTreeSet<Feature>,
    /// Sample positions in units of 1/256 texel from the top left corner, per sample count.
    pub sample_positions: BTreeMap<u32, Vec<[u16; 2]>>,
}

impl Limits {
    /// The first requirement that is not met.
    pub fn missing(&self, requirements: &[Requirement]) -> Option<Requirement> {
        requirements.iter().copied().find(|r| !self.meets(*r))
    }

    fn meets(&self, requirement: Requirement) -> bool {
        match requirement {
            Requirement::Feature(feature) => self.features.contains(&feature),
            Requirement::Format(format) => self.formats.contains_key(&format),
            Requirement::Drawing(format) => self
                .formats
                .get(&format)
                .is_some_and(|support| !support.samples.is_empty()),
            Requirement::Blending(format) => self
                .formats
                .get(&format)
                .is_some_and(|support| support.blendable),
            Requirement::ColorAttachments(n) => n <= self.max_color_attachments,
            Requirement::Samples(format, n) => self
                .formats
                .get(&format)
                .is_some_and(|support| support.samples.contains(&n)),
            Requirement::Size(size) => size <= self.max_size,
        }
    }

    /// These limits once per possible depth encoding of the given formats, each with that one
    /// encoding only: a format whose encoding is not told is one or the other for a whole frame,
    /// never texel by texel. Two formats may differ in their choice.
    pub fn alternatives(&self, formats: &[TextureFormat]) -> Vec<Self> {
        let mut all = vec![self.clone()];
        for format in formats {
            let Some(support) = self.formats.get(format) else {
                continue;
            };
            if support.depth.len() < 2 {
                continue;
            }
            all = all
                .iter()
                .flat_map(|limits| {
                    support.depth.iter().map(|encoding| {
                        let mut one = limits.clone();
                        if let Some(entry) = one.formats.get_mut(format) {
                            entry.depth = vec![*encoding];
                        }
                        one
                    })
                })
                .collect();
        }
        all
    }
}
