//! The names of the backends.

use serde::{Deserialize, Serialize};

/// A backend. The profiles of OpenGL and the APIs below `wgpu` count as separate backends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BackendName {
    /// The rasterizer.
    Cpu,
    /// Vulkan.
    Vulkan,
    /// OpenGL, core profile.
    Gl,
    /// OpenGL ES.
    GlEs,
    /// `wgpu` on Vulkan.
    WgpuVulkan,
    /// `wgpu` on OpenGL.
    WgpuGl,
    /// `wgpu` on Direct3D 12.
    WgpuDx12,
    /// `wgpu` on Metal.
    WgpuMetal,
    /// A browser's WebGPU.
    Webgpu,
    /// A program that speaks the open protocol.
    External,
}
