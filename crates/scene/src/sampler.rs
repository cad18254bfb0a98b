//! Samplers.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sampler {
    /// The filter, for both magnification and minification.
    pub filter: FilterMode,
    /// The address modes across and down.
    pub address: [AddressMode; 2],
}

state_enum! {
    /// The filter of a sampler.
    FilterMode {
        /// The nearest texel.
        Nearest = "nearest",
        /// The weighted average of the four texels around it.
        Linear = "linear",
    }
}

state_enum! {
    /// The texel for a texture coordinate beyond the texture.
    AddressMode {
        /// The outermost texel.
        ClampToEdge = "clamp-to-edge",
        /// The texture repeats.
        Repeat = "repeat",
        /// The texture repeats, and every second copy is mirrored.
        MirrorRepeat = "mirror-repeat",
    }
}
