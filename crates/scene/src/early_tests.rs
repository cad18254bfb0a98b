//! The order of fragment tests and fragment shader.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The order of depth bounds, stencil and depth tests and the fragment shader.
    EarlyTests {
        /// As the API says of the shader: in effect afterwards.
        Implicit = "implicit",
        /// Before, whatever the shader does.
        Forced = "forced",
        /// In effect afterwards; the shader promises a depth not below the fragment's own.
        GreaterEqual = "greater-equal",
        /// In effect afterwards; the shader promises a depth not above the fragment's own.
        LessEqual = "less-equal",
        /// In effect afterwards; the shader promises to write the fragment's own depth.
        Unchanged = "unchanged",
    }
}

impl EarlyTests {
    /// The word of WGSL's `early_depth_test` attribute; `None` where the shader has none.
    pub fn attribute(self) -> Option<&'static str> {
        match self {
            Self::Implicit => None,
            Self::Forced => Some("force"),
            Self::GreaterEqual => Some("greater_equal"),
            Self::LessEqual => Some("less_equal"),
            Self::Unchanged => Some("unchanged"),
        }
    }

    /// True if the shader makes a promise about the depth that it writes.
    pub fn is_conservative(self) -> bool {
        !matches!(self, Self::Implicit | Self::Forced)
    }
}
