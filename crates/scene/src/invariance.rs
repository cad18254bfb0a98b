//! Invariances: reasons why two pictures must be the same.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A reason why two pictures must be the same although the rules leave each of them open.
    Invariance {
        /// The same commands are repeated.
        Repeat = "repeat",
        /// Only the scissor rectangle differs.
        Scissor = "scissor",
        /// Only write masks of colour, depth or stencil differ.
        WriteMask = "write-mask",
        /// Only the contents of the attachments differ: clear values, uploads, earlier draws.
        Contents = "contents",
        /// Several colour attachments get the same output.
        Attachments = "attachments",
        /// Only parameters differ, of a test, of blending or of a logic operation that is on in both.
        Parameters = "parameters",
        /// The picture is moved by whole texels.
        Translation = "translation",
    }
}
