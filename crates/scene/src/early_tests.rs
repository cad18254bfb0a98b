//! The order of the fragment tests and the fragment shader.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// When the depth bounds, stencil and depth tests happen, relative to the fragment shader.
    EarlyTests {
        /// The API's default for the shader: as if after the shader.
        Implicit = "implicit",
        /// Before the shader, even if it discards fragments or writes depth.
        Forced = "forced",
        /// As if after the shader, which promises a depth not below the fragment's own.
        GreaterEqual = "greater-equal",
        /// As if after the shader, which promises a depth not above the fragment's own.
        LessEqual = "less-equal",
        /// As if after the shader, which promises to write the fragment's own depth.
        Unchanged = "unchanged",
    }
}

impl EarlyTests {
    /// Returns the argument of WGSL's `early_depth_test` attribute; `None` without the attribute.
    pub fn attribute(self) -> Option<&'static str> {
        match self {
            Self::Implicit => None,
            Self::Forced => Some("force"),
            Self::GreaterEqual => Some("greater_equal"),
            Self::LessEqual => Some("less_equal"),
            Self::Unchanged => Some("unchanged"),
        }
    }

    /// Returns true if the shader makes a promise about the depth that it writes.
    pub fn is_conservative(self) -> bool {
        !matches!(self, Self::Implicit | Self::Forced)
    }
}
