//! The descriptions of render pipelines.

use crate::format::Format;
use etalon_scene::{
    BlendState, CompareFunction, CullMode, DepthBias, FrontFace, IndexFormat, PrimitiveTopology,
    StencilState,
};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A render pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Pipeline {
    /// The shader module.
    pub shader: usize,
    /// The layout of the only bind group.
    pub layout: Option<usize>,
    /// Everything else.
    pub state: PipelineState,
}

/// The state of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PipelineState {
    /// The shader's name, for messages.
    pub label: Cow<'static, str>,
    /// The entry point for vertices.
    pub vertex: Cow<'static, str>,
    /// The entry point for fragments.
    pub fragment: Option<Cow<'static, str>>,
    /// The vertex buffers.
    pub buffers: Vec<VertexBuffer>,
    /// The primitives.
    pub primitive: Primitive,
    /// Depth and stencil.
    pub depth_stencil: Option<DepthStencil>,
    /// Samples per texel.
    pub samples: u32,
    /// The sample mask.
    pub mask: u32,
    /// True for alpha to coverage.
    pub alpha_to_coverage: bool,
    /// The colour attachments.
    pub targets: Vec<Option<PipelineTarget>>,
}

/// A vertex buffer.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct VertexBuffer {
    /// The distance between elements, in bytes.
    pub stride: u64,
    /// True if an element is for an instance and not for a vertex.
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
    /// The topology, which is no fan.
    pub topology: PrimitiveTopology,
    /// The size of the indices whose greatest restarts a strip.
    pub strip_index: Option<IndexFormat>,
    /// The orientation of front faces.
    pub front_face: FrontFace,
    /// The faces that are culled, not both.
    pub cull: CullMode,
    /// True if depth is clamped and not clipped.
    pub unclipped_depth: bool,
}

/// Depth and stencil of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DepthStencil {
    /// The attachment's format.
    pub format: Format,
    /// True if depth is written; `None` without depth.
    pub depth_write: Option<bool>,
    /// The comparison of depth.
    pub depth_compare: CompareFunction,
    /// The stencil test, whose references are 0 and whose faces have the same masks.
    pub stencil: Option<StencilState>,
    /// The depth bias.
    pub bias: DepthBiasState,
}

/// A depth bias with floats as bits, for hashing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DepthBiasState {
    /// The constant.
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

    /// The factor of the slope.
    pub fn slope(&self) -> f32 {
        f32::from_bits(self.slope)
    }

    /// The largest magnitude.
    pub fn clamp(&self) -> f32 {
        f32::from_bits(self.clamp)
    }
}

/// A colour attachment of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PipelineTarget {
    /// The format.
    pub format: Format,
    /// Blending.
    pub blend: Option<BlendState>,
    /// The channels that are written: bit 0 is red.
    pub write_mask: u8,
}
