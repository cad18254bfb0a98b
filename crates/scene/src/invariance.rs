//! Invariances: reasons why two pictures must be the same.

use etalon_frame::state_enum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// A reason why two pictures must be the same although the rules leave each of them open.
    Invariance {
        /// The same commands again.
        Repeat = "repeat",
        /// Another scissor rectangle.
        Scissor = "scissor",
        /// Other write masks of colour, depth or stencil.
        WriteMask = "write-mask",
        /// Other contents of the attachments: clear values, uploads, earlier draws.
        Contents = "contents",
        /// Several colour attachments that get the same output.
        Attachments = "attachments",
        /// Other parameters of a test, of blending or of a logic operation that is on in both.
        Parameters = "parameters",
        /// A picture moved by whole texels.
        Translation = "translation",
    }
}
