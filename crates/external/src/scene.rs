//! Scenes as a program receives them: vertices expanded, states by their names in WebGPU.
//!
//! A key that belongs to an optional [`Feature`](etalon_frame::Feature) is absent unless the scene needs the feature, so
//! a program that lists no features never sees it.

use crate::shaders::{ShaderLanguage, ShaderSource, sources};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_backend::{BackendError, codes};
use etalon_frame::{CounterKind, TextureFormat};
use etalon_scene::{
    AdvancedBlend, Attachment, AttachmentContents, BlendState, ColorTarget, CullMode, DepthBias,
    DepthState, Draw, EarlyTests, Fetch, FrontFace, LoadOperation, LogicOperation, Multisample,
    Operations, Params, Pass, PolygonMode, PrimitiveTopology, ProvokingVertex, Sampler, Scene,
    StencilState, StoreOperation, Viewport,
};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// A line to a program: draw this scene and read it back.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Request<'s> {
    /// The number of the request, which the answer repeats.
    pub number: u64,
    /// The scene.
    pub scene: &'s SentScene,
}

/// Everything that is drawn. All lists are in the order of execution.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentScene {
    /// The textures that passes draw to or read. Each starts from its own contents.
    pub attachments: Vec<SentAttachment>,
    /// The passes; each sees what the earlier ones stored.
    pub passes: Vec<SentPass>,
    /// Indices of the attachments to read back at the end.
    pub read: Vec<usize>,
    /// The counters; each starts from 0.
    pub counters: Vec<CounterKind>,
    /// The shaders of the draws, by name.
    pub shaders: BTreeMap<String, ShaderSource>,
}

/// A texture. It starts from either `clear`, `texels` or `depth` and `stencil`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentAttachment {
    /// The name, which the answer repeats.
    pub name: String,
    /// The format, as WebGPU spells it.
    pub format: TextureFormat,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Samples per texel.
    pub samples: u32,
    /// The colour to clear to: red, green, blue, alpha.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clear: Option<[f32; 4]>,
    /// The colours to upload: base64 of rows from the top, each texel as its format's little-endian bytes in WebGPU.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texels: Option<String>,
    /// The depth to clear to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f32>,
    /// The stencil value to clear to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stencil: Option<u8>,
}

/// A render pass. All its attachments have the same size and number of samples.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentPass {
    /// The colour attachments, by location.
    pub color: Vec<SentColor>,
    /// The attachment with depth, stencil or both.
    pub depth_stencil: Option<SentDepthStencil>,
    /// The draws.
    pub draws: Vec<SentDraw>,
}

/// A colour attachment of a pass.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentColor {
    /// The index of the attachment.
    pub attachment: usize,
    /// The index of the single-sample attachment that gets the average of the samples at the end.
    pub resolve: Option<usize>,
    /// The contents at the start of the pass.
    pub load: LoadOperation<[f32; 4]>,
    /// The fate of the contents at the end, after the resolve.
    pub store: StoreOperation,
}

/// The depth and stencil attachment of a pass.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentDepthStencil {
    /// The index of the attachment.
    pub attachment: usize,
    /// True if the pass declares that it writes neither.
    pub read_only: bool,
    /// The operations of depth.
    pub depth: Operations<f32>,
    /// The operations of stencil.
    pub stencil: Operations<u8>,
}

/// A draw call with all its state.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentDraw {
    /// Base64 of vertices of ten little-endian 32-bit floats: position in clip space (x, y up, z 0 to w, w), colour,
    /// texture coordinates. They are the shader's locations 0, 1 and 2.
    pub vertices: String,
    /// Indices of the vertices in the order of drawing; 4294967295 begins a strip again. `null`: all, in order.
    pub indices: Option<Vec<u32>>,
    /// The topology.
    pub topology: PrimitiveTopology,
    /// The shader: a key of the scene's `shaders`.
    pub shader: String,
    /// The uniform block at group 0, binding 0: two vectors of four 32-bit floats.
    pub params: Params,
    /// Indices of the single-sample attachments that the shader reads at bindings 1 and 2.
    pub textures: Vec<usize>,
    /// The sampler at binding 4; `null` if the shader fetches single texels.
    pub sampler: Option<Sampler>,
    /// Indices of the scene's counters to which the draw adds. Shader runs are counted in a storage buffer of one
    /// 32-bit integer at binding 3.
    pub counters: Vec<usize>,
    /// The culled faces.
    pub cull: CullMode,
    /// The winding of front faces, as seen in the picture.
    pub front_face: FrontFace,
    /// The viewport.
    pub viewport: Viewport,
    /// Left, top, width and height of the texels that can be written; `null` for all.
    pub scissor: Option<[u32; 4]>,
    /// The depth test; `null` turns it off.
    pub depth: Option<DepthState>,
    /// The depth bias of triangles.
    pub depth_bias: DepthBias,
    /// The stencil test; `null` turns it off.
    pub stencil: Option<StencilState>,
    /// The state of each colour attachment.
    pub targets: Vec<SentTarget>,
    /// The blend constant.
    pub blend_constant: [f32; 4],
    /// The sample mask and alpha to coverage.
    pub multisample: Multisample,
    /// The state of optional features.
    #[serde(flatten)]
    pub optional: OptionalState,
}

