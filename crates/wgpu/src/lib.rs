//! The WebGPU backend, through wgpu.
//!
//! The suite's conventions are WebGPU's, so scenes go to wgpu as they are; wgpu's own translator
//! turns the shaders' WGSL into what the driver below takes. What WebGPU has no word for (logic
//! operations, fans, depth bounds, both faces culled, masks per face, `constant-alpha` for colour,
//! factors of `min` and `max`, viewports that turn the
//! picture over, counts of samples) is missing from [`etalon_frame::Limits::features`].
//!
//! Of several samples each is read back, by a shader; where that would not give the stored codes,
//! or an adapter's word of its samples proves wrong, one is all that is offered.
//!
//! wgpu raises its errors in a handler, or panics; both become
//! [`etalon_backend::BackendError`]s here, so that a driver's failure costs one case.

mod binding;
mod counting;
mod error;
mod fetch;
mod format;
mod gpu;
mod kept;
mod layout;
mod limits;
mod messages;
mod open;
mod pipeline;
mod pool;
mod prepared;
mod probe;
mod read;
mod slot;
mod texel;

pub use open::{Options, Via, WgpuBackend, enumerate, open};
