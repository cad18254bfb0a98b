//! The calls: tables of objects, and commands that refer to objects by their index in a table.

use crate::format::GpuFormat;
use crate::pipeline_state::RenderPipeline;
use crate::reading::MappedReading;
use etalon_scene::{IndexFormat, Sampler};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::ops::Range;

/// The usages of buffers (WebGPU: GPUBufferUsage).
pub mod buffer_usage {
    /// Can be mapped for reading.
    pub const MAP_READ: u32 = 0x1;
    /// Can be the source of a copy.
    pub const COPY_SRC: u32 = 0x4;
    /// Can be the target of a copy or a write.
    pub const COPY_DST: u32 = 0x8;
    /// Holds indices.
    pub const INDEX: u32 = 0x10;
    /// Holds vertices.
    pub const VERTEX: u32 = 0x20;
    /// Holds uniforms.
    pub const UNIFORM: u32 = 0x40;
    /// Written by shaders.
    pub const STORAGE: u32 = 0x80;
    /// Holds the arguments of indirect draws.
    pub const INDIRECT: u32 = 0x100;
    /// Receives the results of queries.
    pub const QUERY_RESOLVE: u32 = 0x200;
}

/// The usages of textures (WebGPU: GPUTextureUsage).
pub mod texture_usage {
    /// Can be the source of a copy.
    pub const COPY_SRC: u32 = 0x1;
    /// Can be the target of a copy.
    pub const COPY_DST: u32 = 0x2;
    /// Can be read by shaders.
    pub const TEXTURE_BINDING: u32 = 0x4;
    /// Can be drawn to.
    pub const RENDER_ATTACHMENT: u32 = 0x10;
}

/// A scene as WebGPU calls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CallList {
    /// Shader modules.
    pub shaders: Vec<Shader>,
    /// Bind group layouts. A pipeline layout has at most one.
    pub layouts: Vec<Vec<LayoutEntry>>,
    /// Samplers.
    pub samplers: Vec<Sampler>,
    /// Textures, with undefined contents.
    pub textures: Vec<Texture>,
    /// Texture views.
    pub views: Vec<TextureView>,
    /// Buffers.
    pub buffers: Vec<Buffer>,
    /// Bind groups.
    pub groups: Vec<BindGroup>,
    /// Query sets.
    pub query_sets: Vec<QuerySet>,
    /// Render pipelines.
    pub pipelines: Vec<RenderPipeline>,
    /// Render bundles.
    pub bundles: Vec<RenderBundle>,
    /// The commands that precede the frame's, in its first submission only.
    pub first: Vec<EncoderCommand>,
    /// The command buffers of a frame, submitted together.
    pub frame: Vec<Vec<EncoderCommand>>,
    /// The commands that copy what is read into the buffer `output`, submitted after a frame.
    pub read: Vec<EncoderCommand>,
    /// The buffer that is mapped after the commands of `read`.
    pub output: usize,
    /// The meaning of the bytes in `output`.
    pub reading: MappedReading,
}

impl CallList {
    /// Returns true if a pass of the frame is timed.
    pub fn is_timed(&self) -> bool {
        let timed = |command: &EncoderCommand| matches!(command, EncoderCommand::Pass(pass) if pass.timed != [false; 2]);
        self.frame.iter().flatten().any(timed)
    }
}

/// A shader module in WGSL.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Shader {
    /// The name, for messages.
    pub label: Cow<'static, str>,
    /// The source.
    pub code: Cow<'static, str>,
}

/// A binding of a layout, visible to fragment shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct LayoutEntry {
    /// The binding number.
    pub binding: u32,
    /// The type of the resource.
    pub resource: LayoutResource,
}

/// The type of a bound resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum LayoutResource {
    /// A uniform buffer with a dynamic offset, of at least this many bytes.
    Uniform(u64),
    /// A storage buffer, of at least this many bytes.
    Storage(u64),
    /// A two-dimensional texture.
    Texture {
        /// The type of its texels.
        sample_type: SampleType,
        /// True if the texture is multisampled.
        multisampled: bool,
    },
    /// A filtering sampler.
    Sampler,
}

/// The type of a texture's texels in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SampleType {
    /// Floats that a sampler can filter.
    Float,
    /// Floats that a sampler cannot filter.
    UnfilterableFloat,
    /// Unsigned integers.
    Uint,
}

/// Width, height, and depth or the number of layers.
pub type Extent = [u32; 3];

