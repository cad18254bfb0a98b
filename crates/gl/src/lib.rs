//! The OpenGL and OpenGL ES backend, through glow and EGL.
//!
//! [`open`] makes a context without a window and wraps it as a [`etalon_backend::Backend`]. Which driver answers is
//! up to the environment of the process (`LIBGL_ALWAYS_SOFTWARE`, `GALLIUM_DRIVER`, …) or to the
//! EGL device; a process should hold one driver only. libEGL is loaded at run time.
//!
//! WebGPU's conventions come from `glClipControl(UPPER_LEFT, ZERO_TO_ONE)`, under which row 0 of
//! every image is the top one, depth is what Vulkan computes and windings keep their sense; without
//! it the vertex shaders mirror y and remap z, and front faces are told apart the other way round.
//!
//! Attachments with several samples are textures; a shader reads them back, sample by sample.

mod attachment;
mod backend;
mod caps;
mod codes;
mod context;
mod counters;
mod draw;
mod egl;
mod extra;
mod features;
mod format;
mod objects;
mod options;
mod pool;
mod prepared;
mod probe;
mod program;
mod query;
mod read;
mod state;
mod surface;
#[cfg(test)]
mod tests;
mod words;

pub use backend::{GlBackend, open};
pub use egl::{EglDevice, Platform, enumerate};
pub use options::{Options, Profile};

#[cfg(test)]
use {backend::open_with, options::Tuning};
