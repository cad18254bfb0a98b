//! Draws and their state.

use crate::blend::{BlendState, ColorTarget, LogicOperation};
use crate::depth_stencil::{DepthBias, DepthState, StencilState};
use crate::early_tests::EarlyTests;
use crate::fetch::Fetch;
use crate::mesh::{PrimitiveVertices, SharedMesh};
use crate::rasterization::{
    CullMode, FrontFace, Multisample, PolygonMode, PrimitiveTopology, ProvokingVertex, Viewport,
};
use crate::sampler::Sampler;
use crate::shader::Shader;
use crate::tessellation::Tessellation;
use etalon_frame::{Aspect, TextureFormat};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One draw call with all its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// Vertices, and indices if there are any; draws of a scene can share them.
    pub mesh: SharedMesh,
    /// The route by which the mesh's vertices reach the pipeline.
    pub fetch: Fetch,
    /// The kind of primitives that the vertices form, in their order.
    pub topology: PrimitiveTopology,
    /// The tessellation of patches, which are the topology's triangles; `None` turns it off.
    #[serde(default)]
    pub tessellation: Option<Tessellation>,
    /// The vertex whose attributes are flat over a primitive; `None` leaves it open.
    #[serde(default)]
    pub provoking: Option<ProvokingVertex>,
    /// The pair of vertex and fragment shader; some have no fragment shader.
    pub shader: Shader,
    /// The shader's parameters.
    pub params: Params,
    /// The order of fragment tests and fragment shader.
    pub early_tests: EarlyTests,
    /// Indices of the attachments that the shader reads: single-sample colour attachments, uploaded, cleared
    /// or left by earlier passes; or attachments of the pass itself, which the shader reads at its own texel and
    /// sample, as the previous draws left them.
    pub textures: Vec<usize>,
    /// The sampler of the textures; `None` if the shader fetches single texels.
    pub sampler: Option<Sampler>,
    /// Indices of the scene's counters that this draw adds to: at most one of each kind, and at most one
    /// occlusion query.
    pub counters: Vec<usize>,
    /// The faces that are culled: front, back or none.
    pub cull: CullMode,
    /// The winding that makes a face a front face, as seen in the window.
    pub front_face: FrontFace,
    /// The part of a polygon that is drawn.
    pub polygon_mode: PolygonMode,
    /// True if primitives are discarded before rasterization.
    pub rasterizer_discard: bool,
    /// The rectangle of the viewport in texels, and its range of window depths.
    pub viewport: Viewport,
    /// Left, top, width and height of the texels that can be written; `None` for all texels.
    pub scissor: Option<[u32; 4]>,
    /// Bit `i` enables the shader's clip distance `i`.
    #[serde(default = "all_clip_distances")]
    pub clip_distances: u8,
    /// The offset that is added to the depths of polygons; 0 by default.
    pub depth_bias: DepthBias,
    /// True if depths beyond the viewport's range are clamped instead of clipped.
    pub depth_clamp: bool,
    /// The range of stored depths outside which fragments are rejected; `None` turns the test off.
    pub depth_bounds: Option<[f32; 2]>,
    /// Depth test; `None` turns it off.
    pub depth: Option<DepthState>,
    /// Stencil test; `None` turns it off.
    pub stencil: Option<StencilState>,
    /// The state for each colour attachment of the pass.
    pub targets: Vec<ColorTarget>,
    /// The logic operation of all targets, which turns their blending off; `None` turns it off.
    pub logic: Option<LogicOperation>,
    /// The state that decides which samples of a fragment are drawn.
    pub multisample: Multisample,
    /// The blend constant in red, green, blue, alpha.
    pub blend_constant: [f32; 4],
}

impl Draw {
    /// Returns true if alpha reduces the coverage. Alpha to coverage and alpha to one are skipped if the
    /// first output is an integer (Vulkan, Multisample Coverage; OpenGL 4.6, 17.3.1; OpenGL ES 3.2, 15.1.1).
    pub fn alpha_to_coverage(&self) -> bool {
        self.multisample.alpha_to_coverage && !self.shader.writes_integers()
    }

