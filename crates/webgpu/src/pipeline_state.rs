//! The descriptions of render pipelines.

use crate::format::GpuFormat;
use etalon_scene::{
    BlendState, CompareFunction, CullMode, DepthBias, FrontFace, IndexFormat, PrimitiveTopology,
    StencilState,
};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A render pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct RenderPipeline {
    /// The shader module.
    pub shader: usize,
    /// The layout of the only bind group.
    pub layout: Option<usize>,
    /// The rest of the description.
    pub state: PipelineState,
}

/// The state of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PipelineState {
    /// The shader's name, for messages.
    pub label: Cow<'static, str>,
    /// The vertex entry point.
    pub vertex: Cow<'static, str>,
    /// The fragment entry point, if there is one.
    pub fragment: Option<Cow<'static, str>>,
    /// The vertex buffers.
    pub buffers: Vec<VertexBuffer>,
    /// The assembly and rasterization of primitives.
    pub primitive: Primitive,
    /// The depth and stencil state.
    pub depth_stencil: Option<DepthStencil>,
    /// Samples per texel.
    pub samples: u32,
    /// The sample mask.
    pub mask: u32,
    /// True if alpha to coverage is enabled.
    pub alpha_to_coverage: bool,
    /// The colour attachments.
    pub targets: Vec<Option<PipelineTarget>>,
}

/// A vertex buffer.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct VertexBuffer {
    /// The distance between elements, in bytes.
    pub stride: u64,
    /// True if elements advance per instance instead of per vertex.
    pub per_instance: bool,
    /// The attributes of an element.
    pub attributes: Vec<VertexAttribute>,
}

/// An attribute of 32-bit floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct VertexAttribute {
    /// The location in the shader.
    pub location: u32,
    /// The first byte in the element.
    pub offset: u64,
    /// The number of floats: 2 or 4.
    pub floats: u32,
}

impl VertexAttribute {
    pub(crate) const fn of(location: u32, offset: u64, floats: u32) -> Self {
        Self {
            location,
            offset,
            floats,
        }
    }
}

/// The assembly and rasterization of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Primitive {
    /// The topology, which is never a fan.
    pub topology: PrimitiveTopology,
    /// The type of the indices; its largest value restarts a strip.
    pub strip_index: Option<IndexFormat>,
    /// The orientation of front faces.
    pub front_face: FrontFace,
    /// The faces that are culled, but never both.
    pub cull: CullMode,
    /// True if depth is clamped instead of clipped.
    pub unclipped_depth: bool,
}

/// Depth and stencil of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DepthStencil {
    /// The attachment's format.
    pub format: GpuFormat,
    /// True if depth is written; `None` without a depth aspect.
    pub depth_write: Option<bool>,
    /// The depth comparison.
    pub depth_compare: CompareFunction,
    /// The stencil test. Its references are 0, and both faces have the same masks.
    pub stencil: Option<StencilState>,
    /// The depth bias.
    pub bias: DepthBiasState,
}

/// A depth bias. Its floats are stored as bits, for hashing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DepthBiasState {
    /// The constant bias.
    pub constant: i32,
    slope: u32,
    clamp: u32,
}

impl DepthBiasState {
    pub(crate) fn of(bias: DepthBias) -> Self {
        Self {
            constant: bias.constant,
            slope: bias.slope.to_bits(),
            clamp: bias.clamp.to_bits(),
        }
    }

    /// Returns the factor of the slope.
    pub fn slope(&self) -> f32 {
        f32::from_bits(self.slope)
    }

    /// Returns the largest magnitude of the bias.
    pub fn clamp(&self) -> f32 {
        f32::from_bits(self.clamp)
    }
}

/// A colour attachment of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PipelineTarget {
    /// The format.
    pub format: GpuFormat,
    /// The blending, if it is enabled.
    pub blend: Option<BlendState>,
    /// The channels that are written. Bit 0 is red.
    pub write_mask: u8,
}
