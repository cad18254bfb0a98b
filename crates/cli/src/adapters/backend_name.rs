//! The backends by name.

use serde::{Deserialize, Serialize};

/// The backends, GL's profiles and wgpu's APIs counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum BackendName {
    Cpu,
    Vulkan,
    Gl,
    GlEs,
    WgpuVulkan,
    WgpuGl,
}