    /// Returns the blending of a target. While logic operations are enabled, nothing is blended, not even on formats
    /// on which they do nothing (Vulkan, Logical Operations; OpenGL 4.6, 17.3.6 and 17.3.9).
    pub fn blend_of(&self, target: &ColorTarget) -> Option<BlendState> {
        target.blend.filter(|_| self.logic.is_none())
    }

    /// Returns the aspect that the shader reads of an attachment of this format.
    pub fn aspect_read(&self, format: TextureFormat) -> Aspect {
        if self.shader.reads_stencil() {
            Aspect::Stencil
        } else if format.is_color() {
            Aspect::Color
        } else {
            Aspect::Depth
        }
    }

    /// Returns true if alpha counts as 1 after alpha to coverage.
    pub fn alpha_to_one(&self) -> bool {
        self.multisample.alpha_to_one && !self.shader.writes_integers()
    }

    /// Returns the vertex indices of each rasterized primitive, in order: those of the mesh, in reverse
    /// winding if tessellation reverses it.
    pub fn primitives(&self) -> Vec<PrimitiveVertices> {
        let mut primitives = self.mesh.primitives(self.topology);
        if self.tessellation.is_some_and(|t| !t.keeps_order()) {
            for primitive in &mut primitives {
                if let PrimitiveVertices::Triangle([_, second, third]) = primitive {
                    std::mem::swap(second, third);
                }
            }
        }
        primitives
    }

    /// Returns true if the mesh is a strip or fan without indices, whose primitives share vertices by their
    /// order.
    pub fn is_unindexed_strip(&self) -> bool {
        let strips = match self.topology {
            PrimitiveTopology::LineStrip
            | PrimitiveTopology::TriangleStrip
            | PrimitiveTopology::TriangleFan => true,
            PrimitiveTopology::PointList
            | PrimitiveTopology::LineList
            | PrimitiveTopology::TriangleList => false,
        };
        strips && self.mesh.indices.is_none()
    }

    /// Returns the bits of the shader's enabled clip distances.
    pub fn clipping_distances(&self) -> u8 {
        // A shader has at most eight clip distances.
        let available = (1_u32 << self.shader.clip_distances()) - 1;
        self.clip_distances & available as u8
    }

    /// Returns a draw of triangles to one colour attachment, with every test off and no blending.
    pub fn new(shader: Shader, mesh: impl Into<SharedMesh>, viewport: Viewport) -> Self {
        Self {
            mesh: mesh.into(),
            fetch: Fetch::default(),
            topology: PrimitiveTopology::TriangleList,
            tessellation: None,
            provoking: None,
            shader,
            params: Params::default(),
            early_tests: EarlyTests::Implicit,
            textures: Vec::new(),
            sampler: None,
            counters: Vec::new(),
            cull: CullMode::None,
            front_face: FrontFace::Ccw,
            polygon_mode: PolygonMode::Fill,
            rasterizer_discard: false,
            viewport,
            scissor: None,
            clip_distances: all_clip_distances(),
            depth_bias: DepthBias::default(),
            depth_clamp: false,
            depth_bounds: None,
            depth: None,
            stencil: None,
            targets: vec![ColorTarget::default()],
            logic: None,
            multisample: Multisample::default(),
            blend_constant: [0.0; 4],
        }
    }
}

fn all_clip_distances() -> u8 {
    u8::MAX
}

/// The parameter block: 32 bytes of uniform memory, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[repr(C)]
pub struct Params {
    /// A colour, or four other numbers, as the shader uses them.
    pub color: [f32; 4],
    /// A second colour, for back faces.
    pub back_color: [f32; 4],
}

impl Params {
    /// Returns the block as the shader sees it: two `vec4f`, little endian.
    pub fn to_bytes(self) -> [u8; 32] {
        let mut bytes = [0; 32];
        let values = self.color.iter().chain(&self.back_color);
        for (chunk, value) in bytes.chunks_exact_mut(4).zip(values) {
            chunk.copy_from_slice(&value.to_le_bytes());
        }
        bytes
    }
}
