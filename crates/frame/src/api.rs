//! The graphics APIs.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The API whose specification binds an adapter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Api {
    /// Vulkan 1.x.
    Vulkan,
    /// OpenGL, core profile.
    OpenGl,
    /// OpenGL ES.
    OpenGlEs,
    /// WebGPU.
    WebGpu,
}

impl Api {
    /// Returns the name of the API's rules: `vulkan`, `opengl`, `opengl-es`, `webgpu`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vulkan => "vulkan",
            Self::OpenGl => "opengl",
            Self::OpenGlEs => "opengl-es",
            Self::WebGpu => "webgpu",
        }
    }
}

impl fmt::Display for Api {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
