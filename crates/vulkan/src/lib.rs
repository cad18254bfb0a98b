//! The Vulkan backend, through ash.
//!
//! It requires Vulkan 1.3 (dynamic rendering, synchronization2) and loads the system's Vulkan loader at
//! run time; nothing is linked. Vulkan's depth range is that of `etalon-backend`'s conventions;
//! viewports of negative height turn clip space's y axis up. Face winding follows from the signed
//! area in framebuffer coordinates (Vulkan, Basic Polygon Rasterization), so `ccw` means the same
//! as in WebGPU.
//!
//! Shaders, pipelines, images, buffers and command pools outlive a scene in bounded pools, since a suite
//! draws thousands of small scenes.

mod attached;
mod backend;
mod blits;
mod buffer;
mod clear;
mod counting;
mod cull_distance;
mod descriptors;
mod device;
mod dynamic;
mod error;
mod extended;
mod format;
mod gpu;
mod image;
mod image_state;
mod input_attachment;
mod inputs;
mod instance;
mod limits;
mod mask_array;
mod own_pass;
mod path;
mod pipeline;
mod plan;
#[cfg(feature = "faults")]
mod planted;
mod pool;
mod prepared;
mod queries;
mod read;
mod record;
mod recording;
mod render_pass;
mod resolves;
mod role;
mod samplers;
mod samples;
mod sanity;
mod shader;
mod single;
mod single_state;
mod slot;
mod spirv;
mod state;
mod stencil_export;
mod storage;
mod targets;
mod tessellation;
mod viewport;

pub use backend::{VulkanBackend, VulkanOptions, enumerate, open};
