//! The pipeline as a rasterizer backend: plain arithmetic in lanes, without dispatch per texel.
//!
//! It draws every scene of the suite, follows Direct3D's top-left rule and snaps vertices to the nearest of
//! 8-bit sub-pixel positions. It is judged by Vulkan's rules like any driver.

mod backend;
mod cut;
mod lanes;
mod limits;
mod linear;
mod lists;
mod memory;
mod pass;
mod planes;
mod prepared;
mod raster;
mod sampling;
mod span;
pub mod steps;
mod surface;
mod tiles;

pub use backend::{CpuBackend, in_tiles, kernels, limits_of};
pub use limits::{ProcessorRates, limits};
pub use prepared::CpuScene;
pub use surface::CpuSurface;
pub use tiles::KernelMachine;
