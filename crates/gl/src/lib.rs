//! The OpenGL and OpenGL ES backend, through glow and EGL.
//!
//! [`open`] creates a context without a window and wraps it as an [`etalon_backend::Backend`]. The
//! environment of the process (`LIBGL_ALWAYS_SOFTWARE`, `GALLIUM_DRIVER`, …) or the EGL device
//! selects the driver; a process should load only one. libEGL is loaded at run time.
//!
//! `glClipControl(UPPER_LEFT, ZERO_TO_ONE)` sets WebGPU's conventions: row 0 of every image is the
//! top one, depth is computed as in Vulkan, and windings keep their meaning. Without it the vertex
//! shaders mirror y and remap z, and the front face is inverted.
//!
//! Multisampled attachments are textures, which a shader reads back sample by sample.

mod attachment;
mod backend;
mod blits;
mod caps;
mod clear;
mod codes;
mod context;
mod counters;
mod debug_output;
mod draw;
mod egl;
mod entry_points;
mod enums;
mod features;
mod format;
mod objects;
mod options;
mod own_pass;
mod path;
#[cfg(feature = "faults")]
mod planted;
mod pool;
mod prepared;
mod probe;
mod program;
mod query;
mod read;
mod recording;
mod sanity;
mod state;
mod support;
mod surface;
#[cfg(test)]
mod tests;
mod vertices;

pub use backend::{GlBackend, open};
pub use egl::{EglDevice, Platform, enumerate};
pub use options::{GlOptions, Profile};

#[cfg(test)]
use {backend::open_with, options::Tuning};
