//! Attachments, passes and draws.
//!
//! Scenes are valid by construction: whoever builds one keeps indices in range, sizes equal within a
//! pass, and no pass reading what it draws to. Backends and the judge rely on it.

use crate::mesh::Mesh;
use crate::shader::Shader;
use crate::state::{
    BlendFactor, BlendOperation, BlendState, CompareFunction, CullMode, DepthBias, DepthState,
    EarlyTests, FrontFace, LogicOperation, Multisample, PolygonMode, PrimitiveTopology, Sampler,
    StencilOperation, Viewport,
};
use etalon_frame::{CounterKind, Feature, Requirement, TextureFormat};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Everything a device needs to know of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scene {
    /// Textures that passes draw to or read, each under a name of its own.
    pub attachments: Vec<Attachment>,
    /// Passes, in order.
    pub passes: Vec<Pass>,
    /// Indices of the attachments to read back at the end: all aspects, depth before stencil.
    pub read: Vec<usize>,
    /// What is counted, by name in ascending order. All are read back; each starts from 0.
    pub counters: Vec<Counter>,
}

/// Something that is counted over one or more draws.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counter {
    /// Name in the case file.
    pub name: String,
    /// What it counts.
    pub kind: CounterKind,
}

/// One texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attachment {
    /// Name in the case file.
    pub name: String,
    /// Format.
    pub format: TextureFormat,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// What it starts from. Every attachment is initialised before the first pass.
    pub contents: Contents,
}

/// What an attachment starts from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Contents {
    /// A colour clear in red, green, blue, alpha, converted by the API.
    Color([f32; 4]),
    /// A depth and stencil clear; the part that the format lacks is ignored.
    DepthStencil {
        /// Depth in 0..=1.
        depth: f32,
        /// Stencil.
        stencil: u8,
    },
    /// Uploaded codes, index `(y * width + x) * channels + channel`, row 0 at the top. Only
    /// single-sample colour.
    Texels(Vec<u32>),
}

/// One render pass. Attachments keep their contents from the pass before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Indices of the colour attachments, in location order.
    pub color: Vec<usize>,
    /// Where each colour attachment's samples are averaged to at the end of the pass: a
    /// single-sample attachment of the same format and size. As long as `color`.
    pub resolve: Vec<Option<usize>>,
    /// Index of the depth-stencil attachment.
    pub depth_stencil: Option<usize>,
    /// Whether the pass promises to write neither depth nor stencil.
    pub depth_stencil_read_only: bool,
    /// Draws, in order.
    pub draws: Vec<Draw>,
}

/// One draw call with all its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// Vertices.
    pub mesh: Mesh,
    /// How they become primitives.
    pub topology: PrimitiveTopology,
    /// Vertex and fragment shader.
    pub shader: Shader,
    /// The shader's parameters.
    pub params: Params,
    /// When the fragment tests happen.
    pub early_tests: EarlyTests,
    /// Indices of the attachments that the shader reads: single-sample colour, as it was uploaded,
    /// cleared or left by earlier passes, and no part of the pass.
    pub textures: Vec<usize>,
    /// How it samples them; `None` where it fetches single texels.
    pub sampler: Option<Sampler>,
    /// Indices of the scene's counters that this draw adds to: one of each kind at most, and one
    /// occlusion query at most.
    pub counters: Vec<usize>,
    /// Culled faces.
    pub cull: CullMode,
    /// The front face's winding.
    pub front_face: FrontFace,
    /// Inside or edges.
    pub polygon_mode: PolygonMode,
    /// Whether nothing is rasterized at all.
    pub rasterizer_discard: bool,
    /// Where clip space lies.
    pub viewport: Viewport,
    /// Left, top, width and height of the texels that may be written; `None` is all.
    pub scissor: Option<[u32; 4]>,
    /// What is added to depths of polygons.
    pub depth_bias: DepthBias,
    /// Whether depths beyond the viewport's range are moved to its ends instead of clipped.
    pub depth_clamp: bool,
    /// Stored depths outside this range reject fragments; `None` is off.
    pub depth_bounds: Option<[f32; 2]>,
    /// Depth test; `None` is off.
    pub depth: Option<DepthState>,
    /// Stencil test; `None` is off.
    pub stencil: Option<StencilState>,
    /// One per colour attachment of the pass.
    pub targets: Vec<ColorTarget>,
    /// The logic operation of all targets, instead of blending; `None` is off.
    pub logic: Option<LogicOperation>,
    /// Which samples are drawn.
    pub multisample: Multisample,
    /// The blend constant in red, green, blue, alpha.
    pub blend_constant: [f32; 4],
}

