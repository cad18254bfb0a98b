//! The part of a scene that one query encloses.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The part of a scene that one query encloses.
    #[derive(Default)]
    QueryScope {
        /// A single draw.
        #[default] Draw = "draw",
        /// Consecutive draws of a pass that use its counter, and the clears between them.
        Pass = "pass",
        /// Consecutive passes whose draws all use its counter, from their load operations to their resolves;
        /// passes without draws in between are enclosed too.
        Frame = "frame",
    }
}
