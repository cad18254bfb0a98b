//! The Vulkan backend, through ash.
//!
//! It wants Vulkan 1.3 of a device (dynamic rendering, synchronization2) and loads `libvulkan.so.1`
//! at run time; nothing is linked. The conventions of `etalon-backend` need no tricks here: depth
//! is 0..=1 already, and viewports of negative height turn clip space's y axis up. Face winding is
//! judged in framebuffer coordinates (Vulkan, Basic Polygon Rasterization: the signed area), so that
//! `ccw` means what it means in WebGPU.
//!
//! What outlives a scene (shaders, pipelines, images, buffers, command pools) is kept in bounded
//! pools, for a suite draws many thousands of small scenes.

mod backend;
mod counting;
mod descriptors;
mod device;
mod dynamic;
mod error;
mod format;
mod gpu;
mod inputs;
mod instance;
mod limits;
mod memory;
mod pipeline;
mod plan;
mod prepared;
mod queries;
mod read;
mod record;
mod samplers;
mod samples;
mod shader;
mod slot;
mod state;

pub use backend::{Options, VulkanBackend, enumerate, open};
