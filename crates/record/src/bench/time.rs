//! The times of a round.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The times of a round.
    Time: array {
        /// A frame until the device was done.
        Wall = "wall",
        /// A frame until the last call that submits work returned.
        Cpu = "cpu",
        /// A frame between GPU timestamps.
        Gpu = "gpu",
        /// Reading a frame back.
        ReadBack = "read-back",
        /// Preparing the scene.
        Prepare = "prepare",
        /// The first frame after preparing.
        First = "first",
    }
}