/// A texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Texture {
    /// The size of level 0.
    pub size: Extent,
    /// The number of levels.
    pub levels: u32,
    /// Samples per texel.
    pub samples: u32,
    /// The dimension.
    pub dimension: TextureDimension,
    /// The format.
    pub format: GpuFormat,
    /// The usages, of [`texture_usage`].
    pub usage: u32,
    /// Another format that views can have.
    pub view_format: Option<GpuFormat>,
}

/// The dimension of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum TextureDimension {
    /// Two dimensions, with layers.
    #[serde(rename = "2d")]
    D2,
    /// Three dimensions.
    #[serde(rename = "3d")]
    D3,
}

/// The aspects that a view or a copy takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TextureAspect {
    /// All aspects of the format.
    All,
    /// Depth.
    DepthOnly,
    /// Stencil.
    StencilOnly,
}

/// A view of one level of one layer, or of a whole 3D texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct TextureView {
    /// The index of the texture.
    pub texture: usize,
    /// The level and layer of a 2D texture; `None` for the whole of a 3D texture.
    pub part: Option<[u32; 2]>,
    /// The aspect.
    pub aspect: TextureAspect,
    /// The format, if it differs from the texture's.
    pub format: Option<GpuFormat>,
}

/// A buffer. Bytes beyond the contents are undefined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Buffer {
    /// The size in bytes.
    pub size: u64,
    /// The usages, of [`buffer_usage`].
    pub usage: u32,
    /// The contents from byte 0 on. The length is a multiple of 4 bytes, or 0.
    pub contents: Vec<u8>,
}

/// A bind group.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct BindGroup {
    /// The index of the bind group layout.
    pub layout: usize,
    /// The resources, each with its binding number.
    pub entries: Vec<(u32, Binding)>,
}

/// A bound resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Binding {
    /// A part of a buffer.
    Buffer {
        /// The index of the buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
        /// The number of bytes.
        size: u64,
    },
    /// The index of a texture view.
    View(usize),
    /// The index of a sampler.
    Sampler(usize),
}

/// The type of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum QueryType {
    /// True if any sample passed.
    Occlusion,
    /// The number of fragment shader invocations. Not part of WebGPU, but a native feature of wgpu.
    FragmentInvocations,
}

/// A set of queries of one type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct QuerySet {
    /// The type.
    pub ty: QueryType,
    /// The number of queries.
    pub count: u32,
}

/// A query of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SetQuery {
    /// The type of the query's set.
    pub ty: QueryType,
    /// The index of the query set.
    pub set: usize,
    /// The index in the set.
    pub index: u32,
}

/// Draws that are recorded before the pass that executes them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderBundle {
    /// The formats of the colour attachments; `None` if a location has no attachment.
    pub color: Vec<Option<GpuFormat>>,
    /// The format of the depth and stencil attachment.
    pub depth_stencil: Option<GpuFormat>,
    /// True if depth and stencil are read only.
    pub read_only: bool,
    /// Samples per texel.
    pub samples: u32,
    /// The draws.
    pub commands: Vec<DrawCommand>,
}

/// A command outside passes, or a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum EncoderCommand {
    /// Fills the first bytes of a buffer with zeros.
    ClearBuffer {
        /// The index of the buffer.
        buffer: usize,
        /// The number of bytes.
        size: u64,
    },
    /// Copies bytes.
    CopyBuffer {
        /// The source, from byte 0 on.
        from: usize,
        /// The target.
        to: usize,
        /// The first byte in the target.
        offset: u64,
        /// The number of bytes.
        size: u64,
    },
    /// Copies rows of a buffer to a texture.
    Upload {
        /// The source.
        from: BufferRows,
        /// The target.
        to: TexturePart,
        /// Width and height.
        size: [u32; 2],
    },
    /// Copies a part of a texture to rows of a buffer.
    Download {
        /// The source.
        from: TexturePart,
        /// The target.
        to: BufferRows,
        /// Width and height.
        size: [u32; 2],
    },
    /// Copies a part of a texture to another texture.
    CopyTexture {
        /// The source.
        from: TexturePart,
        /// The target.
        to: TexturePart,
        /// Width and height.
        size: [u32; 2],
    },
    /// Writes the results of all queries of a set to a buffer.
    Resolve {
        /// The index of the query set.
        set: usize,
        /// The index of the buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
    },
    /// A render pass.
    Pass(RenderPass),
}

/// Rows of texels in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BufferRows {
    /// The index of the buffer.
    pub buffer: usize,
    /// The first byte.
    pub offset: u64,
    /// The distance between rows, in bytes.
    pub pitch: u32,
}

/// A part of a texture that begins at a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TexturePart {
    /// The index of the texture.
    pub texture: usize,
    /// The level, 0 for the largest.
    pub level: u32,
    /// The column, row, and layer or slice.
    pub origin: [u32; 3],
    /// The aspect.
    pub aspect: TextureAspect,
}

