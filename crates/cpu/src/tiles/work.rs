//! A triangle in a tile, as kernels need it.

use super::depth::Depths;
use super::paint::TexelPaint;
use super::plan::DrawKernels;
use super::texels::FetchTextures;
use super::texture::{Coordinates, TexelRows};
use super::triangle::RasterTriangle;
use etalon_scene::StencilFace;

/// The data that kernels read about a triangle in a tile.
pub(crate) struct TriangleWork<'a> {
    pub(crate) triangle: &'a RasterTriangle,
    pub(crate) plan: &'a DrawKernels,
    /// The stencil state of the triangle's facing, if it might change something.
    pub(crate) face: Option<&'a StencilFace>,
    pub(crate) paint: &'a TexelPaint,
    /// The depths, unless the triangle is flat or depths are not tested.
    pub(crate) depths: Option<Depths>,
    pub(crate) texture: Option<(&'a TexelRows, Coordinates)>,
    /// The textures that the shader fetches from.
    pub(crate) texels: Option<FetchTextures<'a>>,
}

impl TriangleWork<'_> {
    /// Returns true if all texels have one colour.
    pub(crate) fn is_constant(&self) -> bool {
        self.texture.is_none() && self.texels.is_none()
    }
}
