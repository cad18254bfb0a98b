//! Weighted blended order-independent transparency (McGuire and Bavoil 2013).

use super::draws::{PICTURE, clear, depths, opaque_color, opaque_depth, sum_targets, sums};
use super::scenes::GlassScene;
use crate::polygon::{Polygon, cover, mesh};
use crate::stage::{SIZE, Stage, add, depth, draw};
use etalon_scene::{BlendFactor, BlendState, CompareFunction, Scene, Shader};

/// Builds two passes for any number of layers. The first computes weighted sums and the background's
/// visibility, the second blends the mean over the background.
pub(super) fn weighted_blended(glass: &GlassScene, polygons: &[Polygon]) -> Scene {
    let mut stage = Stage::new();
    let picture = stage.color("picture", PICTURE, SIZE, clear(glass));
    let [sum, left] = sums(&mut stage);
    let depth_stencil = depths(&mut stage, 1);
    let mut accumulate = draw(Shader::WeightedAccumulate, mesh(SIZE, polygons));
    accumulate.depth = depth(CompareFunction::Less, false);
    accumulate.targets = sum_targets();
    let draws = opaque_depth(glass, Shader::WeightedAccumulate)
        .into_iter()
        .chain([accumulate]);
    stage.pass(&[sum, left], Some(depth_stencil), draws.collect());

    let mut resolve = draw(Shader::WeightedResolve, cover());
    resolve.textures = vec![sum, left];
    resolve.targets[0].blend = Some(BlendState {
        color: add(BlendFactor::OneMinusSrcAlpha, BlendFactor::SrcAlpha),
        alpha: add(BlendFactor::Zero, BlendFactor::One),
    });
    let draws = opaque_color(glass).into_iter().chain([resolve]);
    stage.pass(&[picture], None, draws.collect());
    stage.read(&[picture])
}
