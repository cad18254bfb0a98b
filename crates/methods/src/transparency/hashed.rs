//! Hashed alpha testing (Wyman and McGuire 2017).

use super::draws::{PICTURE, clear, depths, opaque};
use super::scenes::GlassScene;
use crate::hashed_plane::{cells_per_texel, place};
use crate::polygon::{Polygon, mesh};
use crate::stage::{Stage, depth, draw};
use etalon_scene::{CompareFunction, Scene, Shader};

/// Draws the polygons opaque where their alpha is at least a hash, with one sample per texel.
pub(super) fn hashed(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, glass.size, clear(glass));
    let depth_stencil = depths(&mut stage, glass, 1);
    let placed: Vec<Polygon> = (0..)
        .zip(polygons)
        .map(|(number, polygon)| placed(glass.size, number, polygon))
        .collect();
    let mut tested = draw(Shader::HashedColor, mesh(glass.size, &placed));
    tested.params = cells_per_texel(glass.size);
    tested.depth = depth(CompareFunction::Less, true);
    let draws = opaque(glass, Shader::FlatColor).into_iter().chain([tested]);
    stage.pass(&[picture], Some(depth_stencil), draws.collect());
    stage.read(&[picture])
}

/// Returns the polygon with its own place in the hashed plane, as texture coordinates in widths of the picture.
/// They follow the polygon when it moves. If the corners are on texel borders, the centres of texels
/// are in the middle of cells.
pub(super) fn placed(size: [u32; 2], number: usize, polygon: &Polygon) -> Polygon {
    let least = |axis: usize| {
        let along = polygon.corners.iter().map(|corner| corner[axis]);
        along.fold(f64::INFINITY, f64::min).floor()
    };
    let from = [least(0), least(1)];
    let square = place(number);
    let at = |corner: &[f64; 3]| {
        [0, 1].map(|axis| square[axis] + (corner[axis] - from[axis]) / f64::from(size[axis]))
    };
    Polygon {
        uv: polygon.corners.iter().map(at).collect(),
        ..polygon.clone()
    }
}
