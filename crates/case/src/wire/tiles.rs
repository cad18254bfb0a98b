//! The keys of a draw that is repeated over tiles.

use etalon_frame::state_enum;
use etalon_scene::Splat;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The state that keeps a draw inside its tile.
    TileBy {
        /// The mesh `full` becomes a rectangle.
        Mesh = "mesh",
        /// The scissor rectangle.
        Scissor = "scissor",
        /// The viewport.
        Viewport = "viewport",
    }
}

/// The draw again for each tile of the attachments, row by row from the top left.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TilesWire {
    /// Left and top of the first tile in texels.
    #[serde(default)]
    pub(crate) origin: [u32; 2],
    /// Width and height of a tile in texels; the last ones of a row or column may be smaller.
    pub(crate) size: [u32; 2],
    /// The `color` of each tile's `params`, five places farther in each row and repeated as needed; `null`
    /// leaves the tile out.
    pub(crate) colors: Vec<Option<Splat>>,
    /// The state that keeps a draw inside its tile.
    #[serde(default = "by_mesh")]
    pub(crate) by: TileBy,
}

fn by_mesh() -> TileBy {
    TileBy::Mesh
}
