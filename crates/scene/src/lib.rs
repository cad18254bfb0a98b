//! Scenes: what a driver is asked to draw.
//!
//! A [`Scene`] is data: attachments, passes, draws with all their state, and what is read back. It contains
//! no case name and no expected value. A backend depends on this crate and not on the cases, so it cannot see
//! what it is judged by. States are named as in WebGPU, with extensions for what OpenGL and Vulkan have in
//! addition.

mod attachment;
mod blend;
mod call;
mod depth_stencil;
mod draw;
mod early_tests;
mod fetch;
mod invariance;
mod mesh;
mod mesh_source;
mod on_path;
mod overlap;
mod pass;
mod path;
mod pod_bytes;
mod pool;
mod provoking;
mod query;
mod query_scope;
mod rasterization;
mod requirements;
mod sampler;
mod scene;
mod shader;
mod tessellation;
mod traffic;
mod work;

pub use attachment::{Attachment, AttachmentContents};
pub use blend::{
    AdvancedBlend, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTarget,
    LogicOperation,
};
pub use call::Call;
pub use depth_stencil::{
    CompareFunction, DepthBias, DepthState, StencilFace, StencilOperation, StencilState,
};
pub use draw::{Draw, Params};
pub use early_tests::EarlyTests;
pub use fetch::{Fetch, IndexFormat, RESTART_16};
pub use invariance::Invariance;
pub use mesh::{MAX_VERTICES, Mesh, PrimitiveVertices, RESTART, SharedMesh, Vertex};
pub use mesh_source::{FieldOf, MeshSource, Position, Splat, StripOf, Units};
pub use pass::{
    Clear, ClearTarget, DepthStencilResolve, LoadOperation, Operations, Pass, PassOperations,
    ResolveMode, StoreOperation,
};
pub use path::Path;
pub use pool::Pool;
pub use query::{Enclosing, Query};
pub use query_scope::QueryScope;
pub use rasterization::{
    CullMode, FrontFace, Multisample, PolygonMode, PrimitiveTopology, ProvokingVertex,
    SampleCoverage, Viewport,
};
pub use sampler::{AddressMode, FilterMode, Sampler};
pub use scene::{Counter, Scene};
pub use shader::{Interpolation, InterpolationSampling, PoolUse, STENCIL_REFERENCE, Shader};
pub use tessellation::{
    CONTROL_GLSL, CONTROL_SPIRV, DomainOrigin, EVALUATION_GLSL, Tessellation, evaluation_spirv,
};