/// The parameter block: 32 bytes of uniform memory, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C)]
pub struct Params {
    /// A colour.
    pub color: [f32; 4],
    /// A second colour, of back faces.
    pub back_color: [f32; 4],
}

impl Params {
    /// The block as the shader sees it: two `vec4f`, little endian.
    pub fn to_bytes(self) -> [u8; 32] {
        let mut bytes = [0; 32];
        let values = self.color.iter().chain(&self.back_color);
        for (chunk, value) in bytes.chunks_exact_mut(4).zip(values) {
            chunk.copy_from_slice(&value.to_le_bytes());
        }
        bytes
    }
}

/// How one colour attachment takes a draw's fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct ColorTarget {
    /// Blending; `None` is off.
    pub blend: Option<BlendState>,
    /// Written channels: bit 0 red to bit 3 alpha.
    pub write_mask: u8,
}

/// The stencil test of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct StencilState {
    /// For front faces.
    pub front: StencilFace,
    /// For back faces.
    pub back: StencilFace,
}

/// The stencil test for one face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct StencilFace {
    /// The comparison: masked reference on the left, masked stored value on the right.
    pub compare: CompareFunction,
    /// When the stencil test fails.
    pub fail_op: StencilOperation,
    /// When the stencil test passes and the depth test fails.
    pub depth_fail_op: StencilOperation,
    /// When both pass.
    pub pass_op: StencilOperation,
    /// Bits that take part in the comparison.
    pub read_mask: u8,
    /// Bits that an operation may change.
    pub write_mask: u8,
    /// The reference.
    pub reference: u8,
}

impl Scene {
    /// What the scene needs of an adapter, without repetition, in ascending order.
    pub fn requirements(&self) -> Vec<Requirement> {
        let mut needed = BTreeSet::new();
        for attachment in &self.attachments {
            needed.insert(Requirement::Format(attachment.format));
            if attachment.samples > 1 {
                needed.insert(Requirement::Samples(attachment.format, attachment.samples));
            }
            let largest = attachment.size[0].max(attachment.size[1]);
            needed.insert(Requirement::Size(largest));
        }
        for counter in &self.counters {
            needed.extend(match counter.kind {
                CounterKind::SamplesPassed => Some(Requirement::Feature(Feature::PreciseOcclusion)),
                CounterKind::AnySamplesPassed => None,
                CounterKind::ShaderRuns => Some(Requirement::Feature(Feature::StorageCounters)),
                CounterKind::FragmentInvocations => {
                    Some(Requirement::Feature(Feature::FragmentInvocations))
                }
            });
        }
        for pass in &self.passes {
            let size = self.pass_size(pass);
            needed.insert(Requirement::ColorAttachments(pass.color.len() as u32));
            for draw in &pass.draws {
                needed.extend(draw.features(size).into_iter().map(Requirement::Feature));
                for (target, index) in draw.targets.iter().zip(&pass.color) {
                    if target.blend.is_some() {
                        needed.insert(Requirement::Blending(self.attachments[*index].format));
                    }
                }
            }
            for index in pass.color.iter().chain(&pass.depth_stencil) {
                needed.insert(Requirement::Drawing(self.attachments[*index].format));
            }
        }
        needed.into_iter().collect()
    }

    /// The size of a pass's attachments in texels.
    pub fn pass_size(&self, pass: &Pass) -> [u32; 2] {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or([1, 1], |index| self.attachments[index].size)
    }

    /// The samples per texel of a pass's attachments.
    pub fn pass_samples(&self, pass: &Pass) -> u32 {
        let first = pass.color.first().copied().or(pass.depth_stencil);
        first.map_or(1, |index| self.attachments[index].samples)
    }

    /// The scene with something counted over all its draws, and nothing else.
    pub fn counting(&self, kind: CounterKind) -> Self {
        let mut scene = self.clone();
        scene.counters = vec![Counter {
            name: kind.name().to_owned(),
            kind,
        }];
        for pass in &mut scene.passes {
            for draw in &mut pass.draws {
                draw.counters = vec![0];
            }
        }
        scene
    }

