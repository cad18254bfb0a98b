//! What several frames, or several attachments of one frame, have to do with each other.

use crate::state::state_enum;
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

/// Pictures that must be the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Relation {
    /// Why they must.
    pub invariance: Invariance,
    /// Left, top, width and height of the texels that are compared; `None` is all.
    pub within: Option<[u32; 4]>,
    /// The colour channels that are compared: bit 0 red to bit 3 alpha.
    pub channels: u8,
    /// How many texels the variants' pictures are moved to the right and down.
    pub offset: [i32; 2],
    /// Indices of the attachments of each frame that are compared with each other; empty where
    /// the variants' frames are compared with the scene's own.
    pub attachments: Vec<usize>,
}
