//! The times of a round.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The times of a round.
    Time: array {
        /// The time of a frame until the device was done.
        Wall = "wall",
        /// The time from the start of a frame until its last submitting call returns.
        Cpu = "cpu",
        /// The time of a frame between GPU timestamps.
        Gpu = "gpu",
        /// The time of reading a frame back.
        ReadBack = "read-back",
        /// The time of preparing the scene.
        Prepare = "prepare",
        /// The time of the first frame after preparing.
        First = "first",
    }
}
