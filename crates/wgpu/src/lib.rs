//! The WebGPU backend, through wgpu.
//!
//! [`etalon_webgpu`] lowers scenes to calls, this crate executes them, and wgpu translates the shaders' WGSL.
//! What WebGPU lacks is missing from [`etalon_frame::Limits::features`]: logic operations, fans, depth
//! bounds, culling of both faces, masks per face, `constant-alpha` for colour, factors of `min` and `max`,
//! mirrored viewports, and counts of samples.
//!
//! A shader reads multisampled attachments back sample by sample. If this would not return the stored codes,
//! or multisampling does not work, only one sample is supported.
//!
//! wgpu reports errors to a handler, or panics; both become [`etalon_backend::BackendError`]s, so
//! that a driver's failure costs one case.

mod backend;
mod bundles;
mod cache;
mod clock;
mod encode;
mod error;
mod format;
mod gpu;
mod limits;
mod messages;
mod objects;
mod pipelines;
mod pool;
mod prepared;
mod state;

pub use backend::{Via, WgpuBackend, WgpuOptions, enumerate, open};
