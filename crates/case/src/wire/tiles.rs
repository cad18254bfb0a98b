//! The keys of a draw that is repeated over tiles.

use etalon_frame::state_enum;
use etalon_scene::Splat;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

state_enum! {
    /// The state that confines a draw to its tile.
    TileBy {
        /// The mesh, which must be `full` and becomes a rectangle.
        Mesh = "mesh",
        /// The scissor rectangle.
        Scissor = "scissor",
        /// The viewport.
        Viewport = "viewport",
    }
}

/// The draw repeated for each tile of the attachments, row by row from the top left.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TilesWire {
    /// Left and top of the first tile in texels.
    #[serde(default)]
    pub(crate) origin: [u32; 2],
    /// Width and height of a tile in texels; the last ones of a row or column can be smaller.
    pub(crate) size: [u32; 2],
    /// The `color` of each tile's `params`, shifted by five in each further row and repeated as needed;
    /// `null` omits the tile.
    pub(crate) colors: Vec<Option<Splat>>,
    /// The state that confines a draw to its tile.
    #[serde(default = "by_mesh")]
    pub(crate) by: TileBy,
}

fn by_mesh() -> TileBy {
    TileBy::Mesh
}