/// State that only optional features have; absent keys have no effect.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct OptionalState {
    /// The vertex whose attributes are flat (features `first-provoking-vertex`, `last-provoking-vertex`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub provoking: Option<ProvokingVertex>,
    /// The order of tests and shader, which the WGSL also says (`forced-early-tests`, `conservative-depth`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub early_tests: Option<EarlyTests>,
    /// Draws edges instead of areas (`polygon-mode-line`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polygon_mode: Option<PolygonMode>,
    /// Discards all primitives (`rasterizer-discard`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rasterizer_discard: Option<bool>,
    /// Bit `i` enables clip distance `i`; without the key, all are enabled (`clip-distance-mask`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip_distances: Option<u8>,
    /// Clamps depths instead of clipping (`depth-clamp`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_clamp: Option<bool>,
    /// Rejects fragments whose stored depth is outside this range (`depth-bounds`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_bounds: Option<[f32; 2]>,
    /// The logic operation of all attachments (`logic-operations`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logic: Option<LogicOperation>,
}

/// The state of a colour attachment in a draw.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SentTarget {
    /// The blend state; `null` stores the source.
    pub blend: Option<BlendState>,
    /// The written channels: bit 0 is red, bit 3 alpha.
    pub write_mask: u8,
    /// The advanced blend mode (`advanced-blend`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advanced: Option<AdvancedBlend>,
}

impl SentScene {
    /// Returns the message of a scene, with its shaders in these languages.
    ///
    /// # Errors
    /// If a shader cannot be translated.
    pub fn new(scene: &Scene, languages: &BTreeSet<ShaderLanguage>) -> Result<Self, BackendError> {
        let mut shaders = BTreeMap::new();
        for draw in scene.passes.iter().flat_map(|pass| &pass.draws) {
            let name = shader_name(draw);
            if !shaders.contains_key(&name) {
                let text = draw.shader.wgsl_with(draw.early_tests);
                shaders.insert(name.clone(), sources(&name, &text, languages)?);
            }
        }
        Ok(Self {
            attachments: scene.attachments.iter().map(attachment).collect(),
            passes: scene.passes.iter().map(pass).collect(),
            read: scene.read.clone(),
            counters: scene.counters.iter().map(|counter| counter.kind).collect(),
            shaders,
        })
    }
}

/// Returns the key of a draw's shader, which says when the fragment tests happen if the shader says it.
fn shader_name(draw: &Draw) -> String {
    match draw.early_tests {
        EarlyTests::Implicit => draw.shader.name().to_owned(),
        tests => format!("{}:{tests}", draw.shader.name()),
    }
}

fn attachment(attachment: &Attachment) -> SentAttachment {
    let format = attachment.format;
    let mut sent = SentAttachment {
        name: attachment.name.clone(),
        format,
        size: attachment.size,
        samples: attachment.samples,
        clear: None,
        texels: None,
        depth: None,
        stencil: None,
    };
    match &attachment.contents {
        AttachmentContents::Color(color) => sent.clear = Some(*color),
        AttachmentContents::DepthStencil { depth, stencil } => {
            sent.depth = format.has_depth().then_some(*depth);
            sent.stencil = format.has_stencil().then_some(*stencil);
        }
        AttachmentContents::Texels(texels) => {
            let bytes = codes::pack_all(codes::webgpu_layout(format), texels);
            sent.texels = Some(STANDARD.encode(bytes));
        }
    }
    sent
}

fn pass(pass: &Pass) -> SentPass {
    let color = pass.color.iter().zip(&pass.resolve).enumerate();
    SentPass {
        color: color
            .map(|(location, (attachment, resolve))| {
                let Operations { load, store } = pass.color_operations(location);
                SentColor {
                    attachment: *attachment,
                    resolve: *resolve,
                    load,
                    store,
                }
            })
            .collect(),
        depth_stencil: pass.depth_stencil.map(|attachment| SentDepthStencil {
            attachment,
            read_only: pass.depth_stencil_read_only,
            depth: pass.operations.depth,
            stencil: pass.operations.stencil,
        }),
        draws: pass.draws.iter().map(sent_draw).collect(),
    }
}

fn sent_draw(draw: &Draw) -> SentDraw {
    // The program has its own way to fetch vertices.
    let plain = Draw {
        fetch: Fetch::default(),
        ..draw.clone()
    };
    let call = plain.call().without_list_restarts(draw.topology);
    SentDraw {
        vertices: STANDARD.encode(call.vertex_bytes()),
        indices: call.indices.as_ref().map(|indices| indices.to_vec()),
        topology: draw.topology,
        shader: shader_name(draw),
        params: draw.params,
        textures: draw.textures.clone(),
        sampler: draw.sampler,
        counters: draw.counters.clone(),
        cull: draw.cull,
        front_face: draw.front_face,
        viewport: draw.viewport,
        scissor: draw.scissor,
        depth: draw.depth,
        depth_bias: draw.depth_bias,
        stencil: draw.stencil,
        targets: draw.targets.iter().map(target).collect(),
        blend_constant: draw.blend_constant,
        multisample: draw.multisample,
        optional: OptionalState {
            provoking: draw.provoking,
            early_tests: Some(draw.early_tests).filter(|t| *t != EarlyTests::Implicit),
            polygon_mode: Some(draw.polygon_mode).filter(|m| *m != PolygonMode::Fill),
            rasterizer_discard: draw.rasterizer_discard.then_some(true),
            clip_distances: Some(draw.clip_distances).filter(|bits| *bits != u8::MAX),
            depth_clamp: draw.depth_clamp.then_some(true),
            depth_bounds: draw.depth_bounds,
            logic: draw.logic,
        },
    }
}

fn target(target: &ColorTarget) -> SentTarget {
    SentTarget {
        blend: target.blend,
        write_mask: target.write_mask,
        advanced: target.advanced,
    }
}
