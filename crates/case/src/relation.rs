//! What several frames, or several attachments of one frame, have to do with each other.

use etalon_scene::Invariance;

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
