//! Draws and their state.

use crate::blend::{ColorTarget, LogicOperation};
use crate::depth_stencil::{DepthBias, DepthState, StencilState};
use crate::early_tests::EarlyTests;
use crate::fetch::Fetch;
use crate::mesh::{Mesh, PrimitiveVertices};
use crate::rasterization::{
    CullMode, FrontFace, Multisample, PolygonMode, PrimitiveTopology, ProvokingVertex, Viewport,
};
use crate::sampler::Sampler;
use crate::shader::Shader;
use crate::tessellation::Tessellation;
use serde::{Deserialize, Serialize};

/// One draw call with all its state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// Vertices.
    pub mesh: Mesh,
    /// The path of the mesh's vertices to the pipeline.
    pub fetch: Fetch,
    /// The topology.
    pub topology: PrimitiveTopology,
    /// The tessellation of patches of three vertices, which the topology's triangles are; `None` is off.
    #[serde(default)]
    pub tessellation: Option<Tessellation>,
    /// The vertex whose attributes are flat over a primitive; with `None` it is open.
    #[serde(default)]
    pub provoking: Option<ProvokingVertex>,
    /// Vertex and fragment shader.
    pub shader: Shader,
    /// The shader's parameters.
    pub params: Params,
    /// The order of fragment tests and fragment shader.
    pub early_tests: EarlyTests,
    /// Indices of the attachments that the shader reads: single-sample colour, as it was uploaded,
    /// cleared or left by earlier passes, and no part of the pass.
    pub textures: Vec<usize>,
    /// The sampler of the textures; `None` where the shader fetches single texels.
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
    /// True if primitives are discarded before rasterization.
    pub rasterizer_discard: bool,
    /// The viewport.
    pub viewport: Viewport,
    /// Left, top, width and height of the texels that may be written; `None` is all.
    pub scissor: Option<[u32; 4]>,
    /// Bit `i` lets the shader's clip distance `i` clip.
    #[serde(default = "all_clip_distances")]
    pub clip_distances: u8,
    /// The depth bias of polygons.
    pub depth_bias: DepthBias,
    /// True if depths beyond the viewport's range are clamped instead of clipped.
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
    /// The samples that are drawn.
    pub multisample: Multisample,
    /// The blend constant in red, green, blue, alpha.
    pub blend_constant: [f32; 4],
}

impl Draw {
    /// True if alpha reduces the coverage: where the first output is of integers, alpha to coverage and alpha to one
    /// are skipped (Vulkan, Multisample Coverage; OpenGL 4.6, 17.3.1; OpenGL ES 3.2, 15.1.1).
    pub fn alpha_to_coverage(&self) -> bool {
        self.multisample.alpha_to_coverage && !self.shader.writes_integers()
    }

    /// True if alpha then counts as 1.
    pub fn alpha_to_one(&self) -> bool {
        self.multisample.alpha_to_one && !self.shader.writes_integers()
    }

    /// Returns the vertex indices of each primitive that is rasterized, in order: the mesh's own, which
    /// tessellation may turn over.
    pub fn primitives(&self) -> Vec<PrimitiveVertices> {
        let mut all = self.mesh.primitives(self.topology);
        if self.tessellation.is_some_and(|t| !t.keeps_order()) {
            for primitive in &mut all {
                if let PrimitiveVertices::Triangle([_, second, third]) = primitive {
                    std::mem::swap(second, third);
                }
            }
        }
        all
    }

    /// True if primitives share vertices in their order: those of a strip or fan without indices.
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

    /// The bits of the shader's clip distances that clip.
    pub fn clipping_distances(&self) -> u8 {
        // A shader has eight at most.
        let own = (1_u32 << self.shader.clip_distances()) - 1;
        self.clip_distances & own as u8
    }

    /// A draw of triangles with every test off and no blending, to one colour attachment.
    pub fn new(shader: Shader, mesh: Mesh, viewport: Viewport) -> Self {
        Self {
            mesh,
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