/// A render pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RenderPass {
    /// The colour attachments; `None` if a location has no attachment.
    pub color: Vec<Option<ColorAttachment>>,
    /// The depth and stencil attachment.
    pub depth_stencil: Option<DepthStencilAttachment>,
    /// The query set of occlusion queries.
    pub occlusion: Option<usize>,
    /// True if the pass begins the timed part of the frame, and true if it ends it.
    pub timed: [bool; 2],
    /// The commands.
    pub commands: Vec<PassCommand>,
}

/// A colour attachment of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColorAttachment {
    /// The index of the view.
    pub view: usize,
    /// The slice of a 3D texture.
    pub depth_slice: Option<u32>,
    /// The view that the attachment is resolved to.
    pub resolve: Option<usize>,
    /// The load and store operations.
    pub operations: Filled<[f32; 4]>,
}

/// The load and store operations of an aspect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Filled<V> {
    /// The value that the aspect is cleared to; without a value, it is loaded.
    pub clear: Option<V>,
    /// True if the aspect is stored, false if it is discarded.
    pub store: bool,
}

impl<V> Filled<V> {
    /// Returns operations that clear and store.
    pub const fn cleared(value: V) -> Self {
        Self {
            clear: Some(value),
            store: true,
        }
    }

    /// Returns operations that load and store.
    pub const fn kept() -> Self {
        Self {
            clear: None,
            store: true,
        }
    }
}

/// The depth and stencil attachment of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthStencilAttachment {
    /// The index of the view.
    pub view: usize,
    /// The access to depth.
    pub depth: Access<f32>,
    /// The access to stencil.
    pub stencil: Access<u32>,
}

/// The access of a pass to an aspect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Access<V> {
    /// The format lacks the aspect.
    Absent,
    /// The aspect is read-only.
    ReadOnly,
    /// The aspect can be written.
    Written(Filled<V>),
}

/// A command in a pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum PassCommand {
    /// Sets the viewport.
    SetViewport {
        /// Left, top, width and height in texels.
        rect: [f32; 4],
        /// The depths of the near and the far plane.
        depth: [f32; 2],
    },
    /// Sets the scissor rectangle: left, top, width and height in texels.
    SetScissorRect([u32; 4]),
    /// Sets the blend constant.
    SetBlendConstant([f32; 4]),
    /// Sets the stencil reference.
    SetStencilReference(u32),
    /// Begins a query.
    Begin(SetQuery),
    /// Ends the active query of a type.
    End(QueryType),
    /// Executes the bundle with this index.
    Execute(usize),
    /// A command that bundles can also contain.
    Draw(DrawCommand),
}

/// A command in a pass or a bundle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum DrawCommand {
    /// Sets the pipeline with this index.
    SetPipeline(usize),
    /// Sets the only bind group.
    SetBindGroup {
        /// The index of the bind group.
        group: usize,
        /// The dynamic offset of its uniform buffer.
        offset: Option<u32>,
    },
    /// Sets a vertex buffer.
    SetVertexBuffer {
        /// The slot that the pipeline reads the buffer from.
        slot: u32,
        /// The index of the buffer.
        buffer: usize,
        /// The range of bytes.
        place: Range<u64>,
    },
    /// Sets the index buffer.
    SetIndexBuffer {
        /// The index of the buffer.
        buffer: usize,
        /// The range of bytes.
        place: Range<u64>,
        /// The size of an index.
        format: IndexFormat,
    },
    /// Draws without indices.
    Draw {
        /// The indices of the first vertex and of the one after the last.
        vertices: Range<u32>,
        /// The indices of the first instance and of the one after the last.
        instances: Range<u32>,
    },
    /// Draws with indices.
    DrawIndexed {
        /// The positions of the first index and of the one after the last, in the index buffer.
        indices: Range<u32>,
        /// The number added to each index.
        base_vertex: i32,
        /// The indices of the first instance and of the one after the last.
        instances: Range<u32>,
    },
    /// Draws, with the arguments from a buffer.
    DrawIndirect {
        /// The index of the buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
    },
    /// Draws with indices, with the arguments from a buffer.
    DrawIndexedIndirect {
        /// The index of the buffer.
        buffer: usize,
        /// The first byte.
        offset: u64,
    },
}

impl DrawCommand {
    /// Returns true if the command draws.
    pub fn is_draw(&self) -> bool {
        matches!(
            self,
            Self::Draw { .. }
                | Self::DrawIndexed { .. }
                | Self::DrawIndirect { .. }
                | Self::DrawIndexedIndirect { .. }
        )
    }
}
