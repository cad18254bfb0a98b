//! The names of the backends.

use serde::{Deserialize, Serialize};

/// A backend. The profiles of OpenGL and the APIs below `wgpu` count as separate backends. `Webgpu` is a
/// browser's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum BackendName {
    Cpu,
    Vulkan,
    Gl,
    GlEs,
    WgpuVulkan,
    WgpuGl,
    WgpuDx12,
    WgpuMetal,
    Webgpu,
}
