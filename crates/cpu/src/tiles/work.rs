//! A triangle in a tile, as kernels need it.

use super::depth::Depths;
use super::paint::Paint;
use super::plan::DrawPlan;
use super::texels::Texels;
use super::texture::{Coordinates, Texture};
use super::triangle::Triangle;
use etalon_scene::StencilFace;

/// The data that kernels read about a triangle in a tile.
pub(crate) struct Work<'a> {
    pub(crate) triangle: &'a Triangle,
    pub(crate) plan: &'a DrawPlan,
    /// The stencil state of the triangle's facing, if it might change something.
    pub(crate) face: Option<&'a StencilFace>,
    pub(crate) paint: &'a Paint,
    /// The depths, unless the triangle is flat or depths are not tested.
    pub(crate) depths: Option<Depths>,
    pub(crate) texture: Option<(&'a Texture, Coordinates)>,
    /// The textures that the shader fetches from.
    pub(crate) texels: Option<Texels<'a>>,
}

impl Work<'_> {
    /// Returns true if all texels have one colour.
    pub(crate) fn is_constant(&self) -> bool {
        self.texture.is_none() && self.texels.is_none()
    }
}