    /// Bytes of all attachments, by their formats' texel sizes.
    pub fn bytes(&self) -> u64 {
        let bytes = |a: &Attachment| {
            let texels = u64::from(a.size[0]) * u64::from(a.size[1]) * u64::from(a.samples);
            texels * u64::from(a.format.texel_bytes())
        };
        self.attachments.iter().map(bytes).sum()
    }

    /// The formats of all attachments.
    pub fn formats(&self) -> Vec<TextureFormat> {
        let set: BTreeSet<_> = self.attachments.iter().map(|a| a.format).collect();
        set.into_iter().collect()
    }
}

impl Draw {
    /// The index of the counter of a kind that this draw adds to.
    pub fn counter(&self, scene: &Scene, kind: impl Fn(CounterKind) -> bool) -> Option<usize> {
        let all = self.counters.iter().copied();
        all.filter(|i| scene.counters.get(*i).is_some_and(|c| kind(c.kind)))
            .min()
    }

    fn features(&self, size: [u32; 2]) -> Vec<Feature> {
        let mut needed = Vec::new();
        let mut need = |when: bool, feature: Feature| {
            if when {
                needed.push(feature);
            }
        };
        need(
            self.cull == CullMode::FrontAndBack,
            Feature::FrontAndBackCulling,
        );
        need(
            self.topology == PrimitiveTopology::TriangleFan,
            Feature::TriangleFans,
        );
        need(
            self.polygon_mode == PolygonMode::Line,
            Feature::PolygonModeLine,
        );
        need(self.rasterizer_discard, Feature::RasterizerDiscard);
        need(self.logic.is_some(), Feature::LogicOperations);
        need(self.depth_clamp, Feature::DepthClamp);
        need(self.depth_bounds.is_some(), Feature::DepthBounds);
        need(self.depth_bias.clamp != 0.0, Feature::DepthBiasClamp);
        need(
            self.viewport.depth[0] > self.viewport.depth[1],
            Feature::ReversedDepthRange,
        );
        need(self.viewport.is_mirrored(), Feature::MirroredViewport);
        let [x, y, w, h] = self.viewport.area();
        let outside = x < 0.0 || y < 0.0 || x + w > size[0] as f32 || y + h > size[1] as f32;
        need(outside, Feature::ViewportOutside);
        if let Some([x, y, w, h]) = self.scissor {
            let outside = x.saturating_add(w) > size[0] || y.saturating_add(h) > size[1];
            need(outside, Feature::ScissorOutside);
        }
        let early = self.early_tests;
        need(early == EarlyTests::Forced, Feature::ForcedEarlyTests);
        need(early.is_conservative(), Feature::ConservativeDepth);
        need(
            self.shader == Shader::Centroid,
            Feature::CentroidInterpolation,
        );
        need(self.multisample.alpha_to_one, Feature::AlphaToOne);
        need(self.shader.runs_per_sample(), Feature::SampleShading);
        need(self.shader.has_second_source(), Feature::DualSourceBlending);
        need(
            self.targets.windows(2).any(|pair| pair[0] != pair[1]),
            Feature::IndependentBlend,
        );
        if let Some(stencil) = &self.stencil {
            let key = |f: &StencilFace| (f.read_mask, f.write_mask, f.reference);
            need(
                key(&stencil.front) != key(&stencil.back),
                Feature::SeparateStencilMasks,
            );
        }
        for blend in self.targets.iter().filter_map(|t| t.blend) {
            let constant_alpha = [
                BlendFactor::ConstantAlpha,
                BlendFactor::OneMinusConstantAlpha,
            ];
            for (component, is_color) in [(blend.color, true), (blend.alpha, false)] {
                let factors = [component.src_factor, component.dst_factor];
                let ignores = matches!(
                    component.operation,
                    BlendOperation::Min | BlendOperation::Max
                );
                need(
                    ignores && factors != [BlendFactor::One; 2],
                    Feature::MinMaxBlendFactors,
                );
                need(
                    is_color && factors.iter().any(|f| constant_alpha.contains(f)),
                    Feature::ConstantAlphaBlendFactor,
                );
            }
        }
        needed
    }
}
