//! The state of a driver's shader cache.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The contents of a driver's shader cache on disk when a run or bench began.
    ShaderCache {
        /// Nothing: it was in an empty folder, or switched off.
        Cold = "cold",
        /// The shaders of earlier runs.
        Warm = "warm",
    }
}
