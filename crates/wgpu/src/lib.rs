//! The WebGPU backend, through wgpu.
//!
//! The suite's conventions are WebGPU's, so scenes go to wgpu as they are, and wgpu translates the
//! shaders' WGSL. What WebGPU lacks (logic operations, fans, depth bounds, culling of both faces,
//! masks per face, `constant-alpha` for colour, factors of `min` and `max`, mirrored viewports,
//! counts of samples) is missing from [`etalon_frame::Limits::features`].
//!
//! A shader reads multisampled attachments back sample by sample. If that would not return the
//! stored codes, or samples do not work, one sample is all that is offered.
//!
//! wgpu reports errors to a handler, or panics; both become [`etalon_backend::BackendError`]s, so
//! that a driver's failure costs one case.

mod attachment;
mod backend;
mod binding;
mod cache;
mod clock;
mod counting;
mod error;
mod fetch;
mod format;
mod gpu;
mod layout;
mod limits;
mod messages;
mod path;
mod pipeline;
mod pool;
mod prepared;
mod read;
mod recording;
mod state;
mod target;
mod texel;

pub use backend::{Options, Via, WgpuBackend, enumerate, open};
