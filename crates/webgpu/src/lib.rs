//! Scenes as plain lists of WebGPU calls.
//!
//! [`lower()`] turns a scene into a [`CallList`]: the objects that it needs, the commands of a frame, the
//! commands that copy what is read back into one buffer, and a [`MappedReading`] that turns the bytes of that
//! buffer into a [`Frame`](etalon_frame::Frame). An executor creates the objects, records the commands and
//! maps the buffer, without knowing about scenes. An executor in a page reports its device as an
//! [`adapter`], and exchanges lists and bytes as [`message`]s.
//!
//! The suite's conventions are WebGPU's, so lowering converts nothing. The crate has no graphics API and no
//! I/O.

pub mod adapter;
mod attachment;
mod binding;
mod calls;
mod counting;
mod device;
mod draw;
#[cfg(feature = "faults")]
mod fault;
#[cfg(not(feature = "faults"))]
mod faultless;
mod fetch;
mod format;
mod lower;
pub mod message;
mod offer;
mod path;
mod pipeline;
mod pipeline_state;
mod read;
mod reading;
mod recording;
mod tables;
#[cfg(test)]
mod tests;
mod texel;

pub use calls::{
    Access, BindGroup, Binding, Buffer, BufferRows, CallList, ColorAttachment,
    DepthStencilAttachment, DrawCommand, EncoderCommand, Extent, Filled, LayoutEntry,
    LayoutResource, PassCommand, QuerySet, QueryType, RenderBundle, RenderPass, SampleType,
    SetQuery, Shader, Texture, TextureAspect, TextureDimension, TexturePart, TextureView,
    buffer_usage, texture_usage,
};
pub use device::{Abilities, Device, SAMPLES, texture_usages};
pub use etalon_scene::{BlendComponent, CullMode, PrimitiveTopology, Sampler, StencilFace};
#[cfg(feature = "faults")]
pub use fault::plant;
#[cfg(not(feature = "faults"))]
pub use faultless::plant;
pub use format::{GpuFormat, is_known};
pub use lower::lower;
pub use offer::{DeviceLimits, Level, Offer, Uses, standard_formats};
pub use pipeline_state::{
    DepthBiasState, DepthStencil, PipelineState, PipelineTarget, Primitive, RenderPipeline,
    VertexAttribute, VertexBuffer,
};
pub use reading::{CounterReading, ImageReading, MappedReading, Place, ReadMethod};
pub use recording::recording;
