//! What one query encloses.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The part of a scene that one query encloses.
    #[derive(Default)]
    QueryScope {
        /// One draw.
        #[default] Draw = "draw",
        /// The draws of a pass that follow one another and name its counter, and the clears between them.
        Pass = "pass",
        /// The passes that follow one another and whose draws all name its counter, from their load operations to
        /// their resolves; passes without draws between them are enclosed too.
        Frame = "frame",
    }
}
