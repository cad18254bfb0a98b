//! The state of a driver's shader cache.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The contents of a driver's shader cache on disk when a run or bench began.
    ShaderCache {
        /// The cache was empty: it was in a new folder, or switched off.
        Cold = "cold",
        /// The cache has the shaders of earlier runs.
        Warm = "warm",
    }
}
